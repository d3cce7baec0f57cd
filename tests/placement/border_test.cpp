// The heart of placement: sectors that decide one by one agree with one slow decision over all of them. The
// slow one is written from the rule, as a recursion instead of a sweep.
#include "tests/placement/analytic_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <random>

namespace drtv::test {
namespace {

constexpr std::int32_t sector_units = 64 * 1024;

struct Proposal {
    Position position;
    int kind = 0;
    unsigned bayer = 0, level = 0;
    bool operator<(const Proposal& o) const {
        return std::tie(kind, bayer, level) < std::tie(o.kind, o.bayer, o.level);
    }
};

unsigned bayer(unsigned x, unsigned y, unsigned stride) {
    if (stride == 1)
        return 0;
    const unsigned quarter = (stride / 2) * (stride / 2);
    const unsigned place[2][2] = {{0, 2}, {3, 1}};  // [y][x]
    return place[y % 2][x % 2] * quarter + bayer(x / 2 % (stride / 2), y / 2 % (stride / 2), stride / 2);
}

class GlobalDecision {
  public:
    GlobalDecision(const AnalyticScene& scene, glm::ivec2 low_m, glm::ivec2 high_m, double distance_m)
        : scene_(scene), reach_units_(distance_m * 1024), least_(squared_units(distance_m)) {
        for (const placement::HandPlacedProbe& probe : scene.manual) {
            const glm::dvec3& m = probe.position;
            manual_.emplace_back(std::lround(m.x * 1024), std::lround(m.y * 1024), std::lround(m.z * 1024));
        }
        propose(std::min(4.0, distance_m), 0, low_m, high_m, distance_m);
        propose(std::min(8.0, 2 * distance_m), 1, low_m, high_m, distance_m);
        kept_.resize(proposals_.size());
        places_.resize(proposals_.size());
        higher_.resize(proposals_.size());
        for (std::size_t n = 0; n < proposals_.size(); ++n) {
            for (std::size_t m = 0; m < proposals_.size(); ++m) {
                if (proposals_[m] < proposals_[n] &&
                    take_place(proposals_[m].position, proposals_[n].position))
                    higher_[n].push_back(m);
            }
        }
    }

    std::vector<PlacedProbe> run() {
        std::vector<PlacedProbe> result;
        for (std::size_t n = 0; n < proposals_.size(); ++n) {
            if (kept(n))
                result.push_back({proposals_[n].position, static_cast<Kind>(proposals_[n].kind)});
        }
        const std::size_t standing = result.size();
        for (std::size_t n = 0; n < proposals_.size(); ++n) {
            const std::optional<Position> place = free_place(n);
            if (!place || near_manual(*place))
                continue;
            const auto near = [&](const Position& other) { return take_place(*place, other); };
            bool free = std::none_of(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(standing),
                                     [&](const PlacedProbe& p) { return near(p.position); });
            for (std::size_t m = 0; free && m < proposals_.size(); ++m)
                free = !(proposals_[m] < proposals_[n] && free_place(m) && near(*free_place(m)));
            if (free)
                result.push_back({*place, static_cast<Kind>(proposals_[n].kind)});
            moved += free ? 1u : 0u;
        }
        return result;
    }

    unsigned moved = 0;

  private:
    bool take_place(const Position& a, const Position& b) const {
        return squared_distance(a, b) < least_ && scene_.sees(glm::vec3(a) / 1024.0f, glm::vec3(b) / 1024.0f);
    }

    void propose(double lattice_m, int kind, glm::ivec2 low_m, glm::ivec2 high_m, double distance_m) {
        unsigned stride = 1;
        while (stride * lattice_m < distance_m)
            stride *= 2;
        const auto lattice = static_cast<std::int32_t>(lattice_m);  // whole metres in these tests
        for (std::int32_t b = low_m.y / lattice - 1; b * lattice < high_m.y; ++b) {
            for (std::int32_t a = low_m.x / lattice - 1; a * lattice < high_m.x; ++a) {
                const Position at(a * lattice * 1024 + lattice * 512, b * lattice * 1024 + lattice * 512, 0);
                unsigned level = 0;
                for (double z_m : kind == 0 ? ground(at) : tops(at)) {
                    // 1024 lattice squares more do not change the class and keep the numbers positive.
                    proposals_.push_back({Position(at.x, at.y, static_cast<int>(std::lround(z_m * 1024))),
                                          kind,
                                          bayer(static_cast<unsigned>(a + 1024) % stride,
                                                static_cast<unsigned>(b + 1024) % stride, stride),
                                          level++});
                }
            }
        }
    }

