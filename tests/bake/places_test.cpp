// Where probes stand on maps as artists and modellers make them: solids with two sides, walls on the lattice,
// rooms, volumes. World axes; sector (0, 0) unless said.
#include "bakerd/bake/probe_warnings.h"
#include "bakerd/bake/sector_bake.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <ranges>

namespace drtv::test {
namespace {

using Places = std::vector<glm::vec3>;

settings::BakeSettings draft(float min_distance_m = 6) {
    settings::BakeSettings settings;
    settings.rays = 64;
    settings.reach_m = 128;
    settings.min_distance_m = min_distance_m;
    return settings;
}

bake::BakedSector baked(const GltfBuilder& b, float min_distance_m = 6,
                        map::SectorCoordinate sector = {0, 0}) {
    const trace::FloatMode float_mode;
    return bake::bake_sector(*open_world(b), sector, draft(min_distance_m)).value();
}

Places places(const bake::BakedSector& sector) {
    Places found;
    for (const placement::Position& position : sector.positions)
        found.push_back(placement::metres(position));
    return found;
}

std::size_t count_in(const Places& all, const glm::vec3& low, const glm::vec3& high) {
    return static_cast<std::size_t>(std::ranges::count_if(all, [&](const glm::vec3& p) {
        return glm::all(glm::greaterThan(p, low)) && glm::all(glm::lessThan(p, high));
    }));
}

Shape world_box(const glm::vec3& low, const glm::vec3& high, bool inwards = false) {
    return in_gltf(inwards ? room(low, high) : box(low, high));
}

struct Scene {
    GltfBuilder b;
    int plain = 0, two_sided = 0;

