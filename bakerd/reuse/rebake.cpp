#include "bakerd/reuse/rebake.h"

#include "bakerd/bake/artist_warnings.h"
#include "bakerd/reuse/footprint_recorder.h"
#include "bakerd/reuse/placement_changes.h"
#include "bakerd/reuse/static_gain.h"

#include <algorithm>
#include <map>
#include <utility>

namespace drtv::reuse {
namespace {

// Whether the record belongs to the file, and probes can be reused one by one.
bool is_usable(const EarlierBake& earlier, const FootprintGrid& grid) {
    const std::size_t count = earlier.sector.probes.size();
    const bool has_bounds =
        !earlier.footprint.without_bounds && earlier.assessment.probe_bounds.size() == count;
    const bool belongs = earlier.footprint.grid == grid && earlier.footprint.probes.size() == count;
    const bool has_quality =
        earlier.sector.quality.has_value() || earlier.sector.probes.empty();  // no file was stripped
    // Many surfaces seen from behind are reported with their names, which are not kept.
    return has_bounds && belongs && has_quality && !bake::has_many_back_hits(earlier.sector.statistics);
}

// Where the earlier bake's probes stand, as placement would give it.
bake::PlacedSector placement_of(const EarlierBake& earlier) {
    const Sector& file = earlier.sector;
    bake::PlacedSector placed;
    placed.sector.i = file.i;
    placed.sector.j = file.j;
    placed.sector.z_origin_units = file.z_origin_units;
    placed.sector.z_shift = file.z_shift;
    for (const Probe& probe : file.probes)
        placed.sector.probes.push_back({probe.position, probe.kind, {}, {}});
    for (std::size_t p = 0; p < file.probes.size(); ++p)
        placed.moved.push_back(file.quality->probes[p].moved);
    for (const ProbeRecord& probe : earlier.footprint.probes)
        placed.positions.push_back(probe.position);
    const Statistics& s = file.statistics;
    placed.report = {
        s.candidates, s.moved_out, s.dropped_in_solid, s.removed_by_volume, s.thinned, s.used_distance_m};
    placed.warnings = earlier.footprint.placement_warnings;
    // Rays that may end otherwise cannot be counted on any more.
    placed.solid_tests = earlier.footprint.solid_tests;
    for (std::size_t n = 0; n < placed.solid_tests.size(); ++n) {
        std::uint8_t& to_flip = placed.solid_tests[n].to_flip;
        to_flip = static_cast<std::uint8_t>(to_flip - earlier.assessment.flips[n]);
    }
    return placed;
}

bake::BakedProbe baked_probe(const EarlierBake& earlier, std::size_t p) {
    bake::BakedProbe probe;
    probe.transfer = earlier.sector.probes[p].transfer;
    probe.sky_visibility = earlier.sector.probes[p].sky_visibility;
    if (!earlier.sector.static_irradiance.empty())
        probe.static_irradiance = earlier.sector.static_irradiance[p];
    for (std::size_t g = 0; g < earlier.sector.light_groups.size(); ++g) {
        const LightGroup& group = earlier.sector.light_groups[g];
        probe.groups.push_back({group.name, group.irradiance[p], earlier.sector.quality->group_errors[g][p]});
    }
    probe.quality = earlier.sector.quality->probes[p];
    const ProbeRecord& record = earlier.footprint.probes[p];
    probe.counts = {record.rays, record.shadow_rays, record.error};
    return probe;
}

bake::Given::IndexedGrid grid_of(const Sector& file) {
    if (!file.quality)
        return {file.grid};
    return {file.grid, file.quality->buried_cells, file.quality->blind_cells};
}

// What the bake need not find out again.
bake::Given given_by(const EarlierBake& earlier) {
    bake::Given given;
    if (earlier.assessment.placement_holds) {
        if (!earlier.assessment.placed_again)
            given.placement = placement_of(earlier);
        given.grid = grid_of(earlier.sector);
    }
    for (std::size_t p = 0; p < earlier.footprint.probes.size(); ++p) {
        if (earlier.assessment.probe_bounds[p] <= earlier.assessment.tolerance)
            given.probes[earlier.footprint.probes[p].position] = baked_probe(earlier, p);
    }
    return given;
}

// By place, of the probes given: of their paths' weight, what may have changed.
std::map<placement::Position, float, bake::ByPlace> changed_weights(const EarlierBake& earlier) {
    std::map<placement::Position, float, bake::ByPlace> weights;
    for (std::size_t p = 0; p < earlier.footprint.probes.size(); ++p) {
        const float bound = earlier.assessment.probe_bounds[p];
        if (bound <= earlier.assessment.tolerance)
            weights[earlier.footprint.probes[p].position] = bound / earlier.assessment.gain;
    }
    return weights;
}

// Whether the sector has a light group that the file has not. What is faint everywhere is in no file: then it
// is not known what the group brings to the probes that were taken over.
bool has_other_groups(const Sector& sector, const Sector& file) {
    return !std::ranges::all_of(sector.light_groups, [&](const LightGroup& group) {
        return std::ranges::find(file.light_groups, group.name, &LightGroup::name) != file.light_groups.end();
    });
}

class Recording {
  public:
    Recording(bake::World& world, map::SectorCoordinate sector, const settings::BakeSettings& settings)
        : world_(world),
          sector_(sector),
          settings_(settings),
          scene_(world.surroundings(sector, settings).scene),
          scene_s_(stopwatch_.lap()),
          grid_(footprint_grid(sector, settings, world)),
          recorders_(sector, grid_) {}

