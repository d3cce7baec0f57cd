#include "commands.h"
#include "folder_info.h"
#include "info_text.h"
#include "kit/files.h"
#include "quality_parts.h"

#include <drtv/read.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace drtv::tool {
namespace {

void print_sections(const std::vector<SectionEntry>& entries) {
    std::printf("sections\n");
    for (const SectionEntry& entry : entries) {
        std::printf("  %-17s %6u bytes%s\n",
                    std::string(name_of_section(entry.kind)).c_str(),
                    entry.raw_bytes,
                    entry.codec == 0 ? ""
                                     : (", zstd " + std::to_string(entry.stored_bytes) +
                                        (entry.codec == 2 ? ", filtered" : ""))
                                           .c_str());
    }
}

void print_probes(const Sector& sector) {
    std::size_t of_kind[3] = {};
    Float3 low{}, high{};
    double visibility = 0;
    for (const Probe& probe : sector.probes) {
        ++of_kind[static_cast<std::size_t>(probe.kind)];
        const Float3 p = position_m(sector, probe);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool first = &probe == &sector.probes.front();
            low[axis] = first ? p[axis] : std::min(low[axis], p[axis]);
            high[axis] = first ? p[axis] : std::max(high[axis], p[axis]);
        }
        for (std::size_t b = 0; b < 3; ++b)
            visibility += decode_fixed(probe.sky_visibility[b], sky_visibility_scale);
    }
    std::printf("probes          %zu (%zu ground, %zu vegetation, %zu manual)\n",
                sector.probes.size(),
                of_kind[0],
                of_kind[1],
                of_kind[2]);
    if (sector.probes.empty())
        return;
    std::printf(
        "heights         %.2f to %.2f m\n", static_cast<double>(low[2]), static_cast<double>(high[2]));
    std::printf("sky visibility  %.3f on average\n",
                visibility / (3.0 * static_cast<double>(sector.probes.size())));
}

// E/pi of the brightest side of all probes.
double brightest(const std::vector<StaticIrradiance>& probes) {
    float most = 0;
    for (const StaticIrradiance& probe : probes) {
        const float scale = scale_of_exponent(probe.exponent);
        for (const auto& channel : probe.codes)
            most = std::max(most, decode_fixed(*std::max_element(channel.begin(), channel.end()), scale));
    }
    return static_cast<double>(most);
}

// "0.004, 0.01, 0.03": median, 95th percentile, largest. REQUIRES: there are some.
std::string shown_spread(std::vector<float> errors) {
    std::sort(errors.begin(), errors.end());
    const std::size_t last = errors.size() - 1;
    const auto at = [&](std::size_t percent) {
        return static_cast<double>(errors[(last * percent + 50) / 100]);
    };
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.3g, %.3g, %.3g", at(50), at(95), at(100));
    return text.data();
}

void print_quality(const Sector& sector) {
    const Quality& quality = *sector.quality;
    const auto count = [&](bool ProbeQuality::*flag) {
        return std::ranges::count(quality.probes, true, flag);
    };
    std::printf(
        "quality         %td dark, %td moved out of a solid, %td short of the error asked; %u cells in "
        "solids or under ground, %u that see no probe of theirs\n",
        count(&ProbeQuality::dark),
        count(&ProbeQuality::moved),
        count(&ProbeQuality::budget_ended),
        quality.buried_cells,
        quality.blind_cells);
    if (quality.probes.empty())
        return;
    std::printf(
        "errors          over their own mean, of the probes that get such light: median, 95 %%, largest\n");
    std::vector<PartQuality> names = quality_parts(sector, 0);
    std::vector<std::vector<float>> errors(names.size());
    for (std::size_t p = 0; p < quality.probes.size(); ++p) {
        const std::vector<PartQuality> parts = quality_parts(sector, p);
        for (std::size_t n = 0; n < parts.size(); ++n) {
            if (parts[n].mean > 0)
                errors[n].push_back(parts[n].error);
        }
    }
    for (std::size_t n = 0; n < names.size(); ++n) {
        if (!errors[n].empty())
            std::printf("  %-18s %s, of %zu probes\n",
                        names[n].name.c_str(),
                        shown_spread(errors[n]).c_str(),
                        errors[n].size());
    }
}

// One line for each optional section that the file has.
void print_light(const Sector& sector) {
    if (!sector.static_irradiance.empty())
        std::printf("static light    up to %g (E/pi)\n", brightest(sector.static_irradiance));
    for (const LightGroup& group : sector.light_groups)
        std::printf("light group     %s, up to %g (E/pi)\n", group.name.c_str(), brightest(group.irradiance));
    if (sector.local_transfer) {
        const LocalTransfer& local = *sector.local_transfer;
        const auto is_own = [](const LocalSource& source) { return source.di == 0 && source.dj == 0; };
        const auto own = std::count_if(local.sources.begin(), local.sources.end(), is_own);
        std::printf(
            "local lights    %zu pairs of probe and source, %zu sources, of which %zu in neighbours\n",
            local.pairs.size(),
            local.sources.size(),
            local.sources.size() - static_cast<std::size_t>(own));
    }
    if (!sector.interiors.empty()) {
        std::size_t triangles = 0;
        for (const Interior& interior : sector.interiors)
            triangles += interior.triangles.size();
        std::printf("interiors       %zu with %zu triangles\n", sector.interiors.size(), triangles);
    }
    if (const auto& c = sector.convergence) {
        std::printf(
            "convergence     error %g asked, %g median, %g at 95 %%, %g at most; %u to %u paths per probe\n",
            static_cast<double>(c->error_asked),
            static_cast<double>(c->error_median),
            static_cast<double>(c->error_p95),
            static_cast<double>(c->error_max),
            c->paths_least,
            c->paths_most);
    }
    if (sector.quality)
        print_quality(sector);
}

}  // namespace

cli::Result<cli::ExitCode> run_info(const std::string& file) {
    std::error_code code;
    if (std::filesystem::is_directory(file, code))
        return print_folder_info(file);
    kit::FileBytes bytes;
    const auto loaded = kit::load_sector(file, &bytes);
    if (!loaded)
        return tl::unexpected(loaded.error());
    const Sector& sector = *loaded;
    std::vector<SectionEntry> entries;
    if (const ReadStatus status = read_section_table(bytes, entries); !status.ok())
        return cli::fail(cli::exit_invalid, file + ": " + status.message);

    const int x = sector.i * sector_size_m, y = sector.j * sector_size_m;
    std::printf("sector          (%d, %d): x %d to %d m, y %d to %d m\n",
                sector.i,
                sector.j,
                x,
                x + sector_size_m,
                y,
                y + sector_size_m);
    std::printf("file            %zu bytes, format %s\n", bytes.size(), kit::format_version(bytes).c_str());
    print_probes(sector);
    const BakeRecord& bake = sector.bake;
    std::printf("settings        %s\n", settings_text(bake).c_str());
    std::printf("settings key    ");
    for (std::uint8_t byte : bake.settings_key)
        std::printf("%02x", byte);
    const Statistics& s = sector.statistics;
    std::printf("\nplacement       %s\n", placement_text(s).c_str());
    std::printf("spacing used    %g m\n", static_cast<double>(s.used_distance_m));
    std::printf("rays            %s\n", rays_text(s).c_str());
    print_light(sector);
    print_sections(entries);
    return cli::exit_done;
}

}  // namespace drtv::tool