    explicit Scene(bool with_ground = true) {
        plain = b.add_material({.colour = {0.5f, 0.5f, 0.5f, 1}});
        two_sided = b.add_material({.colour = {0.5f, 0.5f, 0.5f, 1}, .double_sided = true});
        if (with_ground)
            b.add_node({.mesh = b.add_mesh(ground(150), plain), .name = "ground"});
    }
    void add(const Shape& shape, int material, const std::string& name, const std::string& role = "") {
        b.add_node({.mesh = b.add_mesh(shape, material), .name = name, .role = role});
    }
    void add_probe(const glm::vec3& at, const std::string& name) {
        b.add_node({.translation = glm::dvec3(gltf_from_world(at)), .name = name, .role = "probe"});
    }
};

bool says(const bake::BakedSector& sector, const std::string& words) {
    return std::ranges::any_of(sector.warnings,
                               [&](const std::string& w) { return w.find(words) != w.npos; });
}

constexpr glm::vec3 low(20, 20, -1), high(34, 34, 8);

TEST(Solids, HoldNoProbeWhateverTheirSidesAndRole) {
    for (const auto& [two_sided, role] :
         {std::pair(false, ""), {true, ""}, {false, "vegetation"}, {true, "vegetation"}}) {
        Scene scene;
        scene.add(world_box(low, high), two_sided ? scene.two_sided : scene.plain, "block", role);
        const bake::BakedSector sector = baked(scene.b);
        EXPECT_EQ(count_in(places(sector), low, high), 0u) << two_sided << role;
        for (std::size_t p = 0; p < sector.sector.probes.size(); ++p)
            EXPECT_FALSE(bake::is_dark(sector.sector, p)) << two_sided << role;
    }
}

// Each wall a primitive of its own; turned and mirrored as an instance; two rocks into each other.
TEST(Solids, AreClosedAcrossPrimitivesInstancesAndEachOther) {
    Scene parts;
    const Shape whole = world_box(low, high);
    int mesh = -1;
    for (std::size_t n = 0; n < whole.indices.size(); n += 6) {
        Shape wall = whole;
        wall.indices.assign(whole.indices.begin() + static_cast<std::ptrdiff_t>(n),
                            whole.indices.begin() + static_cast<std::ptrdiff_t>(n + 6));
        if (mesh < 0)
            mesh = parts.b.add_mesh(wall, parts.two_sided);
        else
            parts.b.add_primitive(mesh, wall, n % 12 == 0 ? parts.plain : parts.two_sided);
    }
    parts.b.add_node({.mesh = mesh, .name = "walls", .role = "vegetation"});
    EXPECT_EQ(count_in(places(baked(parts.b)), low, high), 0u);

    Scene mirrored;
    mirrored.b.add_node({.mesh = mirrored.b.add_mesh(box({-7, -1, -7}, {7, 8, 7}), mirrored.two_sided),
                         .translation = glm::dvec3(27, 0, -27),
                         .scale = glm::dvec3(-1, 1, 1),
                         .name = "block",
                         .role = "vegetation"});
    EXPECT_EQ(count_in(places(baked(mirrored.b)), low, high), 0u);

    Scene rocks;
    rocks.add(world_box({20, 20, -1}, {29, 34, 8}), rocks.two_sided, "west", "vegetation");
    rocks.add(world_box({25, 20, -1}, {34, 34, 6}), rocks.two_sided, "east", "vegetation");
    EXPECT_EQ(count_in(places(baked(rocks.b)), low, {34, 34, 6}), 0u);
}

// A tent of sheets without a floor, its fronts outwards, ends and all.
Shape bottomless(const glm::vec3& a, const glm::vec3& b) {
    Shape shape = box(a, b);
    const auto is_floor = [&](std::size_t n) {
        return std::ranges::all_of(std::views::iota(n, n + 3),
                                   [&](std::size_t k) { return shape.positions[shape.indices[k]].z == a.z; });
    };
    std::vector<std::uint32_t> kept;
    for (std::size_t n = 0; n < shape.indices.size(); n += 3) {
        if (!is_floor(n))
            kept.insert(kept.end(), shape.indices.begin() + static_cast<std::ptrdiff_t>(n),
                        shape.indices.begin() + static_cast<std::ptrdiff_t>(n + 3));
    }
    shape.indices = kept;
    return in_gltf(shape);
}

TEST(Solids, WithoutABottomAreSolidsToo) {
    for (const char* role : {"", "vegetation"}) {
        Scene scene;
        scene.add(bottomless(low, high), scene.two_sided, "rock", role);
        EXPECT_EQ(count_in(places(baked(scene.b)), low, high), 0u) << role;
    }
}

// Patches all around, their fronts outwards, with gaps that show no sky; and cards that look any way.
TEST(Solids, ACrownOfPatchesIsOneAndACrownOfCardsIsNone) {
    for (const bool outwards : {true, false}) {
        Scene scene(false);
        Shape crown;
        for (int n = 0; n < 600; ++n) {
            const float z = 1 - 2 * (static_cast<float>(n) + 0.5f) / 600,
                        turn = 2.399963f * static_cast<float>(n);
            const glm::vec3 out(std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn),
                                z);
            const glm::vec3 centre = glm::vec3(28, 28, 12) + out * 9.0f;
            const glm::vec3 face = outwards || n % 2 == 0 ? out : -out;
            const glm::vec3 u = glm::normalize(glm::cross(face, glm::vec3(0.3f, 0.5f, 0.8f))) * 1.2f;
            const glm::vec3 v = glm::normalize(glm::cross(face, u)) * 1.2f;
            const Shape patch = quad(centre - u - v, centre + u - v, centre + u + v, centre - u + v);
            const auto first = static_cast<std::uint32_t>(crown.positions.size());
            crown.positions.insert(crown.positions.end(), patch.positions.begin(), patch.positions.end());
            for (const std::uint32_t index : patch.indices)
                crown.indices.push_back(first + index);
        }
        scene.add(in_gltf(crown), scene.two_sided, "crown", "vegetation");
        // Something to stand on inside.
        scene.add(in_gltf(quad({24, 24, 10}, {32, 24, 10}, {32, 32, 10}, {24, 32, 10})), scene.plain,
                  "plank");
        EXPECT_EQ(count_in(places(baked(scene.b)), {22, 22, 6}, {34, 34, 18}) == 0, outwards);
    }
}

// A cupboard in the corner of a room, one mesh, an edge of both at one place.
TEST(Solids, ThatTouchARoomInAnEdgeStaySolids) {
    Scene scene;
    const int mesh = scene.b.add_mesh(world_box({10, 10, 0.1f}, {46, 46, 6}, true), scene.two_sided);
    scene.b.add_primitive(mesh, world_box({10, 10, 0.1f}, {22, 22, 6}), scene.two_sided);
    scene.b.add_node({.mesh = mesh, .name = "room and cupboard"});
    const Places all = places(baked(scene.b));
    EXPECT_EQ(count_in(all, {10, 10, 0}, {22, 22, 6}), 0u);
    EXPECT_GT(count_in(all, {22, 22, 0}, {46, 46, 6}), 0u);
}

// However the frame of the room's object is turned.
TEST(Rooms, OfAnObjectOfTheirOwnAreFreeHoweverTheyAreTurned) {
    for (const double turn : {0.0, 0.3, 0.785}) {
        Scene scene;
        scene.add(world_box({20, 20, -1}, {36, 36, 6}), scene.two_sided, "house");
        scene.b.add_node({.mesh = scene.b.add_mesh(room({-5, 0, -5}, {5, 5, 5}), scene.two_sided),
                          .translation = glm::dvec3(28, 0.2, -28),
                          .rotation = glm::dvec4(0, std::sin(turn / 2), 0, std::cos(turn / 2)),
                          .name = "room"});
        EXPECT_GT(count_in(places(baked(scene.b)), {22, 22, 0}, {34, 34, 5}), 0u) << turn;
    }
}

// Walls of a metre: the room is a cavity of one mesh, or an object of its own.
TEST(Rooms, WithThickWallsAreFree) {
    for (const bool one_mesh : {true, false}) {
        Scene scene;
        const int shell = scene.b.add_mesh(world_box({20, 20, -1}, {36, 36, 6}), scene.two_sided);
        const Shape inside = world_box({21, 21, 0}, {35, 35, 5}, true);
        if (one_mesh)
            scene.b.add_primitive(shell, inside, scene.two_sided);
        else
            scene.add(inside, scene.two_sided, "room");
        scene.b.add_node({.mesh = shell, .name = "house"});
        const Places all = places(baked(scene.b));
        EXPECT_GT(count_in(all, {21, 21, 0}, {35, 35, 5}), 0u) << one_mesh;
        EXPECT_EQ(count_in(all, {20, 20, 0}, {36, 36, 6}), count_in(all, {21, 21, 0}, {35, 35, 5}));
    }
}

TEST(Rooms, ACellarUnderTheGroundIsFree) {
    Scene scene;
    scene.add(world_box({20, 20, -8}, {32, 32, -3}, true), scene.plain, "cellar");
    const bake::BakedSector sector = baked(scene.b);
    EXPECT_GT(count_in(places(sector), {20, 20, -8}, {32, 32, -3}), 0u);
    EXPECT_TRUE(says(sector, "probes are dark") || says(sector, "probe is dark"))
        << "named, because it stays";
    EXPECT_TRUE(says(sector, "under 'cellar'"));
}

TEST(Rooms, AHutOfSheetsWithAnOpeningIsFree) {
    Scene scene;
    Shape hut = bottomless({20, 20, 0}, {32, 32, 4});
    hut.indices.erase(hut.indices.end() - 6, hut.indices.end());  // without its last wall
    scene.add(hut, scene.two_sided, "hut");
    EXPECT_GT(count_in(places(baked(scene.b)), {20, 20, 0}, {32, 32, 4}), 0u);
}

// A house of 8 x 6 m: the roof's probe is within 6 m of the one indoors.
TEST(Rooms, ProbesIndoorsAreNotThinnedByTheRoofs) {
    Scene scene;
    scene.add(world_box({24, 24, 0}, {32, 30, 3}, true), scene.plain, "indoors");
    scene.add(bottomless({23.9f, 23.9f, -1}, {32.1f, 30.1f, 3.1f}), scene.plain, "outdoors");
    const Places all = places(baked(scene.b));
    EXPECT_GT(count_in(all, {24, 24, 0}, {32, 30, 3}), 0u);
    EXPECT_GT(count_in(all, {23, 23, 3.5f}, {33, 31, 6}), 0u);
}

TEST(Floors, ATwoSidedSheetIsOneHoweverItIsWound) {
    std::size_t counts[2];
    for (const bool turned : {false, true}) {
        Scene scene(false);
        Shape sheet = ground(150);
        for (std::size_t n = 0; turned && n < sheet.indices.size(); n += 3)
            std::swap(sheet.indices[n], sheet.indices[n + 1]);
        scene.add(sheet, scene.two_sided, "ground");
        counts[turned ? 1 : 0] = places(baked(scene.b)).size();
    }
    EXPECT_EQ(counts[0], 64u);
    EXPECT_EQ(counts[1], 64u);
}

TEST(Floors, TheLowerSideOfASlabIsNone) {
    Scene scene(false);
    scene.add(world_box({-100, -100, 0}, {100, 100, 3}), scene.two_sided, "slab");
    const Places all = places(baked(scene.b));
    EXPECT_EQ(all.size(), 64u);
    EXPECT_TRUE(std::ranges::all_of(all, [](const glm::vec3& p) { return p.z == 4; }));
}

TEST(Floors, ATwoSidedSlabHasOneOnTopHoweverItIsWound) {
    for (const bool inwards : {false, true}) {
        Scene scene(false);
        scene.add(world_box({-100, -100, 0}, {100, 100, 10}, inwards), scene.two_sided, "slab");
        EXPECT_EQ(count_in(places(baked(scene.b)), {0, 0, 10}, {64, 64, 12}), 64u) << inwards;
    }
}

TEST(Floors, InsideAClosedDomeThatLooksOutwardsAreMissedAloud) {
    Scene scene;
    scene.add(world_box({-300, -300, -50}, {300, 300, 200}), scene.two_sided, "dome");
    EXPECT_TRUE(says(baked(scene.b), "most of its ground lies inside 'dome'"));
}

// A rock sunk into a hill that the sea goes on under; the hill ends in the open, so that rays escape.
TEST(Floors, UnderTheGroundAreNoneWhateverIsSunkIntoIt) {
    Scene scene;  // the sea
    scene.add(in_gltf(quad({-40, -40, 8}, {100, -40, 8}, {100, 100, 8}, {-40, 100, 8})), scene.plain, "hill");
    scene.add(world_box({20, 20, 6}, {34, 34, 12}), scene.two_sided, "rock");
    EXPECT_EQ(count_in(places(baked(scene.b)), {0, 0, 0}, {64, 64, 7}), 0u);
}

// Two floors at one height, one of them two-sided, and a ceiling that touches; in both orders.
TEST(Floors, OfOneHeightDoNotDependOnTheirOrder) {
    Places found[2];
    for (const bool swapped : {false, true}) {
        Scene scene(false);
        Shape up = ground(150), down = ground(150);
        for (std::size_t n = 0; n < down.indices.size(); n += 3)
            std::swap(down.indices[n], down.indices[n + 1]);
        Shape both;
        for (const Shape& shape : swapped ? std::vector{down, up} : std::vector{up, down}) {
            const auto first = static_cast<std::uint32_t>(both.positions.size());
            both.positions.insert(both.positions.end(), shape.positions.begin(), shape.positions.end());
            for (const std::uint32_t index : shape.indices)
                both.indices.push_back(first + index);
        }
        scene.add(both, scene.plain, "ground");
        found[swapped ? 1 : 0] = places(baked(scene.b));
    }
    EXPECT_EQ(found[0].size(), 64u);
    EXPECT_EQ(found[0], found[1]);
}

// The columns stand at 2 + 4 n m, and so do the walls; or a metre beside them.
TEST(Walls, HoldNoProbeAndSeparateCells) {
    for (const float at : {26.0f, 27.0f}) {
        Scene scene;
        const glm::vec3 a(at, at, 0), b(at + 12, at + 12, 4);
        scene.add(world_box(a, b, true), scene.two_sided, "room");
        const bake::BakedSector sector = baked(scene.b);
        const Places all = places(sector);
        const auto near_wall = [&](const glm::vec3& p) {
            const auto near = [](float x, float y) { return std::abs(x - y) < 0.01f; };
            const bool beside =
                p.x > a.x - 0.01f && p.x < b.x + 0.01f && p.y > a.y - 0.01f && p.y < b.y + 0.01f;
            return p.z < 4 && beside &&
                   (near(p.x, a.x) || near(p.x, b.x) || near(p.y, a.y) || near(p.y, b.y));
        };
        EXPECT_TRUE(std::ranges::none_of(all, near_wall)) << at;
        ASSERT_GT(count_in(all, a, b), 0u);
        const Grid& grid = sector.sector.grid;
        for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
            const float height = static_cast<float>(grid.cell_height_units) / 1024;
            const glm::vec3 corner(
                4 * (cell % 16), 4 * (cell / 16 % 16),
                static_cast<float>(grid.z_origin_units) / 1024 + height * static_cast<float>(cell / 256));
            const glm::vec3 end = corner + glm::vec3(4, 4, height);
            const bool inside =
                glm::all(glm::greaterThanEqual(corner, a)) && glm::all(glm::lessThanEqual(end, b));
            const bool outside = glm::any(glm::greaterThanEqual(corner, b)) || end.x <= a.x || end.y <= a.y;
            const bool named_inside = count_in({all[grid.cells[cell]]}, a, b) == 1;
            EXPECT_TRUE(!inside || named_inside) << at << ", cell " << cell;
            EXPECT_TRUE(!outside || !named_inside) << at << ", cell " << cell;
        }
    }
}

