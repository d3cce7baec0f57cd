// Sectors with ground: half-open squares, triangles over many sectors, limits.
#include "bakerd/map/ground.h"
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <algorithm>
#include <chrono>

namespace drtv::test {
namespace {

using map::SectorCoordinate;
using Sectors = std::vector<SectorCoordinate>;

tl::expected<Sectors, std::string> try_sectors(const GltfBuilder& b) {
    return map::sectors_of(expect_accepted(b.import()));
}

Sectors sectors_of(const GltfBuilder& b) {
    return expect_accepted(try_sectors(b));
}

// A horizontal quad over the world rectangle.
Shape floor_over(float x0, float y0, float x1, float y1, float z = 0) {
    return quad(gltf_from_world({x0, y0, z}), gltf_from_world({x1, y0, z}), gltf_from_world({x1, y1, z}),
                gltf_from_world({x0, y1, z}));
}

Sectors sectors_of(const Shape& shape, const std::string& role = "") {
    GltfBuilder b;
    b.place(shape, role);
    return sectors_of(b);
}

// All of the rectangle's sectors in the order promised: by j, then by i.
Sectors block(int i0, int j0, int i1, int j1) {
    Sectors sectors;
    for (int j = j0; j <= j1; ++j) {
        for (int i = i0; i <= i1; ++i)
            sectors.push_back({i, j});
    }
    return sectors;
}

TEST(Ground, EmptyMapHasNone) {
    EXPECT_TRUE(sectors_of(GltfBuilder{}).empty());
}

TEST(Ground, SectorIsHalfOpen) {
    EXPECT_EQ(sectors_of(floor_over(0, 0, 64, 64)), block(0, 0, 0, 0));
    EXPECT_EQ(sectors_of(floor_over(0, 0, 63.99f, 63.99f)), block(0, 0, 0, 0));
    EXPECT_EQ(sectors_of(floor_over(64, 128, 65, 129)), block(1, 2, 1, 2));
    EXPECT_EQ(sectors_of(floor_over(0, 0, 64.01f, 64)), block(0, 0, 1, 0));
    EXPECT_EQ(sectors_of(floor_over(-64, -64, 0, 0)), block(-1, -1, -1, -1));
    EXPECT_EQ(sectors_of(floor_over(-0.01f, -0.01f, 64, 64)), block(-1, -1, 0, 0));
}

TEST(Ground, WallOnABorderBelongsToTheEast) {
    EXPECT_EQ(sectors_of(quad(gltf_from_world({64, 1, 0}), gltf_from_world({64, 5, 0}),
                              gltf_from_world({64, 5, 3}), gltf_from_world({64, 1, 3}))),
              block(1, 0, 1, 0));
}

TEST(Ground, BigTriangleCoversItsSectorsOnly) {
    // Right angle at the origin, hypotenuse x + y = 320: sector (i, j) is touched where 64 (i + j) <= 320.
    Sectors expected;
    for (int j = 0; j < 5; ++j) {
        for (int i = 0; i < 5 && i + j < 5; ++i)
            expected.push_back({i, j});
    }
    Sectors found = sectors_of(triangle(gltf_from_world({0.5f, 0.5f, 0}), gltf_from_world({318, 0.5f, 0}),
                                        gltf_from_world({0.5f, 318, 0})));
    EXPECT_EQ(found, expected);
    // Its winding does not matter.
    EXPECT_EQ(sectors_of(triangle(gltf_from_world({0.5f, 0.5f, 0}), gltf_from_world({0.5f, 318, 0}),
                                  gltf_from_world({318, 0.5f, 0}))),
              expected);
}

TEST(Ground, SliverFollowsItsLine) {
    // From (10, 10.5) to (310, 310.5), a metre wide: the diagonal's sectors, and those it cuts a corner of.
    const Sectors found =
        sectors_of(triangle(gltf_from_world({10, 10.5f, 0}), gltf_from_world({310, 310.5f, 0}),
                            gltf_from_world({309, 310.5f, 0})));
    for (const SectorCoordinate& s : found)
        EXPECT_LE(std::abs(s.i - s.j), 1);
    for (int n = 0; n < 5; ++n)
        EXPECT_TRUE(std::ranges::count(found, SectorCoordinate{n, n}) == 1);
    EXPECT_LE(found.size(), 9u);
}

TEST(Ground, DiagonalWallFollowsItsLine) {
    // Vertical: seen from above it is a line without area.
    const Sectors found =
        sectors_of(quad(gltf_from_world({10, 10.5f, 0}), gltf_from_world({310, 310.5f, 0}),
                        gltf_from_world({310, 310.5f, 4}), gltf_from_world({10, 10.5f, 4})));
    for (const SectorCoordinate& s : found)
        EXPECT_LE(std::abs(s.i - s.j), 1);
    for (int n = 0; n < 5; ++n)
        EXPECT_TRUE(std::ranges::count(found, SectorCoordinate{n, n}) == 1);
}

TEST(Ground, HoleHasNone) {
    GltfBuilder b;
    b.place(floor_over(0, 0, 192, 64));
    b.add_primitive(0, floor_over(0, 128, 192, 192));
    Sectors expected = block(0, 0, 2, 0);
    for (const SectorCoordinate& s : block(0, 2, 2, 2))
        expected.push_back(s);
    EXPECT_EQ(sectors_of(b), expected);
}

TEST(Ground, CountsInstancesAndTransforms) {
    GltfBuilder b;
    b.add_instances(b.add_mesh(floor_over(0, 0, 1, 1)),
                    {gltf_from_world({0, 0, 0}), gltf_from_world({640, -640, 0})},
                    {.scale = glm::dvec3(0.5, 1, 0.5)});
    EXPECT_EQ(sectors_of(b), (Sectors{{5, -5}, {0, 0}}));
}

TEST(Ground, VegetationAndVolumesAreNone) {
    for (const char* role : {"vegetation", "ignore", "no_probes", "interior"})
        EXPECT_TRUE(sectors_of(box({0, 0, 0}, {9, 9, 9}), role).empty()) << role;
}

// On a bridge's end, say, beyond the map's ground. On a border as it is placed, in whole units.
// As many sectors as a map may have, and one more.
TEST(Ground, SectorsOfHandPlacedProbesCountToo) {
    map::Map map;
    for (int n = 0; n < 1 << 20; ++n)
        map.probes.push_back({{64.0 * (n % 1024) + 1, 64.0 * (n / 1024) + 1, 0}, ""});
    EXPECT_EQ(map::sectors_of(map)->size(), std::size_t{1} << 20);
    map.probes.push_back({{-1'048'576, 1'048'576, 0}, ""});
    EXPECT_EQ(map::sectors_of(map).error(), "the map covers more than 1048576 sectors");
    map.probes.erase(map.probes.begin(), map.probes.end() - 1);
    EXPECT_EQ(*map::sectors_of(map), (std::vector<map::SectorCoordinate>{{-16384, 16384}}));
}

TEST(Ground, AHandPlacedProbeMakesASector) {
    GltfBuilder b;
    b.place(floor_over(0, 0, 64, 64));
    for (const glm::dvec3& at : {glm::dvec3(100, 5, -32), {-0.0001, 5, 64.0001}})
        b.add_node({.translation = at, .role = "probe"});
    EXPECT_EQ(sectors_of(b), (Sectors{{0, -1}, {0, 0}, {1, 0}}));
}

// A transform leaves the last digit wrong.
TEST(Ground, RoundingAtABorderIsNoGroundBeyondIt) {
    for (const double off : {-2e-5, 0.0, 2e-5}) {
        for (const double at : {0.0, 6400.0}) {
            GltfBuilder b;
            const auto m = [](double metres) { return static_cast<float>(metres); };
            b.place(floor_over(m(at + off), m(at - off), m(at + 64 + off), m(at + 64 - off)));
            const auto n = static_cast<std::int32_t>(at / 64);
            EXPECT_EQ(sectors_of(b), (Sectors{{n, n}})) << at << " + " << off;
        }
    }
    GltfBuilder beyond;
    beyond.place(floor_over(0, 0, 64.5, 64));
    EXPECT_EQ(sectors_of(beyond), (Sectors{{0, 0}, {1, 0}}));
}

TEST(Ground, BeyondTheLimitsIsRefused) {
    const auto at = [](const glm::dvec3& translation) {
        GltfBuilder b;
        b.add_node({.mesh = b.add_mesh(ground(1)), .translation = translation, .name = "isle"});
        return try_sectors(b);
    };
    const double limit = 16384.0 * 64;
    EXPECT_EQ(expect_accepted(at({limit - 2, 0, 0})).back().i, 16383);
    EXPECT_EQ(expect_accepted(at({-limit + 2, 0, 0})).front().i, -16384);
    expect_refused(at({limit, 0, 0}), {"isle", "1048576"});
    expect_refused(at({-limit, 0, 0}), {"isle"});
    expect_refused(at({0, 0, limit}), {"isle"});
    expect_refused(at({0, 0, -limit - 5}), {"isle"});
    expect_accepted(at({0, 8192, 0}));
    expect_refused(at({0, 8193, 0}), {"isle", "8192"});
    expect_refused(at({0, -8193, 0}), {"isle", "8192"});
}

TEST(Ground, TooManySectorsAreRefused) {
    expect_refused(
        [] {
            GltfBuilder b;
            b.add_node(
                {.mesh = b.add_mesh(ground(1)), .scale = glm::dvec3(600000, 1, 600000), .name = "sea"});
            return try_sectors(b);
        }(),
        {"sea", "sectors"});
    EXPECT_EQ(sectors_of(floor_over(0, 0, 64 * 1000, 64 * 1000)).size(), 1000000u);
}

// Each of these triangles spans a million sectors and covers few: the time must stay bounded.
TEST(Ground, ManyHugeSliversEndSoon) {
    GltfBuilder b;
    Shape slivers;
    const float end = 64 * 1000;
    for (int n = 0; n < 20000; ++n) {
        const auto shift = static_cast<float>(n % 100);
        slivers.positions.insert(slivers.positions.end(),
                                 {gltf_from_world({shift, 0, 0}), gltf_from_world({end, end - shift, 0}),
                                  gltf_from_world({end, end, 0})});
    }
    b.place(slivers);
    const map::Map map = expect_accepted(b.import());
    const auto start = std::chrono::steady_clock::now();
    const auto sectors = map::sectors_of(map);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
    if (!sectors)
        expect_refused(sectors, {"sector"});
}

}  // namespace
}  // namespace drtv::test
