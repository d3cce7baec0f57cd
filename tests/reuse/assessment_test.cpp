// What an assessment promises, against bakes of both maps: a hit has the same bytes, a near hit lies within
// its bound.
#include "bakerd/reuse/assessment.h"

#include "bakerd/reuse/describe.h"
#include "bakerd/reuse/footprint_record.h"
#include "bakerd/reuse/rebake.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <map>
#include <random>

namespace drtv::test {
namespace {

// A soak asks for more with DRTV_TEST_EDITS, QEMU for fewer; see CONTRIBUTING.
int edits_or(int number) {
    const char* asked = std::getenv("DRTV_TEST_EDITS");
    return asked == nullptr ? number : std::atoi(asked);
}

// A yard of 3 x 3 sectors that can be edited: everything in it by name.
struct Yard {
    struct Thing {
        std::string name, role;
        int mesh = 0;
        glm::dvec3 at{};
        double spacing = 0;
    };
    std::vector<Thing> things;
    std::vector<glm::dvec3> lamps, probes;
    std::vector<glm::vec4> colours = {{0.2f, 0.4f, 0.1f, 1}, {0.5f, 0.45f, 0.4f, 1}, {0.1f, 0.3f, 0.05f, 1}};
    float crown_m = 1.5f;
    double lamp_candela = 300;
    std::vector<std::string> lamp_groups = {"", "lanterns"};  // of the first lamps
    static constexpr int block_mesh = 1, room_mesh = 3, pane_mesh = 4, boulder_mesh = 5, wall_mesh = 6;
    static constexpr double kit_m = 8;  // rooms stand on this lattice

    Yard(unsigned seed, bool lit, bool with_kit = false) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> place(-60, 124);
        for (int n = 0; n < 14; ++n)
            things.push_back({"block_" + std::to_string(n), "", 1, {place(random), -1, -place(random)}});
        for (int n = 0; n < 40; ++n)
            things.push_back(
                {"tree_" + std::to_string(n), "vegetation", 2, {place(random), 0, -place(random)}});
        if (lit)
            lamps = {{10, 3, -10}, {50, 2.5, -90}};
        probes = {{30, 2, -30}};
        if (with_kit)
            add_kit(lit, [&] { return glm::dvec3(place(random), 0, -place(random)); });
    }

    // One-sided rooms, wall on wall, panes of glass, solids and walls with two sides, and volumes of each
    // kind.
    void add_kit(bool lit, const std::function<glm::dvec3()>& somewhere) {
        for (const glm::dvec2& cell : {glm::dvec2(2, 3), {3, 3}, {2, 4}, {3, 4}, {2, 5}})
            things.push_back({"room", "", room_mesh, {kit_m * cell.x, 0, -kit_m * cell.y}});
        for (int n = 0; n < 6; ++n)
            things.push_back({"pane_" + std::to_string(n), "", pane_mesh, somewhere()});
        for (int n = 0; n < 4; ++n) {
            things.push_back(
                {"boulder_" + std::to_string(n), n % 2 == 0 ? "" : "vegetation", boulder_mesh, somewhere()});
            things.push_back({"wall_" + std::to_string(n), "", wall_mesh, somewhere()});
        }
        things.push_back({"empty", "no_probes", block_mesh, somewhere()});
        things.push_back({"dense", "", boulder_mesh, {20, 0, -20}, 2.5});
        things.push_back({"inside", "interior", block_mesh, {30, 0, -30}});  // of its probe
        if (lit)
            lamps.emplace_back(20, 4, -28);  // in the plane of a ceiling
        probes.emplace_back(18, 1.5, -27);
    }

    // As brown as the stones are, so that an edit of their colour is one of the panes too.
    [[nodiscard]] int glass_material(GltfBuilder& b) const {
        const int glass = b.add_material({.colour = colours[1]});
        b.json["materials"][static_cast<std::size_t>(glass)]["extensions"]["KHR_materials_transmission"] = {
            {"transmissionFactor", 0.8}};
        return glass;
    }