// A closed room with a thick pillar that goes through floor and ceiling.
TEST(Walls, NoProbeIsPushedUnderTheFloor) {
    for (const float side : {12.0f, 16.0f, 20.0f, 24.0f}) {
        Scene scene(false);
        scene.add(world_box({4, 4, 0}, {4 + side, 4 + side, 6}, true), scene.plain, "room");
        const float c = 4 + side / 2;
        scene.add(world_box({c - 4.6f, c - 4.6f, -0.2f}, {c + 4.6f, c + 4.6f, 6.2f}), scene.plain, "pillar");
        for (const glm::vec3& p : places(baked(scene.b)))
            EXPECT_GT(p.z, 0) << "a room of " << side << " m";
    }
}

TEST(Probes, PlacedByHandInASolidAWallOrUnderGroundAreNamed) {
    Scene scene;
    scene.add(world_box(low, high), scene.two_sided, "block");
    scene.add(in_gltf(quad({50, 40, 0}, {50, 60, 0}, {50, 60, 9}, {50, 40, 9})), scene.two_sided, "fence");
    scene.add_probe({27, 27, 2}, "in the block");
    scene.add_probe({50, 50, 2}, "in the fence");
    scene.add_probe({10, 50, -3}, "in the ground");
    scene.add_probe({10, 10, 2}, "free");
    const bake::BakedSector sector = baked(scene.b);
    EXPECT_TRUE(says(sector, "the probe 'in the block' at (27.00, 27.00, 2.00) stands inside 'block'"));
    EXPECT_TRUE(says(sector, "the probe 'in the fence' at (50.00, 50.00, 2.00) stands in a wall: 'fence'"));
    EXPECT_TRUE(says(sector, "the probe 'in the ground' at (10.00, 50.00, -3.00) stands under the ground"));
    EXPECT_FALSE(says(sector, "'free'"));
    EXPECT_EQ(std::ranges::count(sector.sector.probes, ProbeKind::manual, &Probe::kind), 4);
}

