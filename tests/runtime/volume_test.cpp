// Volumes: whatever moves, loads and fades came before, the textures are what one full update writes.
#include "tests/format/allocation_count.h"
#include "tests/format/sectors.h"
#include "tests/runtime/sets.h"

#include <drtv/volume.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <string>

namespace drtv {
namespace {

using test::lattice_sector;
using test::OwnedSet;

constexpr SectorSetLimits limits{.sectors = 64, .probes = 64 * 64, .interiors = 0, .tiles = 256};

class OwnedVolume : public test::OwnedVolume {
  public:
    explicit OwnedVolume(const VolumeSettings& settings, int poison = 0xA5)
        : test::OwnedVolume(settings, limits, poison) {}
};

class OwnedRelit : public test::OwnedRelit {
  public:
    explicit OwnedRelit(bool with_fade = false) : test::OwnedRelit(limits, with_fade) {}
};

SceneLight daylight(float strength = 1) {
    SceneLight light;
    light.sky = gradient_sky({{0.3f, 0.5f, strength}, {0.5f, 0.5f, 0.6f}, {0.4f, 0.3f, 0.1f}}, {1, 1, 1});
    light.sun = {{2, 2 * strength, 1.5f}, {1, 1, 1}};
    return light;
}

// Random probes and cells: every texel is another, but for the holes.
Sector random_sector_at(SectorId id) {
    Sector sector = test::random_sector(static_cast<std::uint32_t>(id.i * 131 + id.j * 17 + 5000), 40);
    sector.i = id.i;
    sector.j = id.j;
    sector.grid.z_origin_units = 1024 * ((id.i & 3) - 2);
    sector.grid.cell_height_units = static_cast<std::uint32_t>(1000 + 500 * (id.j & 3));
    for (std::size_t n = 0; n < grid_cell_count; n += 11)
        sector.grid.cells[n] = no_probe;
    return sector;
}

void expect_equal(OwnedVolume& found, OwnedVolume& expected, const std::string& where) {
    ASSERT_EQ(found->window(), expected->window()) << where;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto a = found->texels(k), b = expected->texels(k);
        ASSERT_EQ(a.size(), b.size());
        if (std::memcmp(a.data(), b.data(), a.size()) == 0)
            continue;
        const auto at = std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin();
        const auto texel = at / static_cast<std::ptrdiff_t>(found->texel_bytes());
        const auto size = found->texture_size();
        FAIL() << where << ": texture " << k << " differs at (" << texel % size[0] << ", "
               << texel / size[0] % size[1] << ", " << texel / size[0] / size[1] << ")";
    }
}

struct Shape {
    const char* name;
    VolumeSettings settings;
};

std::vector<Shape> shapes() {
    const std::array<std::int32_t, 3> small = {20, 24, 8};
    return {{"rgba8", {.size = small}},
            {"repeating", {.size = small, .borders = false}},
            {"sqrt", {.size = small, .encoding = TexelEncoding::rgba8_sqrt}},
            {"rgba16f", {.size = small, .encoding = TexelEncoding::rgba16f}},
            {"atlas", {.size = small, .atlas = true}},
            {"fine texels", {.size = {40, 25, 9}, .texel_m = {2.5f, 3, 1.25f}}},
            {"coarse texels", {.size = {12, 10, 4}, .texel_m = {16, 20, 8}}},
            {"blurred", {.size = {12, 14, 6}, .blur = true}},
            {"blurred, rgba16f", {.size = {12, 14, 6}, .encoding = TexelEncoding::rgba16f, .blur = true}}};
}

class Moves : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Volume, Moves, testing::ValuesIn(shapes()), [](const auto& shape) {
    std::string name = shape.param.name;
    std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
    return name;
});