    [[nodiscard]] GltfBuilder build() const {
        GltfBuilder b;
        std::vector<int> materials;
        // Leaves let light through: paths step over surfaces.
        for (const glm::vec4& colour : colours)
            materials.push_back(b.add_material({.colour = colour, .double_sided = materials.size() == 2}));
        const std::vector<int> meshes = {
            b.add_mesh(ground(130), materials[0]),
            b.add_mesh(box({-2, 0, -2}, {2, 5, 2}), materials[1]),
            b.add_mesh(box({-crown_m, 1, -crown_m}, {crown_m, 5, crown_m}), materials[2]),
            b.add_mesh(room({0, 0, -8}, {8, 4, 0}), materials[1]),
            b.add_mesh(quad({-3, 0, 0}, {3, 0, 0}, {3, 4, 0}, {-3, 4, 0}), glass_material(b)),
            b.add_mesh(box({-4, -1, -4}, {4, 3, 4}), materials[2]),
            b.add_mesh(quad({-6, 0, 0}, {6, 0, 0}, {6, 4, 0}, {-6, 4, 0}), materials[2])};
        b.add_node({.mesh = meshes[0], .name = "ground"});
        for (const Thing& thing : things)
            b.add_node({.mesh = meshes[static_cast<std::size_t>(thing.mesh)],
                        .translation = thing.at,
                        .name = thing.name,
                        .role = thing.role,
                        .spacing = thing.spacing});
        for (std::size_t n = 0; n < lamps.size(); ++n)
            b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", lamp_candela}}),
                        .translation = lamps[n],
                        .name = "lamp",
                        .light_group = n < lamp_groups.size() ? lamp_groups[n] : ""});
        for (const glm::dvec3& probe : probes)
            b.add_node({.translation = probe, .name = "probe", .role = "probe"});
        return b;
    }
};

settings::BakeSettings settings_of_yard(std::uint32_t rays, bool local, std::uint32_t bounces = 3) {
    settings::BakeSettings settings;
    settings.bounces = bounces;
    settings.rays = rays;
    settings.reach_m = 90;
    settings.local_transfer = local;
    settings.local_rays = 32;
    return settings;
}

// The largest difference of a coefficient of one probe, as a share of its range.
float error_of_probe(const Sector& a, const Sector& b, std::size_t p) {
    float worst = 0;
    const auto differ = [&](float x, float y, float range) {
        worst = std::max(worst, std::abs(x - y) / range);
    };
    const auto irradiance = [p](const std::vector<StaticIrradiance>& light, std::size_t c, std::size_t k) {
        return light.empty() ? 0.0f
                             : decode_fixed(light[p].codes[c][k], scale_of_exponent(light[p].exponent));
    };
    const auto group = [](const Sector& sector, const std::string& name) {
        const auto found = std::ranges::find(sector.light_groups, name, &LightGroup::name);
        return found == sector.light_groups.end() ? std::vector<StaticIrradiance>() : found->irradiance;
    };
    for (std::size_t k = 0; k < basis_count; ++k) {
        differ(decode_fixed(a.probes[p].sky_visibility[k], sky_visibility_scale),
               decode_fixed(b.probes[p].sky_visibility[k], sky_visibility_scale), 1);
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t i = 0; i < sh_count; ++i)
                differ(decode_fixed(a.probes[p].transfer[c][k][i], transfer_scale),
                       decode_fixed(b.probes[p].transfer[c][k][i], transfer_scale),
                       i == 0 ? 0.2821f : 0.9772f);
            differ(irradiance(a.static_irradiance, c, k), irradiance(b.static_irradiance, c, k),
                   bake::static_irradiance_range);
            for (const char* name : {"lanterns", "windows"})
                differ(irradiance(group(a, name), c, k), irradiance(group(b, name), c, k),
                       bake::static_irradiance_range);
        }
    }
    return worst;
}

// Of all probes; more than any where they stand elsewhere.
float error_between(const Sector& a, const Sector& b) {
    if (a.probes.size() != b.probes.size() || a.grid != b.grid)
        return 9;
    float worst = 0;
    for (std::size_t p = 0; p < a.probes.size(); ++p) {
        if (a.probes[p].position != b.probes[p].position)
            return 9;
        worst = std::max(worst, error_of_probe(a, b, p));
    }
    return worst;
}