TEST(Probes, PlacedByHandInTheDarkAreNamed) {
    Scene scene;
    scene.add(world_box({20, 20, 1}, {32, 32, 5}, true), scene.plain, "vault");
    scene.add_probe({26, 26, 3}, "keeper");
    EXPECT_TRUE(says(baked(scene.b), "the probe 'keeper' at (26.00, 26.00, 3.00) is dark"));
}

TEST(Probes, GivenUpInASolidAreReportedWithItsName) {
    Scene scene;
    scene.add(world_box({10, 10, -1}, {50, 50, 30}), scene.two_sided, "mountain", "vegetation");
    const bake::BakedSector sector = baked(scene.b);
    EXPECT_GT(sector.sector.statistics.dropped_in_solid, 0u);
    EXPECT_TRUE(says(sector, "places for probes lie in solids and stay empty: 'mountain'"));
}

TEST(Probes, WithoutGroundMakeASector) {
    Scene scene(false);
    scene.add(in_gltf(quad({1, 1, 0}, {63, 1, 0}, {63, 63, 0}, {1, 63, 0})), scene.plain, "ground");
    scene.add_probe({100, 32, 5}, "over the bridge");
    const auto world = open_world(scene.b);
    EXPECT_EQ(world->sectors(), (std::vector<map::SectorCoordinate>{{0, 0}, {1, 0}}));
    EXPECT_EQ(places(baked(scene.b, 6, {1, 0})), Places{glm::vec3(100, 32, 5)});
}