// Moves along one axis, diagonal ones, jumps; sectors that come and go, are relit; changes of the scale.
void expect_equal_over(const VolumeSettings& settings, std::int32_t away, int steps) {
    OwnedSet set(limits);
    OwnedRelit relit;
    const SceneLight light = daylight();
    relit->set_light(Shown::now, light);
    std::map<std::pair<int, int>, std::vector<std::uint8_t>> files;
    for (int j = -3; j < 3; ++j) {
        for (int i = -3; i < 3; ++i)
            files[{i, j}] = write_sector(random_sector_at({i + away, j - away}));
    }
    OwnedVolume volume(settings), expected(settings);
    std::mt19937 engine(7);
    const auto one_of = [&](int n) { return static_cast<int>(engine() % static_cast<unsigned>(n)); };
    const double x0 = 64.0 * away, y0 = -64.0 * away;
    Double3 camera = {x0, y0, 3};
    for (int step = 0; step < steps; ++step) {
        const int kind = one_of(12);
        const std::pair<int, int> id = {one_of(6) - 3, one_of(6) - 3};
        if (kind == 0) {
            camera = {x0 + one_of(300) - 150, y0 + one_of(300) - 150, one_of(60) - 20.0};
        } else if (kind < 7) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                camera[axis] += (one_of(3) - 1) * (one_of(4) + 1) * 1.7;
        } else if (kind < 10) {
            const LoadedSector* loaded = nullptr;
            if (set->load(files[id], &loaded) == LoadStatus::loaded && one_of(5) != 0)
                relit->relight(Shown::now, *loaded, light, {});
        } else if (kind == 10) {
            set->drop({id.first + away, id.second - away});
            if (one_of(2) == 0)
                set->retire();
        } else {
            volume->set_scale(volume->scale() == 1 ? 4.0f : 1.0f);
            expected->set_scale(volume->scale());
            const SceneLight other = daylight(0.5f);
            if (const LoadedSector* loaded = set->find({id.first + away, id.second - away}))
                relit->relight(Shown::now, *loaded, other, {});
        }
        volume->update(*set, *relit, camera);
        expected->update_all(*set, *relit, camera);
        expect_equal(volume, expected, "step " + std::to_string(step));
        if (testing::Test::HasFatalFailure())
            return;
    }
}

TEST_P(Moves, GiveTheBytesOfAFullUpdate) {
    expect_equal_over(GetParam().settings, 0, GetParam().settings.blur ? 150 : 600);
}

TEST_P(Moves, GiveTheBytesOfAFullUpdateFarOut) {
    expect_equal_over(GetParam().settings, 1600, GetParam().settings.blur ? 30 : 100);
}

TEST_P(Moves, TheFirstUpdateWritesEveryTexel) {
    OwnedSet set(limits);
    OwnedRelit relit;
    relit->set_light(Shown::now, daylight());
    relit->relight(Shown::now, set.add(random_sector_at({0, 0})), daylight(), {});
    OwnedVolume volume(GetParam().settings, 0xA5), other(GetParam().settings, 0x5A);
    volume->update(*set, *relit, {21, 33, 5});
    other->update(*set, *relit, {21, 33, 5});
    expect_equal(volume, other, "poisoned alike");
}

// A GPU that uploads the boxes alone has the same texels.
TEST_P(Moves, DirtyBoxesAreAllThatChanged) {
    OwnedSet set(limits);
    OwnedRelit relit;
    relit->set_light(Shown::now, daylight());
    for (int j = -2; j < 2; ++j) {
        for (int i = -2; i < 2; ++i)
            relit->relight(Shown::now, set.add(random_sector_at({i, j})), daylight(), {});
    }
    OwnedVolume volume(GetParam().settings);
    volume->update(*set, *relit, {0, 0, 0});
    const auto size = volume->texture_size();
    const auto third = GetParam().settings.atlas ? size[2] / 3 : size[2];
    std::array<std::vector<std::byte>, 3> gpu;
    for (std::size_t k = 0; k < 3; ++k)
        gpu[k].assign(volume->texels(k).begin(), volume->texels(k).end());
    std::mt19937 engine(8);
    Double3 camera{};
    for (int step = 0; step < 200; ++step) {
        for (double& c : camera)
            c += static_cast<double>(engine() % 9) - 4;
        volume->update(*set, *relit, camera);
        for (const TextureBox& box : volume->dirty()) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                ASSERT_GE(box.offset[axis], 0);
                ASSERT_GT(box.size[axis], 0);
                ASSERT_LE(box.offset[axis] + box.size[axis], axis == 2 ? third : size[axis]);
            }
            for (std::int32_t z = box.offset[2]; z < box.offset[2] + box.size[2]; ++z) {
                for (std::int32_t y = box.offset[1]; y < box.offset[1] + box.size[1]; ++y) {
                    const auto at =
                        (static_cast<std::size_t>(z * size[1] + y) * static_cast<std::size_t>(size[0]) +
                         static_cast<std::size_t>(box.offset[0])) *
                        volume->texel_bytes();
                    const auto bytes = static_cast<std::size_t>(box.size[0]) * volume->texel_bytes();
                    for (std::size_t k = 0; k < 3; ++k)
                        std::memcpy(gpu[k].data() + at, volume->texels(k).data() + at, bytes);
                }
            }
        }
        for (std::size_t k = 0; k < 3; ++k)
            ASSERT_TRUE(std::ranges::equal(gpu[k], volume->texels(k)))
                << "step " << step << ", texture " << k;
    }
}