    // Heights of probes over a point, from the bottom.
    std::vector<double> ground(const Position& at) {
        std::vector<ColumnHit> hits;
        scene_.column(glm::vec2(at) / 1024.0f, hits);
        std::vector<double> heights;
        for (std::size_t n = hits.size(); n-- > 0;) {
            if (!hits[n].up_facing)
                continue;
            if (n == 0)
                heights.push_back(hits[n].z_m + 1.0);
            else if (hits[n - 1].down_facing && hits[n - 1].z_m - hits[n].z_m >= 1.5f)
                heights.push_back(hits[n].z_m + std::min(1.0, (hits[n - 1].z_m - hits[n].z_m) / 2.0));
        }
        return heights;
    }

    std::vector<double> tops(const Position& at) {
        const float x = static_cast<float>(at.x) / 1024, y = static_cast<float>(at.y) / 1024;
        std::vector<const Box*> here;
        for (const Box& b : scene_.vegetation) {
            if (b.low.x <= x && x <= b.high.x && b.low.y <= y && y <= b.high.y)
                here.push_back(&b);
        }
        std::vector<double> heights;
        for (const Box* b : here) {
            // A top counts when no box goes on above it.
            if (std::none_of(here.begin(), here.end(),
                             [&](const Box* o) { return o->low.z <= b->high.z && o->high.z > b->high.z; }))
                heights.push_back(double{b->high.z} + 1);
        }
        std::sort(heights.begin(), heights.end());
        heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
        return heights;
    }

    bool near_manual(const Position& p) const {
        return std::any_of(manual_.begin(), manual_.end(),
                           [&](const Position& m) { return take_place(p, m); });
    }

    bool removed(const Position& p) const {
        return std::any_of(scene_.no_probes.begin(), scene_.no_probes.end(),
                           [&](const auto& v) { return v.contains(glm::dvec3(p) / 1024.0); });
    }

    bool in_solid(const Position& p) const { return scene_.is_in_box(glm::vec3(p) / 1024.0f); }

    // Not down.
    static std::vector<glm::vec3> directions() {
        std::vector<glm::vec3> result;
        const auto add = [&](int x, int y, int z) {
            result.push_back(glm::vec3(x, y, z) / std::sqrt(static_cast<float>(x * x + y * y + z * z)));
        };
        add(0, 0, 1);
        for (int z : {1, 0}) {
            add(1, 0, z), add(-1, 0, z), add(0, 1, z), add(0, -1, z);
            add(1, 1, z), add(-1, 1, z), add(1, -1, z), add(-1, -1, z);
        }
        return result;
    }

    // Into nothing on the way.
    bool leads_out(const Position& from, const Position& to) const {
        const auto sides = scene_.sides(glm::vec3(from) / 1024.0f, glm::vec3(to) / 1024.0f);
        return std::ranges::none_of(sides, [](const placement::Side& side) { return side.front; });
    }

    bool undisturbed(std::size_t n) {
        const Position& p = proposals_[n].position;
        return !removed(p) && !near_manual(p) &&
               std::none_of(higher_[n].begin(), higher_[n].end(), [&](std::size_t m) { return kept(m); });
    }

    bool kept(std::size_t n) {
        if (!kept_[n])
            kept_[n] = undisturbed(n) && !in_solid(proposals_[n].position);
        return *kept_[n];
    }

    std::optional<Position> free_place(std::size_t n) {
        if (!places_[n])
            places_[n] = find_free_place(n);
        return *places_[n];
    }

    std::optional<Position> find_free_place(std::size_t n) {
        const Position& from = proposals_[n].position;
        if (!in_solid(from) || !undisturbed(n))
            return std::nullopt;
        for (double share : {0.125, 0.25, 0.5}) {
            for (const glm::vec3& d : directions()) {
                Position place = from;
                for (int axis = 0; axis < 3; ++axis)
                    place[axis] += static_cast<int>(static_cast<double>(d[axis]) * share * reach_units_);
                const auto same = [](int a, int b) {
                    return std::floor(a / double{sector_units}) == std::floor(b / double{sector_units});
                };
                if (same(place.x, from.x) && same(place.y, from.y) && !removed(place) && !in_solid(place) &&
                    leads_out(from, place))
                    return place;
            }
        }
        return std::nullopt;
    }

