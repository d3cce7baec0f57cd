#include "commands.h"
#include "kit/files.h"
#include "kit/json_writer.h"

#include <array>
#include <cstdio>

namespace drtv::tool {
namespace {

// Heights and positions are whole numbers of 2^-10 m, which a double holds exactly wherever a sector can lie.
double metres(std::int64_t units) {
    return static_cast<double>(units) / position_units_per_m;
}

std::string hex(const std::array<std::uint8_t, 32>& bytes) {
    static constexpr char digits[] = "0123456789abcdef";
    std::string text;
    for (std::uint8_t byte : bytes) {
        text += digits[byte >> 4];
        text += digits[byte & 15];
    }
    return text;
}

void append_codes(kit::JsonWriter& json, std::int16_t code, float scale) {
    json.value(decode_fixed(code, scale));
}

template <class Element, std::size_t count>
void append_codes(kit::JsonWriter& json, const std::array<Element, count>& codes, float scale) {
    json.begin_array();
    for (const Element& element : codes)
        append_codes(json, element, scale);
    json.end_array();
}

void append_local(kit::JsonWriter& json, const Sector& sector, const LocalReceiver& receiver) {
    const LocalTransfer& local = *sector.local_transfer;
    json.key("local").begin_array();
    std::size_t pair = receiver.first_pair;
    for (std::size_t s = 0; s < local.sources.size(); ++s) {
        if (!has_pair(receiver, s))
            continue;
        const LocalSource& source = local.sources[s];
        json.begin_object()
            .key("sector")
            .begin_array()
            .value(sector.i + source.di)
            .value(sector.j + source.dj)
            .end_array();
        json.key("probe").value(unsigned{source.probe}).key("coefficients");
        append_codes(json, local.pairs[pair++], scale_of_exponent(receiver.exponent + source.exponent));
        json.end_object();
    }
    json.end_array();
}

void append_quality(kit::JsonWriter& json, const Quality& quality, std::size_t p) {
    const ProbeQuality& probe = quality.probes[p];
    json.key("quality").begin_object();
    json.member("transfer_error", probe.transfer_error);
    json.member("visibility_error", probe.visibility_error);
    json.member("static_error", probe.static_error);
    json.key("group_errors").begin_array();
    for (const std::vector<float>& errors : quality.group_errors)
        json.value(errors[p]);
    json.end_array();
    json.member("paths", probe.paths);
    json.member("back_hits", probe.back_hits);
    json.member("budget_ended", probe.budget_ended);
    json.member("dark", probe.dark);
    json.member("moved", probe.moved);
    json.end_object();
}

void append_probe(kit::JsonWriter& json, const Sector& sector, std::size_t p) {
    const Probe& probe = sector.probes[p];
    json.begin_object();
    json.key("position").begin_array();
    for (std::int32_t units : position_units(sector, probe))
        json.value(metres(units));
    json.end_array();
    json.key("kind").value(name_of(probe.kind));
    json.key("transfer");
    append_codes(json, probe.transfer, transfer_scale);
    json.key("sky_visibility");
    append_codes(json, probe.sky_visibility, sky_visibility_scale);
    if (!sector.static_irradiance.empty()) {
        json.key("static_irradiance");
        append_codes(
            json, sector.static_irradiance[p].codes, scale_of_exponent(sector.static_irradiance[p].exponent));
    }
    if (!sector.light_groups.empty()) {
        json.key("light_groups").begin_array();
        for (const LightGroup& group : sector.light_groups)
            append_codes(json, group.irradiance[p].codes, scale_of_exponent(group.irradiance[p].exponent));
        json.end_array();
    }
    if (sector.local_transfer)
        append_local(json, sector, sector.local_transfer->receivers[p]);
    if (sector.quality)
        append_quality(json, *sector.quality, p);
    json.end_object();
}

void append_settings(kit::JsonWriter& json, const BakeRecord& bake) {
    json.key("settings").begin_object();
    json.key("rays").value(bake.rays).key("bounces").value(bake.bounces);
    json.key("reach").value(bake.reach_m).key("min_distance").value(bake.min_distance_m);
    json.key("key").value(hex(bake.settings_key)).end_object();
}

void append_grid(kit::JsonWriter& json, const Sector& sector) {
    const std::array<double, 3> origin = {double{sector_size_m} * sector.i,
                                          double{sector_size_m} * sector.j,
                                          metres(sector.grid.z_origin_units)};
    constexpr double cell_width_m = double{sector_size_m} / grid_size;
    const std::array<double, 3> cell = {cell_width_m, cell_width_m, metres(sector.grid.cell_height_units)};
    json.key("grid").begin_object().key("origin").array(origin).key("cell").array(cell);
    json.key("size").begin_array().value(16).value(16).value(16).end_array();
    json.key("cells").begin_array();
    for (std::uint8_t probe : sector.grid.cells)
        json.value(unsigned{probe});
    json.end_array().end_object();
}

void append_statistics(kit::JsonWriter& json, const Statistics& s) {
    json.key("statistics").begin_object();
    json.key("candidates").value(s.candidates).key("moved_out").value(s.moved_out);
    json.key("dropped_in_solid")
        .value(s.dropped_in_solid)
        .key("removed_by_volume")
        .value(s.removed_by_volume);
    json.key("thinned").value(s.thinned).key("used_distance").value(s.used_distance_m);
    json.key("rays").value(s.rays).key("back_hits").value(s.back_hits).end_object();
}

void append_convergence(kit::JsonWriter& json, const Convergence& c) {
    json.key("convergence").begin_object();
    json.key("error_asked").value(c.error_asked).key("error_median").value(c.error_median);
    json.key("error_p95").value(c.error_p95).key("error_max").value(c.error_max);
    json.key("paths_least").value(c.paths_least).key("paths_most").value(c.paths_most);
    json.key("local_bounces").value(c.local_bounces).key("local_rays").value(c.local_rays);
    json.key("static_rays")
        .value(c.static_rays)
        .key("local_transfer_rays")
        .value(c.local_transfer_rays)
        .end_object();
}

void append_interiors(kit::JsonWriter& json, const Sector& sector) {
    json.key("interiors").begin_array();
    for (const Interior& interior : sector.interiors) {
        json.begin_object().key("probe").value(unsigned{interior.probe}).key("vertices").begin_array();
        for (const auto& vertex : interior.vertices) {
            json.begin_array();
            for (std::size_t axis = 0; axis < 3; ++axis)
                json.value(
                    metres(interior.origin_units[axis] + (std::int64_t{vertex[axis]} << interior.shift)));
            json.end_array();
        }
        json.end_array().key("triangles").begin_array();
        for (const auto& triangle : interior.triangles) {
            json.begin_array();
            for (const std::uint16_t vertex : triangle)
                json.value(unsigned{vertex});
            json.end_array();
        }
        json.end_array().end_object();
    }
    json.end_array();
}

}  // namespace

cli::Result<cli::ExitCode> run_dump(const std::string& file) {
    kit::FileBytes bytes;
    const auto loaded = kit::load_sector(file, &bytes);
    if (!loaded)
        return tl::unexpected(loaded.error());
    const Sector& sector = *loaded;
    kit::JsonWriter json;
    json.begin_object().key("format_version").value(kit::format_version(bytes));
    json.key("sector").begin_array().value(sector.i).value(sector.j).end_array();
    append_settings(json, sector.bake);
    if (!sector.light_groups.empty()) {
        json.key("light_groups").begin_array();
        for (const LightGroup& group : sector.light_groups)
            json.value(group.name);
        json.end_array();
    }
    json.key("probes").begin_array();
    for (std::size_t p = 0; p < sector.probes.size(); ++p)
        append_probe(json, sector, p);
    json.end_array();
    append_grid(json, sector);
    if (!sector.interiors.empty())
        append_interiors(json, sector);
    append_statistics(json, sector.statistics);
    if (sector.convergence)
        append_convergence(json, *sector.convergence);
    if (sector.quality) {
        json.key("quality").begin_object();
        json.member("buried_cells", sector.quality->buried_cells);
        json.member("blind_cells", sector.quality->blind_cells);
        json.end_object();
    }
    json.end_object();
    std::puts(json.text().c_str());
    return cli::exit_done;
}

}  // namespace drtv::tool