TEST(Volume, AMoveOfOneTexelIsAPlane) {
    OwnedSet set(limits);
    OwnedRelit relit;
    relit->set_light(Shown::now, daylight());
    OwnedVolume volume(VolumeSettings{});
    volume->update(*set, *relit, {0, 0, 0});
    ASSERT_EQ(volume->dirty().size(), 1u);
    volume->update(*set, *relit, {1.9, 0, 0});
    EXPECT_EQ(volume->dirty().size(), 0u);
    volume->update(*set, *relit, {2, 0, 0});
    ASSERT_EQ(volume->dirty().size(), 1u);
    EXPECT_EQ(volume->dirty()[0].size, (std::array<std::int32_t, 3>{1, 98, 18}));
}

// ---- What texels hold

TEST(Volume, TexelsHoldTheProbeThatTheirCentreNames) {
    OwnedSet set(limits);
    OwnedRelit relit;
    const SceneLight light = daylight();
    relit->set_light(Shown::now, light);
    for (int j = -1; j < 1; ++j) {
        for (int i = -1; i < 1; ++i)
            relit->relight(Shown::now, set.add(random_sector_at({i, j})), light, {});
    }
    OwnedVolume volume(VolumeSettings{.size = {24, 24, 8}, .encoding = TexelEncoding::rgba16f});
    volume->update(*set, *relit, {0, 0, 8});
    const auto window = volume->window();
    std::size_t probes = 0;
    for (std::int32_t z = 0; z < 8; ++z) {
        for (std::int32_t y = 0; y < 24; ++y) {
            for (std::int32_t x = 0; x < 24; ++x) {
                const Double3 centre = {4 * (window[0] + x + 0.5), 4 * (window[1] + y + 0.5),
                                        4 * (window[2] + z + 0.5)};
                const ProbeBlend named = set->nearest(centre);
                const Volume::Sample sample = volume->sample(centre);
                BasisColours expected = clamped(open_sky(light));
                if (named.count > 0) {
                    ++probes;
                    expected = unpacked(
                        packed(clamped(relight(named.probes[0].sector->view, named.probes[0].probe, light))));
                } else {
                    for (Float3& colour : expected) {
                        for (float& channel : colour)
                            channel *= set->sky_factor(centre);
                    }
                    expected = unpacked(packed(expected));
                }
                const bool at_side = x == 0 || y == 0 || z == 0 || x == 23 || y == 23 || z == 7;
                ASSERT_EQ(sample.weight, at_side ? 0 : 1);
                if (!at_side) {
                    ASSERT_EQ(sample.colours, expected) << x << " " << y << " " << z;
                }
            }
        }
    }
    EXPECT_GT(probes, 1000u);
}

// The talk's shader code (slide 40) with a sampler in C++ finds what `sample` says: at the origin, 100 km
// away, and with and without borders.
TEST(Volume, TheTalksAddressingFindsTheTexels) {
    for (const bool borders : {true, false}) {
        for (const std::int32_t away : {0, 1600, 3}) {
            OwnedSet set(limits);
            OwnedRelit relit;
            relit->set_light(Shown::now, daylight());
            for (int j = -1; j < 1; ++j) {
                for (int i = -1; i < 1; ++i)
                    relit->relight(Shown::now, set.add(random_sector_at({i + away, j + away})), daylight(),
                                   {});
            }
            std::array<std::int32_t, 3> texels = {20, 24, 8};
            if (away == 3)
                texels = {21, 19, 7};
            OwnedVolume volume(
                VolumeSettings{.size = texels, .encoding = TexelEncoding::rgba16f, .borders = borders});
            const Double3 camera = {64.0 * away + 5, 64.0 * away - 9, 8};
            volume->update(*set, *relit, camera);
            const VolumeShaderInputs inputs = volume->shader_inputs();
            const auto size = volume->texture_size();
            std::mt19937 engine(5);
            std::uniform_real_distribution<double> offset(-36, 36), height(-12, 12);
            for (int n = 0; n < 2000; ++n) {
                const Double3 at = {camera[0] + offset(engine), camera[1] + offset(engine),
                                    camera[2] + height(engine)};
                const Volume::Sample expected = volume->sample(at);
                if (expected.weight == 0)
                    continue;
                // As a GPU does: floats, texel centres at (n + 1/2) / size.
                std::array<std::int32_t, 3> low;
                std::array<float, 3> above;
                float weight = 1;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const auto ws = static_cast<float>(at[axis] - inputs.snapped_camera[axis]);
                    const float in_window = ws * inputs.uv_scale[axis] + 0.5f;
                    const float to_side =
                        std::min(in_window, 1 - in_window) * static_cast<float>(texels[axis]);
                    weight = std::min(weight, to_side - 0.5f);
                    float uv = in_window + inputs.wrap_offset[axis];
                    uv -= std::floor(uv);
                    uv = uv * inputs.uvw_multiply[axis] + inputs.uvw_add[axis];
                    const float texel = uv * static_cast<float>(size[axis]) - 0.5f;
                    low[axis] = static_cast<std::int32_t>(std::floor(texel));
                    above[axis] = texel - std::floor(texel);
                }
                ASSERT_NEAR(weight, expected.weight, 1e-4);
                float red = 0;
                for (int corner = 0; corner < 8; ++corner) {
                    float share = 1;
                    std::array<std::size_t, 3> texel;
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        const bool next = (corner >> axis & 1) != 0;
                        share *= next ? above[axis] : 1 - above[axis];
                        const std::int32_t t = low[axis] + (next ? 1 : 0);
                        const std::int32_t length = size[axis];
                        texel[axis] = static_cast<std::size_t>(borders ? std::clamp(t, 0, length - 1)
                                                                       : ((t % length) + length) % length);
                    }
                    const std::size_t index = (texel[2] * static_cast<std::size_t>(size[1]) + texel[1]) *
                                                  static_cast<std::size_t>(size[0]) +
                                              texel[0];
                    PackedColours one{};
                    std::memcpy(&one[0], volume->texels(0).data() + 8 * index, 8);
                    red += share * unpacked(one)[0][0];
                }
                ASSERT_NEAR(red, expected.colours[0][0], 3e-4) << away << " " << borders;
            }
        }
    }
}