struct Tally {
    int hits = 0, near_hits = 0, rebakes = 0, same = 0;
};

// Bakes both and holds every verdict against them.
Tally check(const Yard& before, const Yard& after, const settings::BakeSettings& settings, float tolerance,
            const std::string& what) {
    const trace::FloatMode float_mode;
    const auto old_world = open_world(before.build()), new_world = open_world(after.build());
    const auto changes =
        reuse::changes_between(reuse::take_inventory(*old_world), reuse::take_inventory(*new_world));
    Tally tally;
    for (std::int32_t j = -1; j <= 1; ++j) {
        for (std::int32_t i = -1; i <= 1; ++i) {
            const reuse::Rebake was = reuse::bake_and_record(*old_world, {i, j}, settings).value(),
                                is = reuse::bake_and_record(*new_world, {i, j}, settings).value();
            const auto footprint = reuse::decode_footprint(reuse::encode_footprint(was.footprint)).value();
            const reuse::Assessment assessment =
                reuse::assess(footprint, {settings, tolerance}, changes, *new_world);
            const bool same = encoded(was.baked.sector) == encoded(is.baked.sector);
            tally.same += same ? 1 : 0;
            switch (assessment.verdict) {
                case reuse::Verdict::hit:
                    ++tally.hits;
                    EXPECT_TRUE(same) << what << ": sector (" << i << ", " << j << ") is said to be the same";
                    break;
                case reuse::Verdict::near_hit:
                    ++tally.near_hits;
                    EXPECT_LE(assessment.bound, tolerance);
                    EXPECT_LE(error_between(was.baked.sector, is.baked.sector), assessment.bound + 0x1p-13f)
                        << what << ": sector (" << i << ", " << j << "), "
                        << reuse::describe(assessment, changes);
                    break;
                case reuse::Verdict::rebake:
                    ++tally.rebakes;
                    EXPECT_FALSE(reuse::describe(assessment, changes).empty());
                    break;
            }
        }
    }
    return tally;
}

std::string edit(Yard& yard, std::mt19937& random) {
    std::uniform_real_distribution<double> shift(-4, 4), place(-60, 124), share(0.5, 1);
    Yard::Thing& thing = yard.things[random() % yard.things.size()];
    switch (random() % 10) {
        case 0:
        case 1:
            thing.at += glm::dvec3(shift(random), 0, shift(random));
            if (thing.mesh == Yard::room_mesh)  // to a place beside the others
                thing.at =
                    glm::round((thing.at + glm::dvec3(shift(random), 0, 4)) / Yard::kit_m) * Yard::kit_m;
            return thing.name + " moved";
        case 2: {
            const std::string name = thing.name;
            yard.things.erase(yard.things.begin() + (&thing - yard.things.data()));
            return name + " deleted";
        }
        case 3:
            yard.things.push_back({"new", "vegetation", 2, {place(random), 0, -place(random)}});
            return "a tree added";
        case 4:
            yard.colours[random() % 3].y *= static_cast<float>(share(random));
            return "a material recoloured";
        case 5:
            if (thing.role == "no_probes" || thing.role == "interior" || thing.spacing > 0)
                return "nothing";
            thing.role = thing.role.empty() ? "vegetation" : "";
            return thing.name + " has another role";
        case 6:
            yard.crown_m *= 1.1f;
            return "the trees' mesh edited";
        case 7:
            if (yard.lamps.empty())
                return "nothing";
            yard.lamps[0].x += 0.5;
            return "a lamp moved";
        case 8:
            yard.lamp_groups[random() % 2] = random() % 2 == 0 ? "windows" : "lanterns";
            return "a lamp in another group";
        default:
            yard.probes.push_back({place(random), 2, -place(random)});
            return "a probe added";
    }
}

class RandomEdits : public testing::TestWithParam<unsigned> {};