// Half a metre outside a house whose interior has a probe at its wall.
TEST(Interiors, TheirProbesServeThemAlone) {
    Scene scene;
    scene.add(world_box({20, 24, 0}, {36, 36, 4}), scene.plain, "house", "interior");
    scene.add_probe({21, 26, 1.5f}, "indoors");
    const bake::BakedSector sector = baked(scene.b);
    const Places all = places(sector);
    EXPECT_EQ(all[0], glm::vec3(21, 26, 1.5f));
    EXPECT_GT(count_in(all, {17, 25, 0}, {19, 27, 2}), 0u) << "not thinned out by the one behind the wall";
    const Grid& grid = sector.sector.grid;
    for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
        const bool outside = cell % 16 < 5 || cell % 16 >= 9 || cell / 16 % 16 < 6 || cell / 16 % 16 >= 9;
        EXPECT_FALSE(outside && grid.cells[cell] == 0) << "cell " << cell;
    }
    static_cast<void>(encoded(sector.sector));  // the validator agrees
}

TEST(Interiors, ASectorWithNoOtherProbeLeavesItsOuterCellsEmpty) {
    Scene scene(false);
    scene.add(world_box({24, 24, 0}, {36, 36, 4}), scene.plain, "house", "interior");
    scene.add_probe({30, 30, 1.5f}, "indoors");
    const bake::BakedSector sector = baked(scene.b);
    EXPECT_EQ(sector.sector.grid.cells[7 + 16 * 7 + 256], 0);
    EXPECT_EQ(sector.sector.grid.cells[0], no_probe);
    static_cast<void>(encoded(sector.sector));
}