    tl::expected<Rebake, std::string> bake(const EarlierBake* earlier) {
        if (earlier != nullptr && !is_usable(*earlier, grid_))
            earlier = nullptr;
        const bake::Given given = earlier != nullptr ? given_by(*earlier) : bake::Given{};
        const auto watch = [&]() -> bake::RayWatch& { return recorders_.of_this_thread(); };
        bake::StageSeconds spent;
        spent.scene = scene_s_;
        auto baked = bake::bake_sector(world_, sector_, settings_, given, watch);
        if (baked && earlier != nullptr && has_other_groups(baked->sector, earlier->sector)) {
            earlier = nullptr;
            spent += baked->seconds;
            baked = bake::bake_sector(world_, sector_, settings_, {}, watch);
        }
        if (!baked)
            return tl::unexpected(baked.error());
        Rebake result{std::move(*baked), {}, 0};
        result.baked.seconds += spent;
        record_settings(result.footprint);
        record_probes(result, earlier);
        record_static_light(result, earlier);
        record_rays(result, earlier);
        record_placement(result, earlier);
        return result;
    }

  private:
    void record_settings(Footprint& footprint) const {
        footprint.sector = sector_;
        footprint.reach_m = settings_.reach_m;
        footprint.rays = settings_.rays;
        footprint.without_bounds = settings_.local_transfer || settings_.error > 0;
        footprint.placement_m = bake::placement_reach_m(world_.placement_tags(), settings_);
    }

    void record_placement(Rebake& result, const EarlierBake* earlier) const {
        Footprint& footprint = result.footprint;
        footprint.solid_tests = result.baked.solid_tests;
        footprint.placement_warnings = result.baked.placement_warnings;
        const bool known = earlier != nullptr && earlier->assessment.placement_holds;
        // What could not be placed was no bake.
        footprint.placement = known ? earlier->footprint.placement
                                    : placement_digest(world_, sector_, settings_).value_or(map::Digest{});
    }

    static void record_probes(Rebake& result, const EarlierBake* earlier) {
        std::map<placement::Position, float, bake::ByPlace> weights;
        if (earlier != nullptr)
            weights = changed_weights(*earlier);
        for (std::size_t p = 0; p < result.baked.positions.size(); ++p) {
            const placement::Position& position = result.baked.positions[p];
            const bake::ProbeCounts& counts = result.baked.counts[p];
            const auto reused = weights.find(position);
            const bool is_reused = reused != weights.end();
            const float changed_weight = is_reused ? reused->second : 0;
            result.footprint.probes.push_back(
                {position, counts.rays, counts.shadow_rays, counts.error, changed_weight});
            result.probes_reused += is_reused ? 1 : 0;
        }
    }

    // Of all maps of which probes are in the file.
    void record_static_light(Rebake& result, const EarlierBake* earlier) const {
        Footprint& footprint = result.footprint;
        const bool near = std::ranges::any_of(
            footprint.probes, [](const ProbeRecord& probe) { return probe.changed_weight > 0; });
        footprint.max_scattered = world_.max_scattered();
        if (near)
            footprint.max_scattered = std::max(footprint.max_scattered, earlier->footprint.max_scattered);
        footprint.static_gain =
            static_gain(world_.lights(), footprint.max_scattered, *scene_, result.baked.positions, settings_);
        if (near)
            footprint.static_gain = std::max(footprint.static_gain, earlier->assessment.static_gain);
    }

    // What was reused still depends on where its own rays went; older rays of the other probes are among
    // these, and cost sharpness alone.
    void record_rays(Rebake& result, const EarlierBake* earlier) {
        if (result.probes_reused == 0) {
            recorders_.store(result.footprint);
            return;
        }
        result.footprint.grid = earlier->footprint.grid;
        result.footprint.crossed = earlier->footprint.crossed;
        result.footprint.weights = earlier->footprint.weights;
        recorders_.merge_into(result.footprint);
    }

    bake::World& world_;
    const map::SectorCoordinate sector_;
    const settings::BakeSettings& settings_;
    bake::Stopwatch stopwatch_;
    const std::shared_ptr<const trace::Scene> scene_;
    const double scene_s_;  // that building it took, where no neighbour had
    const FootprintGrid grid_;
    FootprintRecorders recorders_;
};

}  // namespace

tl::expected<Rebake, std::string> bake_and_record(bake::World& world,
                                                  map::SectorCoordinate coordinate,
                                                  const settings::BakeSettings& settings,
                                                  const EarlierBake* earlier) {
    const trace::FloatMode float_mode;
    return Recording(world, coordinate, settings).bake(earlier);
}

}  // namespace drtv::reuse
