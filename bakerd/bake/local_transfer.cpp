// Paths are traced from each source by itself. The end of a path serves the pairs of its own source p with
// every other source q: as a bounce from a light at q to a receiver at p and, read the other way, from a
// light at p to a receiver at q. The same ends can be found by paths from q; how densely either finds them is
// known, so that both are weighted together (multiple importance sampling by the balance heuristic, Veach
// 1997): near a lamp the lamp's own paths tell of the bright spot, near a probe the probe's of the leaf in
// front of it.
//
// Shadow rays cost the most, so one stands for a group of ends: paths that left p side by side. Of the
// group's ends, one is drawn in proportion to what it would bring, and answers for all. That is right on
// average for the strength of the pair; what is lost is which end of a group at the rim of a shadow the light
// came from.
//
// A pair is a function of its two positions and of the triangles alone: not of what other sources there are.
#include "bakerd/bake/local_transfer.h"

#include "bakerd/bake/local_links.h"
#include "bakerd/bake/local_paths.h"

#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace drtv::bake {
namespace {

// Another source that a source has a pair with, in one direction or both.
struct Partner {
    std::uint32_t source;
    bool wants_here = false;   // light from it is wanted
    bool wants_there = false;  // light is wanted there
};
using Partners = std::vector<Partner>;  // by source

// Of each of so many sources.
std::vector<Partners> partners_of(const SourcesOfReceivers& wanted, std::size_t source_count) {
    std::vector<Partners> all(source_count);
    for (std::uint32_t p = 0; p < wanted.size(); ++p) {
        for (const std::uint32_t q : wanted[p]) {
            all[p].push_back({q, true, false});
            all[q].push_back({p, false, true});
        }
    }
    for (Partners& partners : all) {
        std::ranges::stable_sort(partners, {}, &Partner::source);
        Partners merged;
        for (const Partner& partner : partners) {
            if (merged.empty() || merged.back().source != partner.source)
                merged.push_back({partner.source, false, false});
            merged.back().wants_here |= partner.wants_here;
            merged.back().wants_there |= partner.wants_there;
        }
        partners = std::move(merged);
    }
    return all;
}

std::size_t number_of(std::uint32_t source, const Partners& partners) {
    const auto found = std::ranges::lower_bound(partners, source, {}, &Partner::source);
    return static_cast<std::size_t>(found - partners.begin());
}

class LocalIntegrator {
  public:
    LocalIntegrator(const trace::Scene& scene,
                    std::span<const glm::ivec3> sources,
                    const SourcesOfReceivers& wanted,
                    const SampleTable& samples,
                    const LocalSettings& settings,
                    const WatchOfThread& watch)
        : scene_(scene),
          settings_(settings),
          source_units_(sources),
          wanted_(wanted),
          partners_(partners_of(wanted, sources.size())),
          samples_(samples),
          watch_(watch) {
        for (const glm::ivec3& units : sources) {
            positions_.push_back(glm::vec3(units) * position_unit_m);
            shifts_.push_back(digital_shift(units));
        }
    }

    LocalLight run() {
        std::vector<Brought> brought(positions_.size());
        tbb::parallel_for(std::size_t{0}, positions_.size(), [&](std::size_t p) {
            const trace::FloatMode float_mode;
            brought[p] = bring(p);
        });
        LocalLight light;
        light.pairs.resize(wanted_.size());
        for (std::uint32_t p = 0; p < wanted_.size(); ++p) {
            for (const std::uint32_t q : wanted_[p]) {
                const LocalCoefficients& here = brought[p].here[number_of(q, partners_[p])];
                const LocalCoefficients& there = brought[q].there[number_of(p, partners_[q])];
                LocalCoefficients& pair = light.pairs[p].emplace_back();
                for (std::size_t c = 0; c < channel_count; ++c) {
                    // A source's own pair has one kind of path only.
                    for (std::size_t i = 0; i < sh_count; ++i)
                        pair[c][i] = here[c][i] + (p == q ? 0 : there[c][i]);
                }
            }
        }
        for (const Brought& one : brought)
            light.rays += one.rays;
        return light;
    }

  private:
    // What one source's paths are traced and joined with; kept from group to group: as much as the caches
    // hold, and never cleared.
    struct Work {
        std::size_t source;  // p
        RayWatch* watch = nullptr;
        Brought brought;
        std::vector<Links> joined;
        std::vector<trace::Ray> shadows;
        std::vector<ShadowRay> watched;
        std::vector<bool> hidden;
    };