TEST_P(RandomEdits, HoldWhatIsPromised) {
    std::mt19937 random(GetParam());
    Yard yard(GetParam(), GetParam() % 2 == 0, GetParam() % 4 >= 2);
    const settings::BakeSettings settings =
        settings_of_yard(64, GetParam() % 4 == 1, GetParam() % 3 == 0 ? 0 : 3);
    for (int n = 0; n < edits_or(4); ++n) {
        Yard edited = yard;
        const std::string what = "seed " + std::to_string(GetParam()) + ", edit " + std::to_string(n) + ": " +
                                 edit(edited, random);
        check(yard, edited, settings, n % 2 == 0 ? 0 : 1 / 32.0f, what);
        yard = edited;
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomEdits, testing::Range(1u, 9u));

// Edits one after the other, each baked on top of what was left of the one before, as a farm does it.
class ChainsOfEdits : public testing::TestWithParam<unsigned> {};

TEST_P(ChainsOfEdits, TakeOverWhatHolds) {
    const float tolerance = GetParam() % 2 == 0 ? 0 : 1 / 32.0f;
    const trace::FloatMode float_mode;
    std::mt19937 random(GetParam());
    Yard yard(GetParam(), GetParam() % 4 >= 2, tolerance == 0);
    const settings::BakeSettings settings =
        settings_of_yard(tolerance == 0 ? 32 : 256, false, GetParam() % 3 == 0 ? 1 : 2);
    struct State {
        reuse::Rebake rebake;
        reuse::Inventory inventory;  // of its map
    };
    std::map<map::SectorCoordinate, State> states;
    std::size_t taken_over = 0, baked_again = 0, off = 0;
    constexpr int whole_chain = 7;
    const int edits = edits_or(whole_chain);
    for (int n = 0; n <= edits; ++n) {
        const std::string what = "seed " + std::to_string(GetParam()) + ", " + std::to_string(n) + ": " +
                                 (n == 0 ? "" : edit(yard, random));
        const auto world = open_world(yard.build());
        const reuse::Inventory inventory = reuse::take_inventory(*world);
        for (std::int32_t j = -1; j <= 1; ++j) {
            for (std::int32_t i = -1; i <= 1; ++i) {
                const reuse::Rebake fresh = reuse::bake_and_record(*world, {i, j}, settings).value();
                const auto known = states.find({i, j});
                if (known == states.end()) {
                    states[{i, j}] = {fresh, inventory};
                    continue;
                }
                State& state = known->second;
                const auto changes = reuse::changes_between(state.inventory, inventory);
                // As it comes back from the store.
                reuse::EarlierBake earlier{
                    state.rebake.baked.sector,
                    reuse::decode_footprint(reuse::encode_footprint(state.rebake.footprint)).value(),
                    {}};
                earlier.assessment = reuse::assess(earlier.footprint, {settings, tolerance}, changes, *world);
                if (earlier.assessment.verdict == reuse::Verdict::rebake) {
                    state = {reuse::bake_and_record(*world, {i, j}, settings, &earlier).value(), inventory};
                    taken_over += state.rebake.probes_reused;
                    baked_again += state.rebake.baked.sector.probes.size() - state.rebake.probes_reused;
                    ASSERT_LE(error_between(state.rebake.baked.sector, fresh.baked.sector), 1) << what;
                    for (std::size_t p = 0; p < fresh.baked.sector.probes.size(); ++p) {
                        const float bound =
                            state.rebake.footprint.probes[p].changed_weight * state.rebake.footprint.gain();
                        off += bound > 0 ? 1 : 0;
                        EXPECT_LE(error_of_probe(state.rebake.baked.sector, fresh.baked.sector, p),
                                  bound + (bound > 0 ? 0x1p-13f : 0))
                            << what << ", probe " << p;
                    }
                }
                if (tolerance == 0) {
                    EXPECT_EQ(encoded(state.rebake.baked.sector), encoded(fresh.baked.sector))
                        << what << ", sector (" << i << ", " << j << ")";
                } else {
                    EXPECT_LE(error_between(state.rebake.baked.sector, fresh.baked.sector),
                              tolerance + 0x1p-13f)
                        << what << ", sector (" << i << ", " << j << ")";
                }
            }
        }
    }
    if (edits < whole_chain)  // a few edits may leave nothing to take over
        return;
    EXPECT_GT(taken_over, 0u);
    EXPECT_GT(baked_again, 0u);
    EXPECT_EQ(off > 0, tolerance > 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ChainsOfEdits, testing::Range(1u, 11u));

// What placement asked once is not asked again: a ray of a solid test that may end otherwise by now is one
// less that has to change.
TEST(EarlierBake, RaysOfSolidTestsAreUsedUp) {
    const trace::FloatMode float_mode;
    const Yard yard(3, false);
    const settings::BakeSettings settings = settings_of_yard(32, false);
    const auto world = open_world(yard.build());
    const reuse::Rebake was = reuse::bake_and_record(*world, {0, 0}, settings).value();
    reuse::EarlierBake earlier{was.baked.sector, was.footprint,
                               reuse::assess(was.footprint, {settings, 0}, {}, *world)};
    ASSERT_EQ(earlier.assessment.flips.size(), was.footprint.solid_tests.size());
    const auto test = static_cast<std::size_t>(
        std::ranges::max_element(was.footprint.solid_tests, {}, &placement::SolidTest::to_flip) -
        was.footprint.solid_tests.begin());
    const placement::SolidTest before = was.footprint.solid_tests[test];
    ASSERT_GE(before.to_flip, 2);
    earlier.assessment.flips[test] = 1;
    const auto tests =
        reuse::bake_and_record(*world, {0, 0}, settings, &earlier).value().footprint.solid_tests;
    EXPECT_EQ(std::ranges::count(tests, placement::SolidTest{before.position,
                                                             static_cast<std::uint8_t>(before.to_flip - 1)}),
              1);
    EXPECT_EQ(std::ranges::count(tests, before), 0);
}

// What is taken over may have been seen among brighter surfaces, and what is new shines on those when they
// come back.
TEST(EarlierBake, TheGainIsOfTheBrighterMap) {
    const trace::FloatMode float_mode;
    const Yard yard(3, true);
    const settings::BakeSettings settings = settings_of_yard(32, false);
    const auto world = open_world(yard.build());
    const reuse::Rebake was = reuse::bake_and_record(*world, {0, 0}, settings).value();
    ASSERT_GT(was.footprint.static_gain, 0);
    reuse::EarlierBake earlier{was.baked.sector, was.footprint,
                               reuse::assess(was.footprint, {settings, 1 / 512.0f}, {}, *world)};
    earlier.assessment.static_gain = 0;
    const auto footprint = [&] {
        return reuse::bake_and_record(*world, {0, 0}, settings, &earlier).value().footprint;
    };
    earlier.footprint.max_scattered = 2 * was.footprint.max_scattered;
    // As it was, exactly: nothing is left of the map before.
    EXPECT_EQ(footprint().static_gain, was.footprint.static_gain);
    EXPECT_EQ(footprint().max_scattered, was.footprint.max_scattered);
    earlier.assessment.probe_bounds[0] = 0.001f;
    EXPECT_GE(footprint().static_gain, 2 * was.footprint.static_gain);
    EXPECT_LE(footprint().static_gain, 16 * was.footprint.static_gain);
    EXPECT_EQ(footprint().max_scattered, 2 * was.footprint.max_scattered);
    earlier.assessment.static_gain = 100 * was.footprint.static_gain;
    EXPECT_EQ(footprint().static_gain, 100 * was.footprint.static_gain);
}

// An earlier bake that does not belong to the sector's map is of no use, and does no harm.
TEST(EarlierBake, OfOtherHeightsOrOfAnotherFileIsNotUsed) {
    const trace::FloatMode float_mode;
    const Yard yard(3, false);
    Yard tower = yard;
    tower.things.push_back({"tower", "", 1, {100, 60, -100}});
    const settings::BakeSettings settings = settings_of_yard(32, false);
    const auto before = open_world(yard.build()), after = open_world(tower.build());
    const reuse::Rebake was = reuse::bake_and_record(*before, {0, 0}, settings).value(),
                        is = reuse::bake_and_record(*after, {0, 0}, settings).value();
    const auto changes =
        reuse::changes_between(reuse::take_inventory(*before), reuse::take_inventory(*after));
    reuse::EarlierBake earlier{was.baked.sector, was.footprint,
                               reuse::assess(was.footprint, {settings, 0}, changes, *after)};
    const reuse::Rebake higher = reuse::bake_and_record(*after, {0, 0}, settings, &earlier).value();
    EXPECT_EQ(higher.probes_reused, 0u);
    EXPECT_EQ(encoded(higher.baked.sector), encoded(is.baked.sector));
    earlier = {is.baked.sector, is.footprint, reuse::assess(is.footprint, {settings, 0}, {}, *after)};
    EXPECT_EQ(reuse::bake_and_record(*after, {0, 0}, settings, &earlier).value().probes_reused,
              is.baked.sector.probes.size());
    earlier.sector.probes.pop_back();
    EXPECT_EQ(encoded(reuse::bake_and_record(*after, {0, 0}, settings, &earlier).value().baked.sector),
              encoded(is.baked.sector));
}

TEST(Assessment, TheSameMapIsAllHits) {
    const Yard yard(3, true);
    Yard renamed = yard;
    for (auto& thing : renamed.things)
        thing.name += "_renamed";
    EXPECT_EQ(check(yard, renamed, settings_of_yard(64, false), 0, "renamed").hits, 9);
}

TEST(Assessment, WhatLiesBeyondTheReachIsAHit) {
    const Yard yard(3, false);
    Yard far = yard;
    far.things.push_back({"far", "", 1, {125, 0, 60}});  // world (125, -60)
    const Tally tally = check(yard, far, settings_of_yard(64, false), 0, "far");
    EXPECT_GE(tally.hits, 3);
    EXPECT_GE(tally.rebakes, 1);
}

// Without bounces only first rays cross it.
TEST(Assessment, FirstRaysCountByThemselves) {
    Yard yard(3, false);
    yard.things.clear();
    Yard high = yard;
    high.things.push_back(
        {"cloud", "", 1, {98, 25, -98}});  // world (98, 98), 25 m up, in the north-eastern sector
    const Tally tally = check(yard, high, settings_of_yard(256, false, 0), 0, "cloud");
    EXPECT_GT(9 - tally.same, 3);
    EXPECT_LE(tally.hits, tally.same);
}

// No ray ever goes there, and yet a probe comes to stand in a cellar that is dug.
TEST(Assessment, PlacementLooksWhereNoRayGoes) {
    const auto cellar = [](bool dug) {
        GltfBuilder b;
        const int both_sides = b.add_material({.colour = {0.5f, 0.5f, 0.5f, 1}, .double_sided = true});
        Shape roof = ground(150);  // and its front looks down: under it is no solid
        for (std::size_t n = 0; n < roof.indices.size(); n += 3)
            std::swap(roof.indices[n], roof.indices[n + 1]);
        b.add_node({.mesh = b.add_mesh(roof, both_sides), .name = "ground"});
        if (dug)
            b.add_node({.mesh = b.add_mesh(box({10, -10, -18}, {22, -9, -6})), .name = "floor"});
        return open_world(b);
    };
    const trace::FloatMode float_mode;
    const settings::BakeSettings settings = settings_of_yard(64, false);
    const auto before = cellar(false), after = cellar(true);
    const auto changes =
        reuse::changes_between(reuse::take_inventory(*before), reuse::take_inventory(*after));
    const reuse::Rebake was = reuse::bake_and_record(*before, {0, 0}, settings).value(),
                        is = reuse::bake_and_record(*after, {0, 0}, settings).value();
    ASSERT_GT(is.baked.sector.probes.size(), was.baked.sector.probes.size());
    const reuse::Assessment assessment = reuse::assess(was.footprint, {settings, 1 / 32.0f}, changes, *after);
    EXPECT_EQ(assessment.verdict, reuse::Verdict::rebake);
    EXPECT_EQ(reuse::describe(assessment, changes), "floor was added: it may move probes");
}

// Less than a step of the file's vertices: the grid may have cells on either side.
TEST(Assessment, AnInteriorMovedByAHairIsAChange) {
    Yard yard(3, false);
    yard.things.push_back({"inside", "interior", Yard::block_mesh, {30, 0, -30}});
    Yard moved = yard;
    moved.things.back().at.x += 0.0004;
    const auto changes = reuse::changes_between(reuse::take_inventory(*open_world(yard.build())),
                                                reuse::take_inventory(*open_world(moved.build())));
    EXPECT_EQ(changes.size(), 1u);
}

TEST(Assessment, ToleranceLetsAFarTreeBe) {
    const Yard yard(3, false);
    Yard moved = yard;
    moved.things.back().at = {-62, 0, 62};
    settings::BakeSettings settings = settings_of_yard(1024, false);
    const Tally exact = check(yard, moved, settings, 0, "exact"),
                near = check(yard, moved, settings, 1 / 32.0f, "near");
    EXPECT_EQ(exact.near_hits, 0);
    EXPECT_GT(near.near_hits, 0);
    EXPECT_LT(near.rebakes, exact.rebakes);
}

// Each of these shows in the file, though no ray need cross anything.
TEST(Assessment, LampsAndProbesOfTheNextSectorCount) {
    const Yard yard(3, true);
    Yard lamp = yard, probe = yard;
    lamp.lamp_candela = 400;
    EXPECT_GE(check(yard, lamp, settings_of_yard(64, false), 1 / 32.0f, "lamp").rebakes, 8);
    probe.probes.push_back({-1, 1.5, -34});  // world (-1, 34): a metre beyond the middle sector's border
    EXPECT_GE(check(yard, probe, settings_of_yard(64, false), 1 / 32.0f, "probe").rebakes, 2);
}

// A light group that was too faint for the file is not known of the probes that are taken over: once another
// probe gets more of it, all are baked.
TEST(Rebake, ALightGroupThatAppearsIsThatOfAFullBake) {
    Yard yard(3, true);
    yard.lamp_groups = {"lanterns", "lanterns"};
    yard.lamp_candela = 1e-6;
    const trace::FloatMode float_mode;
    const settings::BakeSettings settings = settings_of_yard(64, false);
    const reuse::Rebake was = reuse::bake_and_record(*open_world(yard.build()), {0, 0}, settings).value();
    ASSERT_TRUE(was.baked.sector.light_groups.empty());
    yard.lamp_candela = 300;
    const auto world = open_world(yard.build());
    // As if every second probe held.
    reuse::Assessment assessment;
    assessment.verdict = reuse::Verdict::rebake;
    assessment.flips.resize(was.footprint.solid_tests.size());
    for (std::size_t p = 0; p < was.baked.sector.probes.size(); ++p)
        assessment.probe_bounds.push_back(p % 2 == 0 ? 0.0f : 1.0f);
    const reuse::EarlierBake earlier{was.baked.sector, was.footprint, assessment};
    const reuse::Rebake is = reuse::bake_and_record(*world, {0, 0}, settings, &earlier).value();
    ASSERT_EQ(is.baked.sector.light_groups.size(), 1u);
    EXPECT_EQ(encoded(is.baked.sector),
              encoded(reuse::bake_and_record(*world, {0, 0}, settings)->baked.sector));
    EXPECT_EQ(is.probes_reused, 0u);
}

// The light of a long thing that shines at one end alone stands far from its middle.
TEST(Assessment, AnEmissiveEndCounts) {
    const auto beam = [](double shift) {
        GltfBuilder b;
        b.add_node({.mesh = b.add_mesh(ground(150), b.add_material({.colour = {0.5f, 0.5f, 0.5f, 1}}))});
        const int grey = b.add_material({.colour = {0.5f, 0.5f, 0.5f, 1}}),
                  glowing = b.add_material({.colour = {0.5f, 0.5f, 0.5f, 1}});
        b.json["materials"][static_cast<std::size_t>(glowing)]["emissiveFactor"] = {1, 1, 1};
        const int mesh = b.add_mesh(box({120, 3, -1}, {140, 4, 0}), grey),
                  end = b.add_mesh(quad({119.9f, 3, -1}, {119.9f, 3, 0}, {119.9f, 4, 0}, {119.9f, 4, -1}),
                                   glowing);
        auto& meshes = b.json["meshes"];
        meshes[static_cast<std::size_t>(mesh)]["primitives"].push_back(
            meshes[static_cast<std::size_t>(end)]["primitives"][0]);
        b.add_node({.mesh = mesh, .translation = glm::dvec3(0, shift, 0), .name = "beam"});
        b.add_node({.translation = glm::dvec3(29.5, 3.5, -0.5), .role = "probe"});
        return open_world(b);
    };
    const trace::FloatMode float_mode;
    const auto before = beam(0), after = beam(0.05);
    const settings::BakeSettings settings = settings_of_yard(32, false);
    const reuse::Footprint footprint = reuse::bake_and_record(*before, {0, 0}, settings).value().footprint;
    ASSERT_EQ(before->lights().emissive().size(), 1u);
    const bake::EmissiveObject& light = before->lights().emissive()[0];
    const auto changes =
        reuse::changes_between(reuse::take_inventory(*before), reuse::take_inventory(*after));
    const reuse::Assessment assessment = reuse::assess(footprint, {settings, 0}, changes, *after);
    int in_reach = 0;
    for (std::size_t p = 0; p < footprint.probes.size(); ++p) {
        if (glm::distance(placement::metres(footprint.probes[p].position), light.centre) - light.radius_m >
            settings.reach_m)
            continue;
        ++in_reach;
        EXPECT_GE(assessment.probe_bounds[p], 1);
    }
    EXPECT_GT(in_reach, 0);
}

TEST(Inventory, ComesBackAsItWasStored) {
    const reuse::Inventory inventory = reuse::take_inventory(*open_world(Yard(5, true).build()));
    EXPECT_EQ(inventory.items.size(), 1u + 14 + 40 + 2 + 1);
    const std::vector<std::uint8_t> bytes = reuse::encode_inventory(inventory);
    const auto back = reuse::decode_inventory(bytes);
    ASSERT_TRUE(back);
    EXPECT_TRUE(reuse::changes_between(inventory, *back).empty());
    for (std::size_t n = 0; n < inventory.items.size(); ++n)
        EXPECT_EQ(back->items[n].name, inventory.items[n].name);
    for (std::size_t size = 0; size < bytes.size(); size += 53)
        EXPECT_FALSE(reuse::decode_inventory(std::span(bytes).first(size)));
}

TEST(Inventory, ChangesAreNamed) {
    const Yard yard(5, true);
    const auto change_of = [&](const std::function<void(Yard&)>& edit_it) {
        Yard other = yard;
        edit_it(other);
        const auto changes = reuse::changes_between(reuse::take_inventory(*open_world(yard.build())),
                                                    reuse::take_inventory(*open_world(other.build())));
        std::string text;
        for (const reuse::Change& change : changes)
            text += reuse::describe(change) + ";";
        return text;
    };
    EXPECT_EQ(change_of([](Yard&) {}), "");
    EXPECT_EQ(change_of([](Yard& y) { y.things[0].at.x += 1; }), "block_0 moved;");
    EXPECT_EQ(change_of([](Yard& y) { y.things[0].role = "vegetation"; }), "block_0 changed;");
    EXPECT_EQ(change_of([](Yard& y) { y.things.erase(y.things.begin()); }), "block_0 was deleted;");
    EXPECT_EQ(change_of([](Yard& y) { y.things.push_back({"hut", "", 1, {}}); }), "hut was added;");
    EXPECT_EQ(change_of([](Yard& y) { y.lamps[1].x += 1; }), "lamp moved;");
    EXPECT_EQ(change_of([](Yard& y) { y.lamp_groups[1] = "windows"; }), "lamp changed;");
    EXPECT_EQ(change_of([](Yard& y) { y.lamp_groups[1] = ""; }), "lamp changed;");
    EXPECT_EQ(change_of([](Yard& y) { y.probes.clear(); }), "probe was deleted;");
}

}  // namespace
}  // namespace drtv::test