TEST(Volume, HolesAndMissingSectorsShowTheFallbackTimesTheirTile) {
    OwnedSet set(limits);
    OwnedRelit relit;
    SceneLight light;
    light.sky = constant_sky({1, 1, 1});
    relit->set_light(Shown::now, light);
    OwnedVolume volume(VolumeSettings{.encoding = TexelEncoding::rgba16f});
    volume->update(*set, *relit, {0, 0, 8});
    EXPECT_NEAR(volume->sample({10, 10, 8}).colours[0][1], 0.788675f, 1e-3) << "an open sky";
    // A dark sector: loaded but not relit yet, then relit, then dropped.
    Sector sector = lattice_sector({0, 0}, 4, 6);
    for (Probe& probe : sector.probes)
        probe.sky_visibility = {8192, 8192, 8192, 0};
    const LoadedSector& loaded = set.add(sector);
    volume->update(*set, *relit, {0, 0, 8});
    EXPECT_NEAR(volume->sample({10, 10, 6}).colours[0][1], 0.25f * 0.788675f, 2e-3) << "its tile";
    relit->relight(Shown::now, loaded, light, {});
    volume->update(*set, *relit, {0, 0, 8});
    EXPECT_NEAR(volume->sample({10, 10, 6}).colours[0][1], 0.25f * 0.788675f, 1e-3);
    set->drop({0, 0});
    volume->update(*set, *relit, {0, 0, 8});
    EXPECT_NEAR(volume->sample({10, 10, 6}).colours[0][1], 0.25f * 0.788675f, 2e-3);
    EXPECT_NEAR(volume->sample({10, 10, 6 + 16 + 4}).colours[0][1], 0.788675f, 1e-3) << "high above";
    EXPECT_NEAR(volume->sample({10, -10, 6}).colours[0][1], 0.788675f, 1e-3);
}

TEST(Volume, ACameraThatIsNoneLeavesTheWindow) {
    OwnedSet set(limits);
    OwnedRelit relit;
    relit->set_light(Shown::now, daylight());
    OwnedVolume volume(VolumeSettings{.size = {8, 8, 4}});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    volume->update(*set, *relit, {nan, 0, 0});
    EXPECT_TRUE(volume->is_filled());
    volume->update(*set, *relit, {100, 0, 0});
    const auto window = volume->window();
    for (const Double3& camera : {Double3{0, 1e9, 0}, {INFINITY, 0, 0}, {0, 0, nan}, {0, 0, -1e300}}) {
        volume->update(*set, *relit, camera);
        EXPECT_EQ(volume->window(), window);
        EXPECT_EQ(volume->dirty().size(), 0u);
    }
}

