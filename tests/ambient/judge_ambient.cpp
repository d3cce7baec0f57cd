#include "tests/ambient/judge_ambient.h"

#include "tests/ambient/vectors.h"
#include "tests/reference/in_parallel.h"
#include "tests/reference/reference_random.h"
#include "tests/reference/reference_walk.h"

#include <drtv/ambient.h>
#include <drtv/relight.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <numbers>
#include <stdexcept>

namespace drtv::test {
namespace {

using reference::AmbientLight;
using Truth = std::vector<std::vector<AmbientLight>>;  // [moment][normal]

constexpr std::size_t normal_count = 64;
constexpr double farthest_surface_m = 30;
constexpr double off_surface_m = 0.001;
constexpr std::array<float, 4> offsets_m = {0, 0.5f, 1, 2};
constexpr std::array<RelightMode, 2> modes = {RelightMode::literal, RelightMode::accurate};

std::string name_of(RelightMode mode) {
    return mode == RelightMode::literal ? "literal" : "accurate";
}

glm::dvec3 place_of(const LoadedSector& sector, std::size_t p) {
    return as_double(position_m(sector.view, p));
}

std::vector<glm::dvec3> basis_directions() {
    std::vector<glm::dvec3> directions;
    for (const Float3& b : transfer_basis)
        directions.push_back(as_double(b));
    return directions;
}

// Evenly over the sphere (a Fibonacci spiral), after the four directions of the basis.
std::vector<glm::dvec3> normals_of_a_probe() {
    std::vector<glm::dvec3> normals = basis_directions();
    for (std::size_t n = 0; n < normal_count; ++n) {
        const double z = 1 - (2.0 * static_cast<double>(n) + 1) / normal_count;
        const double around = static_cast<double>(n) * std::numbers::pi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - z * z);
        normals.emplace_back(r * std::cos(around), r * std::sin(around), z);
    }
    return normals;
}

// Not clamped: parts may be below 0.
glm::dvec3 weighted(RelightMode mode, const BasisColours& colours, const glm::dvec3& normal) {
    const Float4 weights = basis_weights(mode, as_float(normal));
    glm::dvec3 sum(0);
    for (std::size_t b = 0; b < basis_count; ++b)
        sum += static_cast<double>(weights[b]) * as_double(colours[b]);
    return sum;
}

BasisColours true_colours(const std::vector<AmbientLight>& at_basis) {
    BasisColours colours{};
    for (std::size_t b = 0; b < basis_count; ++b)
        colours[b] = as_float(at_basis[b].total());
    return colours;
}

// A probe's own errors: nothing is interpolated.
class ProbeJudge {
  public:
    ProbeJudge(std::span<const TestMoment> moments, std::span<const glm::dvec3> normals)
        : moments_(moments), normals_(normals) {}

    [[nodiscard]] Place judge(const LoadedSector& sector, std::size_t p, const Truth& truth) const {
        Place place;
        for (std::size_t m = 0; m < moments_.size(); ++m) {
            for (const RelightMode mode : modes)
                add(place.sums, sector, p, moments_[m].light, mode, truth[m]);
        }
        const Sum& first = place.sums.all().front().second;
        place.mean = first.truth / static_cast<double>(first.count);
        return place;
    }

  private:
    void add(Sums& sums, const LoadedSector& sector, std::size_t p, const SceneLight& of_moment,
             RelightMode mode, const std::vector<AmbientLight>& truth) const {
        SceneLight light = of_moment;
        light.mode = mode;
        const std::string name = name_of(mode);
        const BasisColours stored = clamped(relight(sector.view, p, light));
        const BasisColours right = true_colours(truth);
        for (std::size_t b = 0; b < basis_count; ++b)
            sums[name + ": stored colours at b"].add(as_double(stored[b]), truth[b].total());
        const BasisColours sky_direct = relight({}, sector.view.sky_visibility[p], only_sky(light));
        const BasisColours sky_bounce = relight(sector.view.transfer[p], {}, only_sky(light));
        const BasisColours sun_bounce = relight(sector.view.transfer[p], {}, only_sun(light));
        for (std::size_t n = basis_count; n < normals_.size(); ++n) {
            const glm::dvec3& normal = normals_[n];
            const auto shaded = [&](const BasisColours& colours) {
                return as_double(shade_ambient(mode, colours, as_float(normal)));
            };
            sums[name].add(shaded(stored), truth[n].total());
            sums[name + ": true colours at b"].add(shaded(right), truth[n].total());
            sums[name + ": sky direct"].add(weighted(mode, sky_direct, normal), truth[n].sky_direct);
            sums[name + ": sky bounce"].add(weighted(mode, sky_bounce, normal), truth[n].sky_bounce);
            sums[name + ": sun bounce"].add(weighted(mode, sun_bounce, normal), truth[n].sun_bounce);
            sums[name + ": static"].add(shaded(clamped(relight(sector.view, p, only_static(light)))),
                                        truth[n].static_light);
        }
    }

