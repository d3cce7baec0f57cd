// What a surface does with light: sides, leaves, transmission, energy, emission.
#include "bakerd/trace/surface.h"

#include "bakerd/map/texture.h"
#include "tests/map/import_checks.h"
#include "tests/trace/scenes.h"

namespace drtv::test {
namespace {

using map::AlphaMode;
using map::Role;
using trace::Surface;

// A product or two in float.
constexpr float rounding = 1e-6f;

struct Skin {
    map::Map map;
    map::Primitive primitive;

    explicit Skin(const glm::vec3& colour = glm::vec3(0.5f)) {
        map.materials.emplace_back().base_colour = glm::vec4(colour, 1);
        primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        primitive.triangles = {{0, 1, 2}};
    }
    map::Material& material() { return map.materials[0]; }
    [[nodiscard]] Surface at(bool front, Role role = Role::fixed, float u = 0.25f, float v = 0.25f) const {
        return trace::surface_at({map, primitive, 0, u, v}, role, front, {1, 0});
    }
};

TEST(Surface, SumOfBackAndThroughIsAtMostTheLargestAlbedo) {
    std::mt19937 random(1);
    const auto colour = [&] {
        return glm::vec3(between(random, 0, 1), between(random, 0, 1), between(random, 0, 1));
    };
    int limited = 0;
    for (int n = 0; n < 4000; ++n) {
        Skin skin(n % 5 == 0 ? glm::vec3(1) : colour());
        map::Material& material = skin.material();
        material.double_sided = random() % 2 == 0;
        material.alpha_mode = static_cast<AlphaMode>(random() % 3);
        if (n % 2 == 0)
            material.diffuse_transmission = n % 4 == 0 ? 1 : between(random, 0, 1);
        material.diffuse_transmission_colour = n % 3 == 0 ? glm::vec3(1) : colour();
        if (n % 7 == 0)
            skin.primitive.colours.assign(3, glm::vec4(colour(), 1));
        const Surface surface =
            skin.at(random() % 2 == 0, random() % 2 == 0 ? Role::fixed : Role::vegetation);
        for (glm::length_t k = 0; k < 3; ++k) {
            const float total = surface.albedo[k] + surface.transmitted[k];
            EXPECT_GE(surface.albedo[k], 0);
            EXPECT_GE(surface.transmitted[k], 0);
            EXPECT_LE(total, map::max_albedo + rounding);
            limited += total > map::max_albedo - rounding ? 1 : 0;
        }
        if (surface.absorbs) {
            EXPECT_EQ(surface.albedo + surface.transmitted + surface.emission, glm::vec3(0));
        }
    }
    EXPECT_GT(limited, 500);
}

TEST(Surface, LimitKeepsTheShares) {
    Skin skin(glm::vec3(1, 0.5f, 0));
    skin.material().diffuse_transmission = 0.25f;
    skin.material().diffuse_transmission_colour = {1, 1, 1};
    const Surface surface = skin.at(true);
    // 0.95 * 0.75 beside 0.25 is over the limit; 0.5 * 0.75 beside 0.25 is not.
    const float total = 0.95f * 0.75f + 0.25f;
    expect_near(surface.albedo, {0.95f * 0.75f / total * 0.95f, 0.375f, 0}, rounding);
    expect_near(surface.transmitted, {0.25f / total * 0.95f, 0.25f, 0.25f}, rounding);
}

TEST(Surface, TransmissionTakesFromWhatComesBack) {
    Skin skin(glm::vec3(0.5f));
    skin.material().diffuse_transmission = 0.5f;
    skin.material().diffuse_transmission_colour = {0.5f, 1, 0};
    for (const Role role : {Role::fixed, Role::vegetation}) {
        for (const bool front : {true, false}) {
            const Surface surface = skin.at(front, role);
            EXPECT_FALSE(surface.absorbs) << "what lets light through has no blind side";
            expect_near(surface.albedo, glm::vec3(0.25f), rounding);
            expect_near(surface.transmitted, {0.25f, 0.5f, 0}, rounding);
        }
    }
}

TEST(Leaves, LetThroughHalfOfWhatTheySendBackWhereThin) {
    struct Case {
        Role role;
        bool double_sided;
        AlphaMode mode;
        bool lets_through;
    };
    for (const Case& c : {Case{Role::vegetation, true, AlphaMode::opaque, true},
                          {Role::vegetation, false, AlphaMode::mask, true},
                          {Role::vegetation, false, AlphaMode::blend, true},
                          {Role::vegetation, false, AlphaMode::opaque, false},
                          {Role::fixed, true, AlphaMode::opaque, false},
                          {Role::fixed, true, AlphaMode::mask, false},
                          {Role::fixed, true, AlphaMode::blend, false}}) {
        SCOPED_TRACE(testing::Message()
                     << (c.role == Role::fixed ? "static" : "vegetation")
                     << (c.double_sided ? ", double-sided" : "") << ", mode " << static_cast<int>(c.mode));
        Skin skin({0.5f, 0.25f, 0});
        skin.material().double_sided = c.double_sided;
        skin.material().alpha_mode = c.mode;
        for (const bool front : {true, false}) {
            const Surface surface = skin.at(front, c.role);
            EXPECT_FALSE(surface.absorbs);
            expect_near(surface.albedo, {0.5f, 0.25f, 0}, rounding);
            expect_near(surface.transmitted, c.lets_through ? glm::vec3(0.25f, 0.125f, 0) : glm::vec3(0),
                        rounding);
        }
    }
}

TEST(Leaves, BrightOnesStayWithinTheLimit) {
    Skin skin(glm::vec3(0.9f));
    skin.material().double_sided = true;
    const Surface surface = skin.at(true, Role::vegetation);
    expect_near(surface.albedo, glm::vec3(0.95f / 1.5f), rounding);
    expect_near(surface.transmitted, glm::vec3(0.95f / 3), rounding);
}

// Whatever a surface is made of, what a path takes on from it is within the map's bound.
TEST(MaxScattered, NoSurfaceScattersMore) {
    std::mt19937 random(2);
    const auto colour = [&](float most) {
        return glm::vec3(between(random, 0, most), between(random, 0, most), between(random, 0, most));
    };
    int close = 0;
    for (int n = 0; n < 1500; ++n) {
        Skin skin(colour(1));
        map::Material& material = skin.material();
        material.double_sided = random() % 2 == 0;
        material.alpha_mode = static_cast<AlphaMode>(random() % 3);
        if (n % 3 == 0)
            material.diffuse_transmission = n % 6 == 0 ? 1 : between(random, 0, 1);
        material.diffuse_transmission_colour = colour(1);
        if (n % 4 == 0)
            skin.primitive.colours = {glm::vec4(colour(1.5f), 1), glm::vec4(colour(1), 1),
                                      glm::vec4(colour(0.5f), 1)};
        if (n % 5 < 3) {
            map::Texture picture;
            picture.width = picture.height = 5;
            picture.coverage = static_cast<map::Coverage>(n % 5);
            picture.cutoff = 0.5f;
            const auto brightest = static_cast<unsigned>(50 + random() % 200);
            for (unsigned k = 0; k < 25 * 4; ++k)
                picture.rgba.push_back(
                    static_cast<std::uint8_t>(k % 4 == 3 ? random() % 2 * 3 : random() % brightest));
            map::prefilter(picture);
            skin.map.textures.push_back(picture);
            material.base_texture.texture = 0;
            // Repeated: wide footprints see mip levels.
            skin.primitive.uvs = {{0, 0}, {90, 0}, {0, 90}};
        }
        map::Object object;
        object.role = n % 2 == 0 ? Role::fixed : Role::vegetation;
        skin.map.objects.push_back(object);
        skin.map.meshes.emplace_back().primitives.push_back(skin.primitive);
        const float most = trace::max_scattered(skin.map);
        EXPECT_LT(most, 1);
        float seen = 0;
        for (int k = 0; k < 40; ++k) {
            const float u = k < 3 ? static_cast<float>(k == 1) : between(random, 0, 0.5f),
                        v = k < 3 ? static_cast<float>(k == 2) : between(random, 0, 0.5f);
            const Surface surface = trace::surface_at({skin.map, skin.primitive, 0, u, v}, object.role, true,
                                                      {100, k % 2 == 0 ? 0 : between(random, 0, 30)});
            seen = std::max(
                seen, std::max({surface.albedo.x, surface.albedo.y, surface.albedo.z}) +
                          std::max({surface.transmitted.x, surface.transmitted.y, surface.transmitted.z}));
        }
        EXPECT_LE(seen, most + rounding) << n;
        close += seen > most * 0.99f ? 1 : 0;
    }
    EXPECT_GT(close, 300);
}

TEST(MaxScattered, IsOfTheBrightestThatIsThere) {
    Skin skin(glm::vec3(0.5f));
    EXPECT_EQ(trace::max_scattered(skin.map), trace::min_scattered);
    skin.map.meshes.emplace_back().primitives.push_back(skin.primitive);
    EXPECT_EQ(trace::max_scattered(skin.map), trace::min_scattered);  // no object wears it
    skin.map.objects.emplace_back();
    EXPECT_EQ(trace::max_scattered(skin.map), 0.5f);
    skin.material().double_sided = true;
    skin.map.objects.emplace_back().role = Role::vegetation;
    EXPECT_EQ(trace::max_scattered(skin.map), 0.75f);
}

TEST(SurfaceEmission, OfTheBackIsNoneUnlessDoubleSided) {
    const glm::vec3 red(5, 0, 0), none(0);
    Skin skin;
    skin.material().emission = red;
    EXPECT_EQ(skin.at(true).emission, red);
    EXPECT_EQ(skin.at(false).emission, none);
    EXPECT_TRUE(skin.at(false).absorbs);
    EXPECT_EQ(skin.at(true, Role::vegetation).emission, red);
    EXPECT_EQ(skin.at(false, Role::vegetation).emission, none);
    EXPECT_FALSE(skin.at(false, Role::vegetation).absorbs);
    skin.material().diffuse_transmission = 0.5f;
    EXPECT_EQ(skin.at(false).emission, none);
    EXPECT_FALSE(skin.at(false).absorbs);
    skin.material().double_sided = true;
    EXPECT_EQ(skin.at(true).emission, red);
    EXPECT_EQ(skin.at(false).emission, red);
}

TEST(SurfaceEmission, IsFactorTimesPictureAtItsOwnCoordinates) {
    Skin skin;
    map::Texture picture;
    picture.width = 2, picture.height = 1;
    picture.wrap_u = map::Wrap::clamp;
    picture.rgba = {255, 255, 255, 255, 0, 0, 0, 0};
    map::prefilter(picture);
    skin.map.textures.push_back(picture);
    skin.material().emission = {3, 2, 1};
    skin.material().emission_texture.texture = 0;
    skin.primitive.emission_uvs = {{0.25f, 0.5f}, {0.75f, 0.5f}, {0.25f, 0.5f}};
    expect_near(skin.at(true, Role::fixed, 0, 0).emission, {3, 2, 1}, rounding);
    expect_near(skin.at(true, Role::fixed, 1, 0).emission, {0, 0, 0}, rounding);
    expect_near(skin.at(true, Role::fixed, 0.5f, 0.25f).emission, {1.5f, 1, 0.5f}, rounding);
    expect_near(trace::emission_at({skin.map, skin.primitive, 0, 0.5f, 0.25f}, {1, 0}), {1.5f, 1, 0.5f},
                rounding);
    skin.material().emission_texture.u_from_uv = {1, 0, -1};
    expect_near(skin.at(true, Role::fixed, 1, 0).emission, {3, 2, 1}, rounding);
}

TEST(SurfaceFootprint, AveragesThePictureButNeverMoreThanAPartOfTheTriangle) {
    // 256 x 256 in stripes two texels wide, over a triangle that wears all of it.
    constexpr std::uint32_t size = 256;
    map::Texture picture;
    picture.width = picture.height = size;
    for (std::uint32_t n = 0; n < size * size; ++n)
        picture.rgba.insert(picture.rgba.end(), 4, n % size / 2 % 2 == 0 ? 0 : 255);
    map::prefilter(picture);
    Skin skin(glm::vec3(0.5f));
    skin.map.textures.push_back(picture);
    skin.material().base_texture.texture = 0;
    skin.primitive.uvs = {{0, 0}, {1, 0}, {0, 1}};
    const auto albedo = [&](float footprint_m, float v) {
        // Right between two texels of one stripe, a white one.
        return trace::surface_at({skin.map, skin.primitive, 0, 67 / 256.0f, v}, Role::fixed, true,
                                 {100, footprint_m})
            .albedo.x;
    };
    EXPECT_NEAR(albedo(0, 0.3f), 0.5f, rounding);
    // A texel is 10 m / 256 wide: at ten times that the stripes are gone.
    EXPECT_NEAR(albedo(10 * 10 / 256.0f, 0.3f), 0.25f, 1e-4f);
    // However wide the footprint, black below and white above stay apart on the same picture.
    map::Texture halves = picture;
    for (std::uint32_t n = 0; n < size * size; ++n)
        std::fill_n(&halves.rgba[n * std::size_t{4}], 3, n / size < size / 2 ? 0 : 255);
    map::prefilter(halves);
    skin.map.textures[0] = halves;
    EXPECT_NEAR(albedo(1e6f, 0.25f), 0, 1e-4f);
    EXPECT_NEAR(albedo(1e6f, 0.65f), 0.5f, 1e-4f);
}

}  // namespace
}  // namespace drtv::test