TEST(Volume, AllocatesNothingAfterItIsMade) {
    OwnedSet set(limits);
    OwnedRelit relit(true);
    const LoadedSector& loaded = set.add(random_sector_at({0, 0}));
    OwnedVolume volume(VolumeSettings{.size = {16, 16, 8}, .blur = true});
    const std::size_t before = test::allocation_count();
    relit->set_light(Shown::now, daylight());
    relit->relight(Shown::now, loaded, daylight(), {});
    for (int n = 0; n < 5; ++n)
        volume->update(*set, *relit, {n * 7.0, 3, 1});
    EXPECT_EQ(test::allocation_count(), before);
}

TEST(Volume, SettingsOutsideTheirRangeAreRefused) {
    EXPECT_TRUE(Volume::is_possible({}));
    EXPECT_FALSE(Volume::is_possible({.size = {96, 1, 16}}));
    EXPECT_FALSE(Volume::is_possible({.size = {96, 96, 2000}}));
    EXPECT_FALSE(Volume::is_possible({.texel_m = {4, 0, 4}}));
    EXPECT_FALSE(Volume::is_possible({.texel_m = {4, NAN, 4}}));
    EXPECT_FALSE(Volume::is_possible({.borders = false, .atlas = true}));
}

// ---- Encodings

TEST(SuggestScale, StaysWhileTheLargestMovesByLessThanTwice) {
    for (float largest = 0.013f; largest < 5000; largest *= 1.37f) {
        const float scale = suggest_scale(largest, 0);
        EXPECT_EQ(scale, std::exp2(std::round(std::log2(scale)))) << "a power of two";
        EXPECT_LE(2 * largest, scale);
        EXPECT_GT(4.001f * largest, scale);
        EXPECT_EQ(suggest_scale(largest * 1.99f, scale),
                  std::max(scale, suggest_scale(largest * 1.99f, scale)));
        EXPECT_EQ(suggest_scale(largest / 1.99f, scale), scale);
    }
    EXPECT_EQ(suggest_scale(0, 0), 1);
    EXPECT_EQ(suggest_scale(0, 8), 8);
    EXPECT_EQ(suggest_scale(NAN, 8), 8);
    EXPECT_EQ(suggest_scale(INFINITY, 8), 0x1p60f);
}

// ---- Fades

TEST(Volume, AFadeIsOneShareOfBothLightsForAllTexels) {
    OwnedSet set(limits);
    OwnedRelit relit(true), now(false), next(false);
    const SceneLight dawn = daylight(0.2f), noon = daylight(3);
    std::vector<const LoadedSector*> sectors;
    for (int j = -1; j < 1; ++j) {
        for (int i = -1; i < 1; ++i)
            sectors.push_back(&set.add(random_sector_at({i, j})));
    }
    relit->set_light(Shown::now, dawn);
    now->set_light(Shown::now, dawn);
    next->set_light(Shown::now, noon);
    for (const LoadedSector* sector : sectors) {
        relit->relight(Shown::now, *sector, dawn, {});
        now->relight(Shown::now, *sector, dawn, {});
        next->relight(Shown::now, *sector, noon, {});
    }
    const VolumeSettings settings{.size = {24, 24, 8}, .encoding = TexelEncoding::rgba16f};
    OwnedVolume volume(settings), before(settings), after(settings);
    before->update(*set, *now, {0, 0, 8});
    after->update(*set, *next, {0, 0, 8});
    relit->set_light(Shown::next, noon);
    volume->update(*set, *relit, {0, 0, 8});
    for (std::size_t n = 0; n < sectors.size(); ++n) {
        // While the next light is worked out, some sectors a frame, nothing shows of it.
        relit->relight(Shown::next, *sectors[n], noon, {});
        volume->update(*set, *relit, {0, 0, 8});
        EXPECT_EQ(volume->dirty().size(), 0u);
        expect_equal(volume, before, "before the fade");
    }
    for (const float share : {0.25f, 0.5f, 1.0f}) {
        relit->set_fade(share);
        volume->update(*set, *relit, {0, 0, 8});
        std::mt19937 engine(3);
        for (int n = 0; n < 300; ++n) {
            const auto centre = [&](unsigned texels) { return 4.0 * static_cast<double>(engine() % texels); };
            const Double3 at = {centre(20) - 38, centre(20) - 38, centre(5) + 2};
            const BasisColours found = volume->sample(at).colours;
            const BasisColours a = before->sample(at).colours, b = after->sample(at).colours;
            for (std::size_t k = 0; k < 4; ++k) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const float expected = (1 - share) * a[k][c] + share * b[k][c];
                    ASSERT_NEAR(found[k][c], expected, 1e-3f * expected + 1e-6f);
                }
            }
        }
    }
    relit->finish_fade();
    volume->update(*set, *relit, {0, 0, 8});
    expect_equal(volume, after, "after the fade");
}

}  // namespace
}  // namespace drtv