    const AnalyticScene& scene_;
    const double reach_units_;
    const std::int64_t least_;
    std::vector<Position> manual_;
    std::vector<Proposal> proposals_;
    std::vector<std::optional<bool>> kept_;
    std::vector<std::optional<std::optional<Position>>> places_;
    std::vector<std::vector<std::size_t>> higher_;  // those that may forbid this one
};

constexpr std::int32_t low_m = -64, high_m = 128;  // the block: sectors -1, 0 and 1 either way

// Ground with holes, upper floors, solids no column sees, thickets, manual probes and a volume; all in the
// block.
AnalyticScene random_scene(unsigned seed, float holes) {
    AnalyticScene scene;
    scene.floors = [seed, holes](glm::vec2 at, std::vector<ColumnHit>& hits) {
        if (at.x < low_m || at.y < low_m || at.x >= high_m || at.y >= high_m)
            return;
        std::mt19937 random(seed * 7919u + static_cast<unsigned>(at.x + 1000) * 4001u +
                            static_cast<unsigned>(at.y + 1000));
        const auto uniform = [&] { return static_cast<float>(random() % 65536u) / 65536.0f; };
        if (uniform() < holes)
            return;
        const float z_m =
            6 * std::sin(at.x * 0.11f + static_cast<float>(seed)) + 5 * std::cos(at.y * 0.07f) + uniform();
        hits.push_back({z_m, true, false});
        if (uniform() < 0.15f) {
            const float ceiling_m = z_m + 1.2f + 4 * uniform();
            hits.push_back({ceiling_m, false, true});
            hits.push_back({ceiling_m + 0.3f, true, false});
        }
    };
    std::mt19937 random(seed);
    const auto between = [&](float a, float b) {
        return a + (b - a) * static_cast<float>(random() % 65536u) / 65536.0f;
    };
    const auto box = [&](float max_m, float low_z, float high_z) {
        const glm::vec3 low(between(low_m, high_m - max_m), between(low_m, high_m - max_m),
                            between(low_z, high_z));
        return Box{low, low + glm::vec3(between(0.5f, max_m), between(0.5f, max_m), between(0.5f, 6))};
    };
    for (int n = 0; n < 200; ++n)
        scene.solids.push_back(box(8, -12, 10));
    for (int n = 0; n < 60; ++n)
        scene.vegetation.push_back(box(14, -8, 10));
    for (int n = 0; n < 25; ++n)
        scene.manual.push_back({{between(low_m, high_m), between(low_m, high_m), between(-8, 10)}, {}});
    // On borders and corners, where "whose is it" is asked.
    for (const glm::dvec3& at : {glm::dvec3(0, 0, 3), {64, 20, 0}, {0, 33, 2}, {64, 64, 1}})
        scene.manual.push_back({at, {}});
    scene.no_probes = {box_volume({-9, 20, -20}, {11, 41, 20}), box_volume({50, 55, -20}, {81, 71, 3})};
    return scene;
}

class SectorBorder : public testing::TestWithParam<float> {};

TEST_P(SectorBorder, SectorsOneByOneEqualOneGlobalDecision) {
    const float distance_m = GetParam();
    unsigned moved = 0;
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const AnalyticScene scene =
            random_scene(seed, distance_m < 4 ? 0.75f : 0.08f * static_cast<float>(seed - 1));
        std::vector<PlacedProbe> all;
        for (std::int32_t j = -1; j <= 1; ++j) {
            for (std::int32_t i = -1; i <= 1; ++i) {
                const placement::Placement placed = scene.place(i, j, distance_m);
                ASSERT_EQ(placed.report.thinned, 0u) << "the scene is too dense for this test";
                ASSERT_EQ(placed.report.used_distance_m, distance_m);
                for (const PlacedProbe& p : placed.probes) {
                    EXPECT_EQ(std::floor(p.position.x / double{sector_units}), i);
                    EXPECT_EQ(std::floor(p.position.y / double{sector_units}), j);
                }
                moved += placed.report.moved_out;
                all.insert(all.end(), placed.probes.begin(), placed.probes.end());
            }
        }
        GlobalDecision global(scene, glm::ivec2(low_m), glm::ivec2(high_m), distance_m);
        std::erase_if(all, [](const PlacedProbe& p) { return p.kind == Kind::manual; });
        EXPECT_EQ(sorted_keys(all), sorted_keys(global.run())) << "seed " << seed;
    }
    EXPECT_GT(moved, 0u) << "no probe was moved out of a solid: the test has no teeth";
}

INSTANTIATE_TEST_SUITE_P(Distances, SectorBorder, testing::Values(3.0f, 6.0f, 7.5f, 9.0f, 14.0f));

}  // namespace
}  // namespace drtv::test
