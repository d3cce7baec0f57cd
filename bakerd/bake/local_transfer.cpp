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

#include "bakerd/bake/path.h"

#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace drtv::bake {
namespace {

constexpr std::uint32_t group_size = 16;  // a power of two

constexpr Shares all_of_it = {1, 1, 1, 1};

float square(float x) {
    return x * x;
}

// The end of a path from source p after one or more bounces, seen from the point that other sources would
// light.
struct End {
    glm::vec3 position{}, normal{};  // the normal is on the side from which the path came
    glm::vec3 before{};  // starts of shadow rays on that side, and on the other where there is one
    std::optional<glm::vec3> beyond;
    glm::vec3 albedo{}, transmitted{};  // times what the points before send on
    float density = 0;                  // of finding it from p, but for what both directions share
    float density_front = 1,
          density_back = 0;  // of going on from here to the path's first point, from either side
    float to_receiver = 0;   // cosine over square distance of the first point to p
    float from_light = 0;    // irradiance of the first point from a light at p
    Float4 direction{};      // SH of E/pi at p from the first point's direction
    glm::vec3 first{};       // the first point
};

// The numbers of up to group_size ends as `join` reads them, one after the other: so the compiler takes eight
// at a time. Behind the last end all are such that nothing comes of them.
struct Group {
    using Numbers = std::array<float, group_size>;

    std::vector<End> ends;
    alignas(32) Numbers x{}, y{}, z{}, normal_x{}, normal_y{}, normal_z{}, first_x{}, first_y{}, first_z{};
    alignas(32) Numbers density{}, density_front{}, density_back{}, to_receiver{}, from_light{};
    alignas(32) Numbers bright_front{},
        bright_back{};  // what it sends on, summed over channels; 0 where it has no such side

