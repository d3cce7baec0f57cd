// Interiors: which probe, which file, and that the mesh stays closed in 16 bits.
#include "bakerd/bake/interiors.h"
#include "bakerd/bake/sector_bake.h"
#include "bakerd/bake/sector_file.h"
#include "tests/bake/worlds.h"

#include <drtv/read.h>
#include <drtv/validate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drtv::test {
namespace {

settings::BakeSettings quick() {
    settings::BakeSettings settings;
    settings.rays = 16;
    return settings;
}

// Ground and a room from (4, 4, 0) to (10, 8, 3) in world metres.
struct House {
    GltfBuilder b;

    House() { b.place(ground(200)); }
    void add_room(const std::string& probe = "", const Shape& shape = box({4, 0, -8}, {10, 3, -4})) {
        b.add_node({.mesh = b.add_mesh(shape), .name = "room", .role = "interior", .probe = probe});
    }
    void add_probe(const glm::vec3& world, const std::string& name = "") {
        b.add_node({.translation = glm::dvec3(gltf_from_world(world)), .name = name, .role = "probe"});
    }
    [[nodiscard]] bake::BakedSector bake(map::SectorCoordinate sector) const {
        return bake::bake_sector(*open_world(b), sector, quick()).value();
    }
};

std::array<double, 3> vertex_m(const Interior& interior, std::size_t v) {
    std::array<double, 3> position{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        position[axis] = (interior.origin_units[axis] +
                          static_cast<double>(interior.vertices[v][axis] << interior.shift)) /
                         position_units_per_m;
    return position;
}

TEST(Interior, StandsInTheFileWithTheProbeInside) {
    House house;
    house.add_room();
    house.add_probe({100, 6, 1});  // nearer to the middle of nothing
    house.add_probe({5, 5, 1});
    house.add_probe({6.5f, 6, 1.5f}, "middle");
    const bake::BakedSector baked = house.bake({0, 0});
    ASSERT_EQ(baked.sector.interiors.size(), 1u);
    const Interior& interior = baked.sector.interiors[0];
    EXPECT_EQ(position_units(baked.sector, baked.sector.probes[interior.probe]),
              (std::array<std::int32_t, 3>{6656, 6144, 1536}));
    EXPECT_EQ(baked.sector.probes[interior.probe].kind, ProbeKind::manual);
    EXPECT_EQ(interior.vertices.size(), 8u);
    EXPECT_EQ(interior.triangles.size(), 12u);
    EXPECT_EQ(interior.shift, 0);
    EXPECT_EQ(interior.origin_units, (std::array<std::int32_t, 3>{4096, 4096, 0}));
    EXPECT_TRUE(baked.warnings.empty());
    EXPECT_TRUE(house.bake({1, 0}).sector.interiors.empty());
}

TEST(Interior, NamedProbeDecidesProbeAndSector) {
    House house;
    house.add_room("far");
    house.add_probe({6, 6, 1});
    house.add_probe({100, 20, 2}, "far");
    EXPECT_TRUE(house.bake({0, 0}).sector.interiors.empty());
    const Sector sector = house.bake({1, 0}).sector;
    ASSERT_EQ(sector.interiors.size(), 1u);
    EXPECT_EQ(position_units(sector, sector.probes[sector.interiors[0].probe]),
              (std::array<std::int32_t, 3>{102400, 20480, 2048}));
    EXPECT_EQ(vertex_m(sector.interiors[0], 0)[2], 0);
}

TEST(Interior, WithoutAProbeIsLeftOutWithAWarning) {
    House house;
    house.add_room();
    house.add_probe({100, 6, 1});
    EXPECT_TRUE(house.bake({0, 0}).sector.interiors.empty());
    EXPECT_EQ(open_world(house.b)->warnings(),
              std::vector<std::string>{
                  "the interior 'room' names no probe and no probe node is inside it: no file holds it"});
}

TEST(Interior, StandsInTheSectorOfItsProbeWhereThatHasNoGround) {
    House house;
    house.add_room("far");
    house.add_probe({1000, 6, 1}, "far");
    EXPECT_TRUE(open_world(house.b)->warnings().empty());
    EXPECT_EQ(house.bake({15, 0}).sector.interiors.size(), 1u);
}

TEST(Interior, WarningsOfTheValidatorReachTheArtist) {
    House house;
    house.add_room("outside");
    house.add_probe({30, 30, 1}, "outside");
    bake::BakedSector baked = house.bake({0, 0});
    ASSERT_TRUE(bake::encode_sector(baked.sector, baked.warnings));
    ASSERT_EQ(baked.warnings.size(), 1u);
    EXPECT_EQ(baked.warnings[0],
              "sector (0, 0): INTERIOR_PROBE interior[0] its probe 0 stands outside of its bounds");
}

// A tessellated ball: vertices round, some triangles vanish, and it stays closed whichever way its triangles
// faced.
TEST(Interior, RoundedMeshIsClosedAndOutwards) {
    Shape ball;
    constexpr std::uint32_t rings = 24, segments = 48;
    for (std::uint32_t r = 0; r <= rings; ++r) {
        for (std::uint32_t s = 0; s < segments; ++s) {
            const double theta = std::numbers::pi * r / rings, phi = 2 * std::numbers::pi * s / segments;
            ball.positions.emplace_back(0.02 * std::sin(theta) * std::cos(phi), 1 + 0.02 * std::cos(theta),
                                        0.02 * std::sin(theta) * std::sin(phi));
        }
    }
    for (glm::vec3& pole : std::span(ball.positions).first(segments))
        pole = {0, 1.02f, 0};
    for (glm::vec3& pole : std::span(ball.positions).last(segments))
        pole = {0, 0.98f, 0};
    for (std::uint32_t r = 0; r < rings; ++r) {
        for (std::uint32_t s = 0; s < segments; ++s) {
            const std::uint32_t a = r * segments + s, b = r * segments + (s + 1) % segments;
            for (const std::uint32_t v : {a, b, a + segments, b, b + segments, a + segments})
                ball.indices.push_back(v);
        }
    }
    for (const bool flipped : {false, true}) {
        if (flipped) {
            for (std::size_t n = 0; n < ball.indices.size(); n += 3)
                std::swap(ball.indices[n], ball.indices[n + 1]);
        }
        House house;
        house.add_room("", ball);
        house.add_probe({0, 0, 1});
        const Sector sector = house.bake({0, 0}).sector;
        ASSERT_EQ(sector.interiors.size(), 1u);
        // 4 cm in steps of 1 mm: what is thinner than a step is gone.
        EXPECT_LT(sector.interiors[0].triangles.size(), ball.indices.size() / 3 - 2 * segments);
        EXPECT_GT(sector.interiors[0].triangles.size(), 500u);
        for (const Finding& finding : validate_sector(encoded(sector)).findings)
            ADD_FAILURE() << finding.issue->code << " " << finding.message;
    }
}

TEST(Interior, LongOneTakesCoarserSteps) {
    House house;
    house.add_room("", box({-100, 0, -100}, {155.9f, 3, 100}));
    house.add_probe({1, 1, 1});
    const Sector sector = house.bake({0, 0}).sector;
    ASSERT_EQ(sector.interiors.size(), 1u);
    const Interior& interior = sector.interiors[0];
    EXPECT_EQ(interior.shift, 2);  // 255.9 m in 65535 steps of 4 / 1024 m
    double most = -1e9;
    for (std::size_t v = 0; v < interior.vertices.size(); ++v)
        most = std::max(most, vertex_m(interior, v)[0]);
    EXPECT_NEAR(most, 155.9, 2.5 / 1024) << "half a step, half a unit";
}

TEST(Interior, TooLargeOneIsASentence) {
    House house;
    house.add_room("", box({-40000, 0, -1}, {40000, 3, 1}));
    house.add_probe({0, 0, 1});
    auto map = house.b.import();
    ASSERT_TRUE(map) << map.error();
    const auto world =
        bake::World::open(trace::Device::open().value(), std::make_shared<const map::Map>(std::move(*map)));
    ASSERT_FALSE(world);
    EXPECT_EQ(world.error(),
              "the interior 'room' is 80000 m long or lies too far from the origin: the limit is 65 km");
}

TEST(Interior, OrderOfNodesChangesNoByte) {
    std::vector<std::vector<std::uint8_t>> files;
    for (const bool reversed : {false, true}) {
        House house;
        const auto first = [&] { house.add_room("a"); };
        const auto second = [&] { house.add_room("", box({20, 0, -30}, {24, 3, -20})); };
        if (reversed)
            second();
        first();
        if (!reversed)
            second();
        house.add_probe({6, 6, 1}, "a");
        house.add_probe({22, 25, 1}, "b");
        const Sector sector = house.bake({0, 0}).sector;
        ASSERT_EQ(sector.interiors.size(), 2u);
        files.push_back(encoded(sector));
    }
    EXPECT_EQ(files[0], files[1]);
}

}  // namespace
}  // namespace drtv::test