    static SceneLight only_sky(const SceneLight& light) {
        SceneLight part;
        part.mode = light.mode;
        part.sky = light.sky;
        return part;
    }
    static SceneLight only_sun(const SceneLight& light) {
        SceneLight part;
        part.mode = light.mode;
        part.sun = light.sun;
        return part;
    }
    static SceneLight only_static(const SceneLight& light) {
        SceneLight part;
        part.mode = light.mode;
        part.static_colour = light.static_colour;
        part.groups = light.groups;
        part.other_groups = light.other_groups;
        return part;
    }

    std::span<const TestMoment> moments_;
    std::span<const glm::dvec3> normals_;
};

struct Surface {
    glm::dvec3 point{};
    glm::dvec3 normal{};
};

class Judge {
  public:
    Judge(const reference::Scene& scene, const SectorSet& set, std::span<const LoadedSector* const> sectors,
          std::span<const TestMoment> moments, const JudgeSettings& settings)
        : scene_(scene), set_(set), moments_(moments), settings_(settings) {
        for (const TestMoment& moment : moments)
            truth_of_.push_back(moment.truth);
        for (const LoadedSector* sector : sectors) {
            for (std::size_t p = 0; p < sector->view.probe_count; ++p) {
                const glm::dvec3 place = place_of(*sector, p);
                if (glm::all(glm::greaterThan(place, settings.low)) &&
                    glm::all(glm::lessThan(place, settings.high)))
                    probes_.emplace_back(sector, p);
            }
        }
        if (probes_.empty())
            throw std::runtime_error("there is no probe");
    }

    [[nodiscard]] Judgement run() {
        Judgement judgement;
        const std::size_t count = std::min(settings_.probes, probes_.size());
        std::vector<Place> places(count);
        std::vector<Truth> truths(count);
        reference::in_parallel(settings_.threads, count, [&](std::size_t n) {
            const auto& [sector, p] = probes_[(2 * n + 1) * probes_.size() / (2 * count)];
            truths[n] = truth_at(place_of(*sector, p), normals_);
            places[n] = ProbeJudge(moments_, normals_).judge(*sector, p, truths[n]);
        });
        judgement.at_probes = errors_of(places);
        judgement.parts = parts_of(truths);

        const std::vector<Surface> surfaces = choose_surfaces();
        places.assign(surfaces.size(), {});
        reference::in_parallel(settings_.threads, surfaces.size(),
                               [&](std::size_t n) { places[n] = judge(surfaces[n]); });
        judgement.at_surfaces = errors_of(places);
        return judgement;
    }

  private:
    [[nodiscard]] Truth truth_at(const glm::dvec3& point, std::span<const glm::dvec3> normals) const {
        return reference::ambient(scene_, point, normals, truth_of_,
                                  {.bounces = settings_.bounces,
                                   .reach_m = settings_.reach_m,
                                   .strata = settings_.strata,
                                   .seed = settings_.seed});
    }

    // What probes see around them, leaves apart.
    [[nodiscard]] std::vector<Surface> choose_surfaces() const {
        std::vector<Surface> surfaces;
        reference::Random random(settings_.seed);
        for (std::size_t n = 0; n < 50 * settings_.surfaces && surfaces.size() < settings_.surfaces; ++n) {
            const auto& [sector, p] =
                probes_[static_cast<std::size_t>(random.next() * static_cast<double>(probes_.size()))];
            const glm::dvec3 from = place_of(*sector, p);
            const double u = random.next();
            const double v = random.next();
            const glm::dvec3 w = reference::sphere_direction(u, v);
            glm::dvec3 tint(1);
            const auto hit = scene_.closest(from, w, random, tint);
            if (!hit || hit->distance_m > farthest_surface_m || hit->absorbs ||
                hit->transmitted != glm::dvec3(0))
                continue;
            const glm::dvec3 point = from + hit->distance_m * w + off_surface_m * hit->normal;
            if (set_.nearest(as_place(point)).count > 0)
                surfaces.push_back({point, hit->normal});
        }
        return surfaces;
    }

    [[nodiscard]] Place judge(const Surface& surface) {
        Place place;
        std::vector<glm::dvec3> normals = basis_directions();
        normals.push_back(surface.normal);
        const Truth truth = truth_at(surface.point, normals);
        const auto right = [&](std::size_t m) { return truth[m].back().total(); };
        for (std::size_t m = 0; m < moments_.size(); ++m) {
            for (const RelightMode mode : modes) {
                SceneLight light = moments_[m].light;
                light.mode = mode;
                for (const Sampling sampling : {Sampling::nearest, Sampling::trilinear}) {
                    for (const float offset_m : offsets_m)
                        place.sums[name_of(mode, sampling, offset_m)].add(
                            found(surface, light, sampling, offset_m), right(m));
                }
            }
            for (const float offset_m : offsets_m)
                place.sums["accurate: true colours at b, trilinear, " + metres(offset_m)].add(
                    with_true_colours(surface, m, offset_m), right(m));
            place.sums["accurate: true colours at b of the place itself"].add(
                glm::max(glm::dvec3(0),
                         weighted(RelightMode::accurate, true_colours(truth[m]), surface.normal)),
                right(m));
        }
        const Sum& first = place.sums.all().front().second;
        place.mean = first.truth / static_cast<double>(first.count);
        return place;
    }

