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

class LocalIntegrator {
  public:
    LocalIntegrator(const trace::Scene& scene,
                    std::span<const glm::ivec3> sources,
                    std::size_t receiver_count,
                    const SampleTable& samples,
                    const LocalSettings& settings,
                    const WatchOfThread& watch)
        : scene_(scene),
          settings_(settings),
          source_units_(sources),
          receiver_count_(receiver_count),
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
        light.source_count = positions_.size();
        light.pairs.resize(receiver_count_ * positions_.size());
        for (std::size_t p = 0; p < receiver_count_; ++p) {
            for (std::size_t q = 0; q < positions_.size(); ++q) {
                const LocalCoefficients& here = brought[p].here[q];
                const LocalCoefficients& there = brought[q].there[p];
                LocalCoefficients& pair = light.pairs[p * positions_.size() + q];
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
        work.brought.here.resize(positions_.size());
        work.brought.there.resize(positions_.size());
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

    // One group of ends, and all other sources that it may serve.
    void join_all(const EndGroup& group, bool first_bounce, std::uint32_t number, Work& work) const {
        const std::size_t p = work.source;
        const GroupPaths paths{samples_.count(), settings_.reach_m};
        work.joined.resize(positions_.size());
        work.shadows.clear();
        for (std::size_t q = 0; q < positions_.size(); ++q) {
            if (p >= receiver_count_ && q >= receiver_count_)
                break;  // pairs of two neighbours' probes are another sector's
            Links& links = work.joined[work.shadows.size()];
            links.source = q;
            const float total = join(group, paths, positions_[q], p == q, links);
            if (!(total > 0))
                continue;
            // A path's first point sees where the path came from.
            links.turns_back = p == q && first_bounce;
            if (links.turns_back)
                add(group, links, work);
            else
                work.shadows.push_back(shadow_ray(p, group, links, total, number));
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
        add_links(group, links, work.source < receiver_count_, links.source < receiver_count_, work.brought);
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
    [[nodiscard]] trace::Ray shadow_ray(
        std::size_t p, const EndGroup& group, const Links& links, float total, std::uint32_t number) const {
        const std::uint32_t word = hashed(shifts_[p][0], number, shifts_[links.source][0]);
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
        const glm::vec3 way = positions_[links.source] - start;
        const float distance_m = glm::length(way);
        return {start, way / distance_m, distance_m};
    }

    const trace::Scene& scene_;
    const LocalSettings& settings_;
    const std::span<const glm::ivec3> source_units_;
    const std::size_t receiver_count_;
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
                           std::size_t receiver_count,
                           const SampleTable& samples,
                           const LocalSettings& settings,
                           const WatchOfThread& watch) {
    return LocalIntegrator(scene, sources, receiver_count, samples, settings, watch).run();
}

}  // namespace drtv::bake