    Brought bring(std::size_t p) const {
        Work work;
        work.source = p;
        work.brought.here.resize(partners_[p].size());
        work.brought.there.resize(partners_[p].size());
        if (watch_) {
            work.watch = &watch_();
            work.watch->begin_probe(source_units_[p]);
        }
        const std::span<const std::uint32_t> paths = samples_.side_by_side();
        const LocalPathStart from{scene_, samples_, settings_, positions_[p], shifts_[p]};
        for (std::uint32_t first = 0; first < samples_.count(); first += group_size) {
            std::vector<EndGroup> groups(settings_.bounces);  // by number of bounces
            const std::uint32_t end = std::min(first + group_size, samples_.count());
            for (std::uint32_t n = first; n < end; ++n)
                work.brought.rays += trace_local_path(from, paths[n], groups, work.watch);
            for (std::uint32_t bounce = 0; bounce < settings_.bounces; ++bounce) {
                if (!groups[bounce].ends.empty())
                    join_all(groups[bounce], bounce == 0, first * settings_.bounces + bounce, work);
            }
        }
        return std::move(work.brought);
    }

    // One group of ends, and all partners that it may serve.
    void join_all(const EndGroup& group, bool first_bounce, std::uint32_t number, Work& work) const {
        const std::size_t p = work.source;
        const GroupPaths paths{samples_.count(), settings_.reach_m};
        work.joined.resize(partners_[p].size());
        work.shadows.clear();
        for (std::size_t n = 0; n < partners_[p].size(); ++n) {
            const std::size_t q = partners_[p][n].source;
            Links& links = work.joined[work.shadows.size()];
            links.partner = n;
            const float total = join(group, paths, positions_[q], p == q, links);
            if (!(total > 0))
                continue;
            // A path's first point sees where the path came from.
            links.turns_back = p == q && first_bounce;
            if (links.turns_back)
                add(group, links, work);
            else
                work.shadows.push_back(shadow_ray(p, q, group, links, total, number));
        }
        work.brought.rays += work.shadows.size();
        watch_shadows(work);
        scene_.occluded(work.shadows, work.hidden);
        for (std::size_t n = 0; n < work.shadows.size(); ++n) {
            if (work.hidden[n])
                continue;
            work.joined[n].tint = scene_.passed(work.shadows[n]).tint;
            add(group, work.joined[n], work);
        }
    }

    void add(const EndGroup& group, const Links& links, Work& work) const {
        const Partner& partner = partners_[work.source][links.partner];
        add_links(group, links, partner.wants_here, partner.wants_there, work.brought);
    }

    static void watch_shadows(Work& work) {
        if (work.watch == nullptr)
            return;
        work.watched.clear();
        for (const trace::Ray& shadow : work.shadows)
            work.watched.push_back({shadow, whole_range});
        work.watch->record_shadow_rays(work.watched);
    }

    // From the end that answers for the group to the other source.
    [[nodiscard]] trace::Ray shadow_ray(std::size_t p,
                                        std::size_t q,
                                        const EndGroup& group,
                                        const Links& links,
                                        float total,
                                        std::uint32_t number) const {
        const std::uint32_t word = hashed(shifts_[p][0], number, shifts_[q][0]);
        float left = rounded_unit_float(word) * total;
        std::size_t drawn = 0;
        for (std::size_t k = 0; k < group.ends.size(); ++k) {
            if (!(links.strength[k] > 0))
                continue;
            drawn = k;
            left -= links.strength[k];
            if (left < 0)
                break;
        }
        const PathEnd& end = group.ends[drawn];
        const glm::vec3& start = links.facing[drawn] < 0 ? *end.beyond : end.before;
        const glm::vec3 way = positions_[q] - start;
        const float distance_m = glm::length(way);
        return {start, way / distance_m, distance_m};
    }

    const trace::Scene& scene_;
    const LocalSettings& settings_;
    const std::span<const glm::ivec3> source_units_;
    const SourcesOfReceivers& wanted_;
    const std::vector<Partners> partners_;  // by source
    const SampleTable& samples_;
    const WatchOfThread& watch_;
    std::vector<glm::vec3> positions_;  // of the sources, receivers first
    std::vector<std::array<std::uint32_t, max_sample_dimensions>> shifts_;
};

}  // namespace

std::uint32_t local_sample_dimensions(std::uint32_t bounces) {
    return 2 * bounces;
}

LocalLight integrate_local(const trace::Scene& scene,
                           std::span<const glm::ivec3> sources,
                           const SourcesOfReceivers& wanted,
                           const SampleTable& samples,
                           const LocalSettings& settings,
                           const WatchOfThread& watch) {
    return LocalIntegrator(scene, sources, wanted, samples, settings, watch).run();
}

}  // namespace drtv::bake