    [[nodiscard]] glm::dvec3 found(const Surface& surface, const SceneLight& light, Sampling sampling,
                                   float offset_m) const {
        const Ambient ambient = ambient_at(set_, light, {},
                                           {.at = as_place(surface.point),
                                            .normal = as_float(surface.normal),
                                            .sampling = sampling,
                                            .offset_m = offset_m});
        return as_double(ambient.colour);
    }

    // The probes that the runtime blends there, outside of interiors, each with what truly comes to it.
    [[nodiscard]] glm::dvec3 with_true_colours(const Surface& surface, std::size_t m, float offset_m) {
        const glm::dvec3 asked = surface.point + static_cast<double>(offset_m) * surface.normal;
        const ProbeBlend blend = set_.outdoors(set_.trilinear(as_place(asked)));
        glm::dvec3 sum(0);
        double shares = 0;
        for (std::size_t n = 0; n < blend.count; ++n) {
            const ProbeShare& probe = blend.probes[n];
            sum += static_cast<double>(probe.share) *
                   weighted(RelightMode::accurate, true_colours(truth_of_probe(probe)[m]), surface.normal);
            shares += static_cast<double>(probe.share);
        }
        return shares > 0 ? glm::max(glm::dvec3(0), sum / shares) : glm::dvec3(0);
    }

    const Truth& truth_of_probe(const ProbeShare& probe) {
        const std::pair key(probe.sector->slot, probe.probe);
        {
            const std::scoped_lock lock(mutex_);
            if (const auto known = known_.find(key); known != known_.end())
                return known->second;
        }
        Truth truth = truth_at(place_of(*probe.sector, probe.probe), basis_directions());
        const std::scoped_lock lock(mutex_);
        return known_.try_emplace(key, std::move(truth)).first->second;
    }

    static std::string metres(float offset_m) {
        std::array<char, 16> text{};
        std::snprintf(text.data(), text.size(), "%g m", static_cast<double>(offset_m));
        return text.data();
    }
    static std::string name_of(RelightMode mode, Sampling sampling, float offset_m) {
        return test::name_of(mode) + (sampling == Sampling::nearest ? ": nearest, " : ": trilinear, ") +
               metres(offset_m);
    }

    static std::vector<std::pair<std::string, double>> parts_of(const std::vector<Truth>& truths) {
        AmbientLight all;
        for (const Truth& truth : truths) {
            for (const std::vector<AmbientLight>& moment : truth) {
                for (std::size_t n = basis_count; n < moment.size(); ++n) {
                    all.sky_direct += moment[n].sky_direct;
                    all.sky_bounce += moment[n].sky_bounce;
                    all.sun_bounce += moment[n].sun_bounce;
                    all.static_light += moment[n].static_light;
                }
            }
        }
        const auto sum = [](const glm::dvec3& v) { return v.x + v.y + v.z; };
        const double whole = std::max(sum(all.total()), 1e-30);
        return {{"sky direct", sum(all.sky_direct) / whole},
                {"sky bounce", sum(all.sky_bounce) / whole},
                {"sun bounce", sum(all.sun_bounce) / whole},
                {"static", sum(all.static_light) / whole}};
    }

    const reference::Scene& scene_;
    const SectorSet& set_;
    std::span<const TestMoment> moments_;
    const JudgeSettings& settings_;
    const std::vector<glm::dvec3> normals_ = normals_of_a_probe();
    std::vector<reference::Moment> truth_of_;
    std::vector<std::pair<const LoadedSector*, std::size_t>> probes_;
    std::mutex mutex_;
    std::map<std::pair<std::uint32_t, std::uint8_t>, Truth> known_;
};

}  // namespace

Judgement judge_ambient(const reference::Scene& scene, const SectorSet& set,
                        std::span<const LoadedSector* const> sectors, std::span<const TestMoment> moments,
                        const JudgeSettings& settings) {
    return Judge(scene, set, sectors, moments, settings).run();
}

void print(const Judgement& judgement) {
    std::printf("light at the probes:");
    for (const auto& [name, share] : judgement.parts)
        std::printf(" %s %.0f %%,", name.c_str(), 100 * share);
    std::printf(" of %zu probes\n", judgement.at_probes.empty() ? 0 : judgement.at_probes[0].rms.size());
    print("at probes, 64 normals: rms / mean", judgement.at_probes);
    print("at surfaces, at their normal: |error| / mean", judgement.at_surfaces);
}

}  // namespace drtv::test
