// Paths are traced from each source by itself. The end of a path serves the pairs of its own source p with every other
// source q: as a bounce from a light at q to a receiver at p and, read the other way, from a light at p to a receiver at q.
// The same ends can be found by paths from q; how densely either finds them is known, so that both are weighted
// together (multiple importance sampling by the balance heuristic, Veach 1997): near a lamp the lamp's own paths tell of
// the bright spot, near a probe the probe's of the leaf in front of it.
//
// Shadow rays cost the most, so one stands for a group of ends: paths that left p side by side. Of the group's ends, one is
// drawn in proportion to what it would bring, and answers for all. That is right on average for the strength of the
// pair; what is lost is which end of a group at the rim of a shadow the light came from.
//
// A pair is a function of its two positions and of the triangles alone: not of what other sources there are.
#include "bakerd/bake/local_transfer.h"

#include "bakerd/bake/path.h"
#include "bakerd/bake/sampling.h"

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace drtv::bake {
namespace {

constexpr std::uint32_t group_size = 16;  // a power of two

float square(float x) { return x * x; }

// The end of a path from source p after one or more bounces, seen from the point that other sources would light.
struct End {
    glm::vec3 position{}, normal{};          // the normal is on the side from which the path came
    glm::vec3 before{};                      // starts of shadow rays on that side, and on the other where there is one
    std::optional<glm::vec3> beyond;
    glm::vec3 albedo{}, transmitted{};       // times what the points before send on
    float density = 0;                       // of finding it from p, but for what both directions share
    float density_front = 1, density_back = 0;  // of going on from here to the path's first point, from either side
    float to_receiver = 0;                   // cosine over square distance of the first point to p
    float from_light = 0;                    // irradiance of the first point from a light at p
    Float4 direction{};                      // SH of E/pi at p from the first point's direction
    glm::vec3 first{};                       // the first point
};

// SH of E/pi from radiance out of the unit direction: the cosine's own coefficients over pi are 1 and 2/3.
Float4 irradiance_sh(const glm::vec3& w) {
    Float4 y = evaluate_sh({w.x, w.y, w.z});
    for (std::size_t i = 1; i < sh_count; ++i) y[i] *= 2 / 3.0f;
    return y;
}

// Numbers of a table so that those whose first two dimensions lie side by side follow each other: each run of a power of
// two shares a square, and a digital shift moves squares as wholes.
std::vector<std::uint32_t> square_by_square(const SampleTable& samples) {
    const auto code = [&](std::uint32_t n) {
        std::uint64_t morton = 0;
        for (std::uint32_t bit = 0; bit < 32; ++bit) {
            morton = morton << 2 | std::uint64_t{samples.point(n)[0] >> (31 - bit) & 1u} << 1 | (samples.point(n)[1] >> (31 - bit) & 1u);
        }
        return morton;
    };
    std::vector<std::uint32_t> order(samples.count());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, code);
    return order;
}

// What the paths of one source brought, by the other source of the pair.
struct Brought {
    std::vector<LocalCoefficients> here;   // to a receiver where the paths began, from a light at the other
    std::vector<LocalCoefficients> there;  // to a receiver at the other, from a light where the paths began
    std::uint64_t rays = 0;
};

class LocalIntegrator {
  public:
    LocalIntegrator(const trace::Scene& scene, std::span<const glm::ivec3> sources, std::size_t receiver_count, const LocalSettings& settings)
        : scene_(scene), settings_(settings), receiver_count_(receiver_count), samples_(settings.rays, 2 + 2 * (settings.bounces - 1)), order_(square_by_square(samples_)) {
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
                    for (std::size_t i = 0; i < sh_count; ++i) pair[c][i] = brought[p].here[q][c][i] + (p == q ? 0 : brought[q].there[p][c][i]);
                }
            }
        }
        for (const Brought& one : brought) light.rays += one.rays;
        return light;
    }

  private:
    using Ends = std::vector<std::vector<End>>;  // by number of bounces

    Brought bring(std::size_t p) const {
        Brought brought;
        brought.here.resize(positions_.size());
        brought.there.resize(positions_.size());
        for (std::uint32_t first = 0; first < samples_.count(); first += group_size) {
            Ends groups(settings_.bounces);
            for (std::uint32_t n = first; n < std::min(first + group_size, samples_.count()); ++n) trace_path(p, samples_.point(order_[n]), groups, brought.rays);
            for (std::uint32_t bounce = 0; bounce < settings_.bounces; ++bounce) {
                if (groups[bounce].empty()) continue;
                for (std::size_t q = 0; q < positions_.size(); ++q) {
                    // Pairs of two neighbours' probes are another sector's.
                    if (p < receiver_count_ || q < receiver_count_) join(p, q, groups[bounce], first * settings_.bounces + bounce, brought);
                }
            }
        }
        return brought;
    }

    void trace_path(std::size_t p, std::span<const std::uint32_t> numbers, Ends& groups, std::uint64_t& rays) const {
        const auto sample = [&](std::size_t d) { return glm::vec2(unit_float(numbers[d] ^ shifts_[p][d]), unit_float(numbers[d + 1] ^ shifts_[p][d + 1])); };
        trace::Ray ray{positions_[p], uniform_sphere(sample(0)), settings_.reach_m};
        End end;
        glm::vec3 carried(1);
        float footprint_m = 0;
        for (std::uint32_t bounce = 0; bounce < settings_.bounces; ++bounce) {
            ++rays;
            const std::optional<trace::Hit> hit = scene_.closest(ray);
            if (!hit) return;
            footprint_m += hit->distance_m * later_footprint;
            const trace::Surface surface = scene_.surface(*hit, footprint_m);
            if (surface.absorbs) return;
            const std::optional<glm::vec3> before = before_surface(ray, *hit);
            if (!before) return;
            const float share = transmitted_share(surface);
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
            groups[bounce].push_back(end);
            if (bounce + 1 == settings_.bounces) return;
            const std::optional<Scattered> next = scatter(scene_, ray, *hit, surface, sample(2 + 2 * std::size_t{bounce}));
            if (!next) return;
            const bool through = glm::dot(next->direction, hit->normal) < 0;
            const float probability = through ? share : 1 - share;
            // The first point's own draw of a side is p's alone to make; those between, both directions share.
            if (bounce == 0) {
                end.density *= probability;
                carried *= through ? surface.transmitted : surface.albedo;
            } else {
                carried *= (through ? surface.transmitted : surface.albedo) / probability;
            }
            ray = {next->origin, next->direction, exit_distance(next->origin, next->direction, positions_[p], settings_.reach_m)};
        }
    }

    // One group of ends and the other source q.
    void join(std::size_t p, std::size_t q, const std::vector<End>& group, std::uint32_t number, Brought& brought) const {
        struct Link {
            glm::vec3 colour;
            float here, there;     // of receivers here and there, but for colour and direction
            float strength;        // what it brings, for the draw
            glm::vec3 way;         // from q
            bool behind;
        };
        std::array<Link, group_size> links;
        float total = 0;
        const float scale = 4 / static_cast<float>(settings_.rays);  // 4 pi of the sphere, over pi of the bounce
        for (std::size_t k = 0; k < group.size(); ++k) {
            const End& end = group[k];
            Link& link = links[k];
            const glm::vec3 way = end.position - positions_[q];
            const float squared = glm::dot(way, way), distance_m = std::sqrt(squared);
            const float facing = -glm::dot(way, end.normal);
            link.behind = facing < 0;
            link.strength = 0;
            if (link.behind && !end.beyond) continue;
            const float cosine = std::abs(facing) / distance_m;
            if (!(cosine > 0)) continue;
            const bool own = p == q;
            const glm::vec3 first_way = end.first - positions_[q];
            const bool reached = !own && std::max(squared, glm::dot(first_way, first_way)) <= square(settings_.reach_m);
            const float to_there = cosine / squared;
            const float density = end.density + (reached ? to_there * (link.behind ? end.density_back : end.density_front) : 0);
            link.here = scale * end.to_receiver * cosine / std::max(squared, square(local_least_distance_m)) / density;
            link.there = reached ? scale * end.from_light * to_there / density : 0;
            link.colour = link.behind ? end.transmitted : end.albedo;
            link.way = way / distance_m;
            link.strength = link.here * (link.colour.x + link.colour.y + link.colour.z);
            total += link.strength;
        }
        if (!(total > 0)) return;
        if (!(p == q && group[0].first == group[0].position) && !sees(p, q, group, links, total, number, brought.rays)) return;
        LocalCoefficients& here = brought.here[q];
        LocalCoefficients& there = brought.there[q];
        const bool wants_there = q < receiver_count_;
        for (std::size_t k = 0; k < group.size(); ++k) {
            const Link& link = links[k];
            if (!(link.strength > 0)) continue;
            const Float4 back = irradiance_sh(link.way);
            for (std::size_t c = 0; c < channel_count; ++c) {
                const float colour = link.colour[static_cast<glm::length_t>(c)];
                for (std::size_t i = 0; i < sh_count; ++i) here[c][i] += link.here * colour * group[k].direction[i];
                for (std::size_t i = 0; wants_there && i < sh_count; ++i) there[c][i] += link.there * colour * back[i];
            }
        }
    }

    // Whether the end that answers for the group sees q.
    template <class Links>
    bool sees(std::size_t p, std::size_t q, const std::vector<End>& group, const Links& links, float total, std::uint32_t number, std::uint64_t& rays) const {
        float left = static_cast<float>(hashed(shifts_[p][0], number, shifts_[q][0])) * 0x1p-32f * total;
        std::size_t drawn = 0;
        for (std::size_t k = 0; k < group.size(); ++k) {
            if (!(links[k].strength > 0)) continue;
            drawn = k;
            left -= links[k].strength;
            if (left < 0) break;
        }
        const glm::vec3& start = links[drawn].behind ? *group[drawn].beyond : group[drawn].before;
        const glm::vec3 way = positions_[q] - start;
        const float distance_m = glm::length(way);
        ++rays;
        return !scene_.occluded({start, way / distance_m, distance_m});
    }

    const trace::Scene& scene_;
    const LocalSettings& settings_;
    const std::size_t receiver_count_;
    const SampleTable samples_;
    const std::vector<std::uint32_t> order_;
    std::vector<glm::vec3> positions_;  // of the sources, receivers first
    std::vector<std::array<std::uint32_t, max_sample_dimensions>> shifts_;
};

}  // namespace

LocalLight integrate_local(const trace::Scene& scene, std::span<const glm::ivec3> sources, std::size_t receiver_count, const LocalSettings& settings) {
    return LocalIntegrator(scene, sources, receiver_count, settings).run();
}

}  // namespace drtv::bake