    void add(const End& end) {
        const std::size_t k = ends.size();
        x[k] = end.position.x, y[k] = end.position.y, z[k] = end.position.z;
        normal_x[k] = end.normal.x, normal_y[k] = end.normal.y, normal_z[k] = end.normal.z;
        first_x[k] = end.first.x, first_y[k] = end.first.y, first_z[k] = end.first.z;
        density[k] = end.density, density_front[k] = end.density_front, density_back[k] = end.density_back;
        to_receiver[k] = end.to_receiver, from_light[k] = end.from_light;
        bright_front[k] = end.albedo.x + end.albedo.y + end.albedo.z;
        bright_back[k] = end.beyond ? end.transmitted.x + end.transmitted.y + end.transmitted.z : 0;
        ends.push_back(end);
    }
};

// SH of E/pi from radiance out of the unit direction: the cosine's own coefficients over pi are 1 and 2/3.
Float4 irradiance_sh(const glm::vec3& w) {
    Float4 y = evaluate_sh({w.x, w.y, w.z});
    for (std::size_t i = 1; i < sh_count; ++i)
        y[i] *= 2 / 3.0f;
    return y;
}

// What the paths of one source brought, by the other source of the pair.
struct Brought {
    std::vector<LocalCoefficients> here;   // to a receiver where the paths began, from a light at the other
    std::vector<LocalCoefficients> there;  // to a receiver at the other, from a light where the paths began
    std::uint64_t rays = 0;
};

class LocalIntegrator {
  public:
    LocalIntegrator(const trace::Scene& scene,
                    std::span<const glm::ivec3> sources,
                    std::size_t receiver_count,
                    const SampleTable& samples,
                    const LocalSettings& settings,
                    FootprintRecorders* recorders)
        : scene_(scene),
          settings_(settings),
          receiver_count_(receiver_count),
          samples_(samples),
          recorders_(recorders) {
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
                LocalCoefficients& pair = light.pairs[p * positions_.size() + q];
                for (std::size_t c = 0; c < channel_count; ++c) {
                    // A source's own pair has one kind of path only.
                    for (std::size_t i = 0; i < sh_count; ++i)
                        pair[c][i] = brought[p].here[q][c][i] + (p == q ? 0 : brought[q].there[p][c][i]);
                }
            }
        }
        for (const Brought& one : brought)
            light.rays += one.rays;
        return light;
    }

  private:
    Brought bring(std::size_t p) const {
        Brought brought;
        brought.here.resize(positions_.size());
        brought.there.resize(positions_.size());
        Work work;
        if (recorders_ != nullptr) {
            work.recorder = &recorders_->of_this_thread();
            work.recorder->begin(0);  // without bounds: where it counts does not matter
        }
        for (std::uint32_t first = 0; first < samples_.count(); first += group_size) {
            std::vector<Group> groups(settings_.bounces);  // by number of bounces
            for (std::uint32_t n = first; n < std::min(first + group_size, samples_.count()); ++n)
                trace_path(p, samples_.side_by_side()[n], groups, brought.rays, work.recorder);
            for (std::uint32_t bounce = 0; bounce < settings_.bounces; ++bounce) {
                if (!groups[bounce].ends.empty())
                    join_all(
                        p, groups[bounce], bounce == 0, first * settings_.bounces + bounce, work, brought);
            }
        }
        return brought;
    }

    void trace_path(std::size_t p,
                    std::uint32_t n,
                    std::vector<Group>& groups,
                    std::uint64_t& rays,
                    FootprintRecorder* recorder) const {
        const std::span<const std::uint32_t> numbers = samples_.point(n);
        trace::Ray ray{positions_[p], uniform_sphere(shifted(numbers, shifts_[p], 0)), settings_.reach_m};
        End end;
        glm::vec3 carried(1);
        float footprint_m = 0;
        for (std::uint32_t bounce = 0; bounce < settings_.bounces; ++bounce) {
            ++rays;
            const std::optional<trace::Hit> hit = scene_.closest(ray);
            if (recorder != nullptr)
                recorder->path(ray, hit ? hit->distance_m : ray.far_m, all_of_it, n);
            if (!hit)
                return;
            footprint_m += hit->distance_m * later_footprint;
            const trace::Surface surface = scene_.surface(*hit, footprint_m);
            if (surface.absorbs)
                return;
            const std::optional<glm::vec3> before = before_surface(ray, *hit);
            if (!before)
                return;
            const float share = transmitted_share(surface);
            if (recorder != nullptr && share > 0)
                recorder->path(ray, end_of_beyond_surface(ray, *hit), all_of_it, n);
            end.position = ray.origin + ray.direction * hit->distance_m;
            end.normal = hit->normal;
            end.before = *before;
            end.beyond = share > 0 ? beyond_surface(scene_, ray, *hit) : std::nullopt;
            end.albedo = carried * surface.albedo;
            end.transmitted = carried * surface.transmitted;
            if (bounce == 0) {
                const float cosine = -glm::dot(ray.direction, hit->normal);
                end.first = end.position;
                end.to_receiver = end.density = cosine / square(hit->distance_m);
                end.from_light = cosine / std::max(square(hit->distance_m), square(local_least_distance_m));
                end.direction = irradiance_sh(ray.direction);
                end.density_front = end.density_back = 1;
            } else {
                end.density_front = 1 - share;
                end.density_back = share;
            }
            groups[bounce].add(end);
            if (bounce + 1 == settings_.bounces)
                return;
            const std::optional<Scattered> next = scatter(
                scene_, ray, *hit, surface, shifted(numbers, shifts_[p], 2 + 2 * std::size_t{bounce}));
            if (!next)
                return;
            const bool through = next->through;
            const float probability = through ? share : 1 - share;
            // The first point's own draw of a side is p's alone to make; those between, both directions
            // share.
            if (bounce == 0) {
                end.density *= probability;
                carried *= through ? surface.transmitted : surface.albedo;
            } else {
                carried *= (through ? surface.transmitted : surface.albedo) / probability;
            }
            ray = {next->origin,
                   next->direction,
                   exit_distance(next->origin, next->direction, positions_[p], settings_.reach_m)};
        }
    }

    // What the ends of a group do for one pair.
    struct Links {
        std::size_t source = 0;                  // q
        alignas(32) Group::Numbers strength;     // what each brings, for the draw; 0: nothing
        alignas(32) Group::Numbers here, there;  // to receivers here and there, but for colour and direction
        alignas(32) Group::Numbers way_x, way_y, way_z;  // from q, unit
        alignas(32) Group::Numbers facing;  // negative where q is on the other side of the surface
    };
    // Kept from group to group: as much as the caches hold, and never cleared.
    struct Work {
        std::vector<Links> joined;
        std::vector<trace::Ray> shadows;
        std::vector<bool> hidden;
        FootprintRecorder* recorder = nullptr;
    };

    // One group of ends, and all other sources that it may serve.
    void join_all(std::size_t p,
                  const Group& group,
                  bool first_bounce,
                  std::uint32_t number,
                  Work& work,
                  Brought& brought) const {
        work.joined.resize(positions_.size());
        work.shadows.clear();
        for (std::size_t q = 0; q < positions_.size(); ++q) {
            if (p >= receiver_count_ && q >= receiver_count_)
                break;  // pairs of two neighbours' probes are another sector's
            Links& links = work.joined[work.shadows.size()];
            const float total = join(p, q, group, links);
            if (!(total > 0))
                continue;
            // A path's first point sees where the path came from.
            if (p == q && first_bounce)
                add(p, group, links, brought);
            else
                work.shadows.push_back(shadow_ray(p, group, links, total, number));
        }
        brought.rays += work.shadows.size();
        if (work.recorder != nullptr) {
            for (const trace::Ray& shadow : work.shadows)
                work.recorder->lone(shadow, all_of_it);
        }
        scene_.occluded(work.shadows, work.hidden);
        for (std::size_t n = 0; n < work.shadows.size(); ++n) {
            if (!work.hidden[n])
                add(p, group, work.joined[n], brought);
        }
    }

    // The sum of all strengths.
    float join(std::size_t p, std::size_t q, const Group& group, Links& links) const {
        const float scale =
            4 / static_cast<float>(samples_.count());  // 4 pi of the sphere, over pi of the bounce
        const float other = p == q ? 0.0f : 1.0f, square_reach = square(settings_.reach_m);
        const glm::vec3 from = positions_[q];
        links.source = q;
        for (std::size_t k = 0; k < group_size; ++k) {
            const float x = group.x[k] - from.x, y = group.y[k] - from.y, z = group.z[k] - from.z;
            const float first_x = group.first_x[k] - from.x, first_y = group.first_y[k] - from.y,
                        first_z = group.first_z[k] - from.z;
            const float facing = -(x * group.normal_x[k] + y * group.normal_y[k] + z * group.normal_z[k]);
            const float squared = std::max(x * x + y * y + z * z, 1e-12f), inverse = 1 / std::sqrt(squared);
            const float cosine = std::abs(facing) * inverse;
            const float farthest =
                std::max(squared, first_x * first_x + first_y * first_y + first_z * first_z);
            const float to_there = farthest <= square_reach ? cosine * inverse * inverse * other : 0.0f;
            const float bright = facing < 0 ? group.bright_back[k] : group.bright_front[k];
            const float density =
                group.density[k] + to_there * (facing < 0 ? group.density_back[k] : group.density_front[k]);
            const float over_density = density > 0 ? scale / density : 0.0f;
            links.here[k] = group.to_receiver[k] * cosine /
                            std::max(squared, square(local_least_distance_m)) * over_density;
            links.there[k] = group.from_light[k] * to_there * over_density;
            links.way_x[k] = x * inverse;
            links.way_y[k] = y * inverse;
            links.way_z[k] = z * inverse;
            links.facing[k] = facing;
            links.strength[k] = links.here[k] * bright;
        }
        float total = 0;
        for (const float strength : links.strength)
            total += strength;
        return total;
    }

    // From the end that answers for the group to q.
    [[nodiscard]] trace::Ray shadow_ray(
        std::size_t p, const Group& group, const Links& links, float total, std::uint32_t number) const {
        float left =
            static_cast<float>(hashed(shifts_[p][0], number, shifts_[links.source][0])) * 0x1p-32f * total;
        std::size_t drawn = 0;
        for (std::size_t k = 0; k < group.ends.size(); ++k) {
            if (!(links.strength[k] > 0))
                continue;
            drawn = k;
            left -= links.strength[k];
            if (left < 0)
                break;
        }
        const glm::vec3& start =
            links.facing[drawn] < 0 ? *group.ends[drawn].beyond : group.ends[drawn].before;
        const glm::vec3 way = positions_[links.source] - start;
        const float distance_m = glm::length(way);
        return {start, way / distance_m, distance_m};
    }

    void add(std::size_t p, const Group& group, const Links& links, Brought& brought) const {
        LocalCoefficients& here = brought.here[links.source];
        LocalCoefficients& there = brought.there[links.source];
        const bool wants_here = p < receiver_count_, wants_there = links.source < receiver_count_;
        for (std::size_t k = 0; k < group.ends.size(); ++k) {
            if (!(links.strength[k] > 0))
                continue;
            const End& end = group.ends[k];
            const glm::vec3& colours = links.facing[k] < 0 ? end.transmitted : end.albedo;
            const Float4 back = irradiance_sh({links.way_x[k], links.way_y[k], links.way_z[k]});
            for (std::size_t c = 0; c < channel_count; ++c) {
                const float colour = colours[static_cast<glm::length_t>(c)];
                for (std::size_t i = 0; wants_here && i < sh_count; ++i)
                    here[c][i] += links.here[k] * colour * end.direction[i];
                for (std::size_t i = 0; wants_there && i < sh_count; ++i)
                    there[c][i] += links.there[k] * colour * back[i];
            }
        }
    }

    const trace::Scene& scene_;
    const LocalSettings& settings_;
    const std::size_t receiver_count_;
    const SampleTable& samples_;
    FootprintRecorders* const recorders_;
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
                           FootprintRecorders* recorders) {
    return LocalIntegrator(scene, sources, receiver_count, samples, settings, recorders).run();
}

}  // namespace drtv::bake