TEST(Volumes, OfOverlappingPartsAreTheirUnion) {
    Scene scene;
    Shape cubes = world_box({8, 8, -1}, {40, 40, 6});
    const Shape other = world_box({24, 24, -1}, {56, 56, 6});
    const auto first = static_cast<std::uint32_t>(cubes.positions.size());
    cubes.positions.insert(cubes.positions.end(), other.positions.begin(), other.positions.end());
    for (const std::uint32_t index : other.indices)
        cubes.indices.push_back(first + index);
    scene.add(cubes, scene.plain, "two cubes", "no_probes");
    const Places all = places(baked(scene.b));
    EXPECT_EQ(count_in(all, {8, 8, -1}, {40, 40, 6}) + count_in(all, {24, 24, -1}, {56, 56, 6}), 0u);
    EXPECT_GT(all.size(), 20u);

    Scene house;
    house.add(cubes, house.plain, "two halls", "interior");
    house.add_probe({32, 32, 1.5f}, "hall");
    EXPECT_EQ(baked(house.b).sector.interiors.size(), 1u);
}

// Ground of 16 x 16 m, so that no limit of a sector is met.
TEST(Distance, BelowFourMetresPlacesMoreProbes) {
    std::size_t last = 0;
    for (const float distance_m : {6.0f, 4.0f, 3.2f, 2.4f, 2.0f, 1.5f, 1.2f, 1.0f}) {
        Scene scene(false);
        scene.add(in_gltf(quad({8, 8, 0}, {24, 8, 0}, {24, 24, 0}, {8, 24, 0})), scene.plain, "ground");
        const Places all = places(baked(scene.b, distance_m));
        EXPECT_GT(all.size(), last) << distance_m;
        last = all.size();
        for (std::size_t a = 0; a < all.size(); ++a) {
            for (std::size_t b = 0; b < a; ++b)
                EXPECT_GE(glm::distance(all[a], all[b]), distance_m - 0.001f);
        }
    }
    EXPECT_GT(last, 200u);
}

TEST(Distance, BakeSpacingCountsInsideItsVolume) {
    Scene scene;
    scene.b.add_node(
        {.mesh = scene.b.add_mesh(world_box({24, 24, -1}, {36, 36, 6})), .name = "shop", .spacing = 2});
    const bake::BakedSector sector = baked(scene.b);
    const Places all = places(sector);
    EXPECT_EQ(count_in(all, {24, 24, -1}, {36, 36, 6}), 36u) << "and it is no object";
    const std::size_t outside = all.size() - 36;
    EXPECT_GT(outside, 50u);
    EXPECT_LE(outside, 64u);
    // With role static it is the shop itself, and its inside dense; an interior may have a spacing too.
    for (const char* role : {"static", "interior"}) {
        Scene shop;
        shop.b.add_node({.mesh = shop.b.add_mesh(world_box({24, 24, 0}, {36, 36, 6}, true), shop.plain),
                         .name = "shop",
                         .role = role,
                         .spacing = 2});
        EXPECT_EQ(count_in(places(baked(shop.b)), {24, 24, 0}, {36, 36, 6}), 36u) << role;
    }
}

}  // namespace
}  // namespace drtv::test
