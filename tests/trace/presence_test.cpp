// Where alpha leaves a surface: point by point, triangle by triangle, and what rays make of it.
#include "bakerd/map/texture.h"
#include "bakerd/trace/surface.h"
#include "tests/trace/scenes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>

namespace drtv::test {
namespace {

using map::AlphaMode;
using trace::Presence;

constexpr std::uint32_t picture_size = 64;

// Left third clear, right third opaque, noise between.
map::Texture clear_to_opaque(std::mt19937& random, map::Coverage coverage, float cutoff) {
    map::Texture texture;
    texture.width = texture.height = picture_size;
    texture.coverage = coverage;
    texture.cutoff = cutoff;
    texture.rgba.assign(std::size_t{picture_size} * picture_size * 4, 200);
    for (std::size_t n = 0; n < std::size_t{picture_size} * picture_size; ++n) {
        const std::size_t x = n % picture_size;
        texture.rgba[n * 4 + 3] = x < 24 ? 0 : x >= 40 ? 255 : static_cast<std::uint8_t>(random());
    }
    map::prefilter(texture);
    return texture;
}

// A map of one primitive, which only what looks at surfaces reads.
struct Skin {
    map::Map map;
    map::Primitive primitive;

    Skin() {
        map.materials.emplace_back();
        primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        primitive.triangles = {{0, 1, 2}};
    }
    map::Material& material() { return map.materials[0]; }
    [[nodiscard]] bool there(std::uint32_t triangle, float u, float v) const {
        return trace::is_there({map, primitive, triangle, u, v});
    }
};

Skin random_skin(std::mt19937& random, AlphaMode mode) {
    Skin skin;
    map::Material& material = skin.material();
    material.alpha_mode = mode;
    material.alpha_cutoff = std::array{0.5f, 0.1f, 0.9f}[random() % 3];
    material.base_colour.w = std::array{1.0f, 1.0f, 0.6f, 0.0f}[random() % 4];
    const bool textured = random() % 4 != 0, coloured = random() % 3 == 0;
    if (textured) {
        skin.map.textures.push_back(
            clear_to_opaque(random, mode == AlphaMode::blend ? map::Coverage::alpha : map::Coverage::cutoff,
                            material.alpha_cutoff));
        skin.map.textures[0].wrap_u =
            std::array{map::Wrap::repeat, map::Wrap::clamp, map::Wrap::mirror}[random() % 3];
        material.base_texture.texture = 0;
        if (random() % 2 == 0)
            material.base_texture.u_from_uv = {0.5f, -0.25f, between(random, -2, 2)};
    }
    skin.primitive.triangles.clear();
    for (std::uint32_t t = 0; t < 60; ++t) {
        const glm::vec2 at(between(random, -2, 2), between(random, -2, 2));
        const float size = t % 2 == 0 ? 0.1f : 0.8f;
        for (int k = 0; k < 3; ++k) {
            if (textured)
                skin.primitive.uvs.push_back(at +
                                             glm::vec2(between(random, 0, size), between(random, 0, size)));
            if (coloured)
                skin.primitive.colours.emplace_back(1, 1, 1, t % 3 == 0 ? 1.0f : between(random, 0, 1));
        }
        skin.primitive.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    }
    return skin;
}

TEST(Presence, AgreesWithEveryPointOfTheTriangle) {
    std::mt19937 random(1);
    for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
        std::array<int, 3> count{};
        for (int n = 0; n < 60; ++n) {
            const Skin skin = random_skin(random, mode);
            for (std::uint32_t t = 0; t < skin.primitive.triangles.size(); ++t) {
                const Presence presence = trace::presence_of(skin.map, skin.primitive, t);
                ++count[static_cast<std::size_t>(presence)];
                if (presence == Presence::mixed)
                    continue;
                constexpr int steps = 16;
                for (int i = 0; i <= steps; ++i) {
                    for (int j = 0; i + j <= steps; ++j) {
                        const float u = static_cast<float>(i) / steps, v = static_cast<float>(j) / steps;
                        ASSERT_EQ(skin.there(t, u, v), presence == Presence::whole)
                            << "mode " << static_cast<int>(mode) << ", skin " << n << ", triangle " << t
                            << ", " << u << ", " << v;
                    }
                }
            }
        }
        for (const int each : count)
            EXPECT_GT(each, 100) << "mode " << static_cast<int>(mode);
    }
}

TEST(Presence, OfWhatHasNoAlphaIsWhole) {
    std::mt19937 random(2);
    Skin skin = random_skin(random, AlphaMode::mask);
    skin.material().alpha_mode = AlphaMode::opaque;
    skin.material().base_colour.w = 0;
    EXPECT_EQ(trace::presence_of(skin.map, skin.primitive, 0), Presence::whole);
    EXPECT_TRUE(skin.there(0, 0.25f, 0.25f));
}

TEST(Presence, IsCertainWhereTheFactorAloneDecides) {
    Skin skin;
    const auto presence = [&](AlphaMode mode, float alpha) {
        skin.material().alpha_mode = mode;
        skin.material().base_colour.w = alpha;
        return trace::presence_of(skin.map, skin.primitive, 0);
    };
    EXPECT_EQ(presence(AlphaMode::mask, 0.6f), Presence::whole);
    EXPECT_EQ(presence(AlphaMode::mask, 0.4f), Presence::nowhere);
    EXPECT_EQ(presence(AlphaMode::blend, 1), Presence::whole);
    EXPECT_EQ(presence(AlphaMode::blend, 0.6f), Presence::mixed);
    EXPECT_EQ(presence(AlphaMode::blend, 0), Presence::nowhere);
}

// A cutoff over a factor of zero is no division by it: such a material is allowed, and shows nothing.
TEST(Presence, OfAMaskedPictureUnderAFactorOfZeroIsNowhere) {
    GltfBuilder b;
    b.place(ground(1), "",
            b.add_material(
                {.colour = {1, 1, 1, 0}, .mask_cutoff = 0.5, .texture = b.add_texture(half_masked())}));
    const auto imported = b.import();
    ASSERT_TRUE(imported) << imported.error();
    const map::Primitive& primitive = imported->meshes.at(0).primitives.at(0);
    ASSERT_FALSE(imported->textures.at(0).alpha_blocks.empty()) << "presence_of would read past their end";
    EXPECT_EQ(trace::presence_of(*imported, primitive, 0), Presence::nowhere);
    EXPECT_FALSE(trace::is_there({*imported, primitive, 0, 0.25f, 0.25f}));
}

TEST(BlendedCoin, FallsTheSameWayAtTheSamePoint) {
    Skin skin;
    skin.material().alpha_mode = AlphaMode::blend;
    skin.material().base_colour.w = 0.5f;
    const Skin again = skin;
    std::mt19937 random(3);
    for (int n = 0; n < 5000; ++n) {
        const float u = between(random, 0, 1), v = between(random, 0, 1 - u);
        const bool there = skin.there(0, u, v);
        EXPECT_EQ(skin.there(0, u, v), there);
        EXPECT_EQ(again.there(0, u, v), there);
    }
}

TEST(BlendedCoin, ShowsTheSurfaceAsOftenAsItsAlphaSays) {
    constexpr int tosses = 100000;
    Skin skin;
    skin.primitive.triangles.assign(2, {0, 1, 2});
    skin.material().alpha_mode = AlphaMode::blend;
    std::mt19937 random(4);
    for (const float alpha : {0.05f, 0.3f, 0.5f, 0.9f}) {
        skin.material().base_colour.w = alpha;
        int there = 0, there_on_both = 0;
        for (int n = 0; n < tosses; ++n) {
            const float u = between(random, 0, 1), v = between(random, 0, 1 - u);
            const bool first = skin.there(0, u, v);
            there += first ? 1 : 0;
            there_on_both += first && skin.there(1, u, v) ? 1 : 0;
        }
        // Four standard deviations of a fair coin at the most.
        const double deviation = 4 * 0.5 / std::sqrt(double{tosses});
        EXPECT_NEAR(double{1} * there / tosses, alpha, deviation);
        EXPECT_NEAR(double{1} * there_on_both / tosses, alpha * alpha, deviation)
            << "triangles share their coins";
    }
}

TEST(BlendedCoin, IsTossedAnewAPointAside) {
    Skin skin;
    skin.material().alpha_mode = AlphaMode::blend;
    skin.material().base_colour.w = 0.5f;
    int changes = 0;
    float u = 0.25f;
    for (int n = 0; n < 1000; ++n) {
        const float next = std::nextafter(u, 1.0f);
        changes += skin.there(0, u, 0.125f) != skin.there(0, next, 0.125f) ? 1 : 0;
        u = next;
    }
    EXPECT_NEAR(changes, 500, 4 * 16);  // four standard deviations
}

// A soup whose triangles wear clear, opaque or both parts of a picture.
Thing partly_clear_soup(std::mt19937& random) {
    Thing soup = thing_of(triangle_soup(random, 240, 3));
    for (std::size_t n = 0; n < soup.shape.positions.size() / 3; ++n) {
        const float left = n % 3 == 0 ? 0.08f : n % 3 == 1 ? 0.72f : 0.2f, width = n % 3 == 2 ? 0.6f : 0.2f;
        for (int k = 0; k < 3; ++k)
            soup.shape.uvs.emplace_back(left + between(random, 0, width), between(random, 0, 1));
    }
    soup.material.texture = 0;
    return soup;
}

// The first of the unmasked hits along the ray that alpha leaves; not sure where one is met at alpha's very
// edge.
struct Expected {
    std::optional<trace::Hit> hit;
    float distance_m = 0;
    bool sure = true;
};

Expected first_there(const trace::Scene& opaque, const map::Map& masked, trace::Ray ray) {
    constexpr float step_m = 1e-3f, alpha_edge = 1e-3f;
    const map::Primitive& primitive = masked.meshes.at(0).primitives.at(0);
    Expected expected;
    float gone_m = 0;
    for (;;) {
        const auto hit = opaque.closest(ray);
        if (!hit)
            return expected;
        const float alpha = trace::alpha_at({masked, primitive, hit->triangle, hit->u, hit->v});
        if (std::abs(alpha - masked.materials[primitive.material].alpha_cutoff) < alpha_edge)
            expected.sure = false;
        if (trace::is_there({masked, primitive, hit->triangle, hit->u, hit->v})) {
            expected.hit = hit;
            expected.distance_m = gone_m + hit->distance_m;
            return expected;
        }
        const float by = hit->distance_m + step_m;
        ray.origin += ray.direction * by;
        ray.far_m -= by;
        gone_m += by;
    }
}

TEST(MaskedMesh, ItsTrianglesAreMetWhereTheyAreWhicheverSetTheyAreIn) {
    // Small ones are instanced, large ones cut and put into the world.
    for (const auto& [scale, mirrored] : {std::pair{1.0, false}, {1.0, true}, {9.0, false}, {9.0, true}}) {
        SCOPED_TRACE(testing::Message() << "scale " << scale << (mirrored ? ", mirrored" : ""));
        std::mt19937 random(5);
        Thing soup = partly_clear_soup(random);
        soup.world_from_shape = glm::scale(glm::rotate(glm::dmat4(1), 0.3, glm::dvec3(1, 2, 3)),
                                           glm::dvec3(scale, scale, mirrored ? -scale : scale));
        const auto opaque_map = map_of(std::vector<Thing>{soup});
        soup.material.mask_cutoff = 0.5;
        auto masked_map = std::make_shared<map::Map>(*map_of(std::vector<Thing>{soup}));
        map::Texture picture = clear_to_opaque(random, map::Coverage::cutoff, 0.5f);
        masked_map->textures.at(0) = picture;
        const map::Primitive& primitive = masked_map->meshes.at(0).primitives.at(0);
        std::array<int, 3> count{};
        for (std::uint32_t t = 0; t < primitive.triangles.size(); ++t)
            ++count[static_cast<std::size_t>(trace::presence_of(*masked_map, primitive, t))];
        for (const int each : count)
            ASSERT_GT(each, 50);

        const auto opaque = scene_of(opaque_map), masked = scene_of(masked_map);
        int hits = 0, passed = 0;
        const auto reach = static_cast<float>(40 * scale);
        for (int n = 0; n < 8000; ++n) {
            const glm::vec3 origin(between(random, -12, 12), between(random, -12, 12),
                                   between(random, -12, 12));
            const trace::Ray ray{origin * static_cast<float>(scale), random_direction(random), reach};
            const Expected expected = first_there(*opaque, *masked_map, ray);
            if (!expected.sure)
                continue;
            const auto hit = masked->closest(ray);
            ASSERT_EQ(hit.has_value(), expected.hit.has_value()) << "ray " << n;
            EXPECT_EQ(masked->occluded(ray), hit.has_value()) << "ray " << n;
            if (!hit)
                continue;
            ++hits;
            passed += opaque->closest(ray)->triangle != hit->triangle ? 1 : 0;
            EXPECT_EQ(hit->triangle, expected.hit->triangle) << "ray " << n;
            EXPECT_EQ(hit->front, expected.hit->front) << "ray " << n;
            EXPECT_NEAR(hit->distance_m, expected.distance_m, 2e-4f * scale);
            EXPECT_NEAR(hit->u, expected.hit->u, 1e-3f);
            EXPECT_NEAR(hit->v, expected.hit->v, 1e-3f);
        }
        EXPECT_GT(hits, 1000);
        EXPECT_GT(passed, 300);
    }
}

}  // namespace
}  // namespace drtv::test
