// What the shaders are to find, as the C++ has it: shader_cases FOLDER [POINTS] writes a folder for each
// case.
//
// texels0, 1, 2: the volume's textures as they are uploaded (of an atlas, all in texels0).
// tiles: texels of the tile texture, two floats each.
// numbers: what the harness makes DrtvVolume, DrtvTiles, two DrtvColours and the mode of, floats.
// points: 8 floats each: place relative to the snapped camera, normal, share of the interior, 0.
// expected: 16 floats each: colour, window weight; sky factor, the views in three sums; weights; b0 r, b1 g,
// b2 b, down r. case.json: textures (file, size, format), "atlas", "repeat".
#include "tests/format/sectors.h"
#include "tests/runtime/sets.h"
#include "tests/shaders/case_files.h"

#include <drtv/ambient.h>
#include <drtv/tile_texture.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace drtv::test {
namespace {

constexpr SectorSetLimits limits{.sectors = 36, .probes = 36 * 64, .interiors = 0, .tiles = 64};
constexpr std::uint32_t tile_sectors = 8;

// Colours that differ from probe to probe by some tenths; a hole in the grid.
Sector sector_at(SectorId id) {
    Sector sector = lattice_sector(id, 8, 3);
    std::mt19937 random(static_cast<std::uint32_t>(id.i * 131 + id.j * 17 + 77777));
    const auto code = [&](int least, int most) {
        return static_cast<std::int16_t>(least +
                                         static_cast<int>(random() % static_cast<unsigned>(most - least)));
    };
    for (Probe& probe : sector.probes) {
        const std::int16_t seen = code(12000, 32767);
        probe.sky_visibility = {seen, code(12000, 32767), seen, 0};
        for (auto& channel : probe.transfer) {
            for (auto& direction : channel)
                direction = {code(500, 4000), code(-400, 400), code(-400, 400), code(-400, 400)};
        }
    }
    sector.grid.z_origin_units = -8 * position_units_per_m;
    sector.grid.cell_height_units = 2048;
    for (std::size_t n = 0; n < grid_cell_count; ++n) {
        if (n % grid_size < 3 && n / grid_size % grid_size < 4)
            sector.grid.cells[n] = no_probe;
    }
    return sector;
}

struct Case {
    std::string name;
    VolumeSettings settings;
    RelightMode mode = RelightMode::accurate;
    std::int32_t away = 0;  // sectors from the origin
    float scale = 4;
    float brightness = 1;
    double shift_m = 0;  // of the engine's origin; it keeps floats
};

std::vector<Case> cases() {
    std::vector<Case> all;
    constexpr std::array<std::int32_t, 3> size = {24, 20, 12};
    for (const auto& [name, encoding] : {std::pair("rgba8", TexelEncoding::rgba8),
                                         {"rgba8-sqrt", TexelEncoding::rgba8_sqrt},
                                         {"rgba16f", TexelEncoding::rgba16f}}) {
        for (const RelightMode mode : {RelightMode::literal, RelightMode::accurate}) {
            const std::string of = std::string(name) + (mode == RelightMode::literal ? "-literal" : "");
            all.push_back({of, {.size = size, .encoding = encoding}, mode});
            all.push_back({of + "-repeating", {.size = size, .encoding = encoding, .borders = false}, mode});
            all.push_back({of + "-atlas", {.size = size, .encoding = encoding, .atlas = true}, mode});
        }
    }
    all.push_back(
        {"far-out", {.size = size, .encoding = TexelEncoding::rgba16f}, RelightMode::accurate, 1600});
    all.push_back({"shifted-origin",
                   {.size = size, .encoding = TexelEncoding::rgba16f},
                   RelightMode::accurate,
                   1600,
                   4,
                   1,
                   102'403.7});
    all.push_back({"odd-size", {.size = {21, 19, 7}, .texel_m = {3, 5, 2.5f}}, RelightMode::accurate, -3});
    all.push_back({"clipped", {.size = size}, RelightMode::accurate, 0, 0.5f});
    all.push_back(
        {"bright", {.size = size, .encoding = TexelEncoding::rgba16f}, RelightMode::accurate, 0, 4, 1e5f});
    return all;
}

BasisColours mixed(const BasisColours& a, const BasisColours& b, float share) {
    BasisColours result;
    for (std::size_t n = 0; n < basis_count; ++n) {
        for (std::size_t c = 0; c < channel_count; ++c)
            result[n][c] = (1 - share) * a[n][c] + share * b[n][c];
    }
    return result;
}

// What the views show, summed up as the harness does it. `centre`: what the volume holds in the middle of the
// place's texel.
Float3 views_of(const VolumeSettings& settings, float scale, RelightMode mode, const Float3& normal,
                float share, const Volume::Sample& sample, const Volume::Sample& centre, float sky_factor) {
    const Float3 probe = shade_ambient(mode, centre.colours, normal);
    constexpr std::array<Float4, 3> mixing = {
        {{1.3f, 2.1f, 2.9f, 1.7f}, {2.7f, 1.1f, 1.9f, 2.3f}, {1.6f, 2.8f, 1.2f, 2.5f}}};
    float owner = 0;
    for (const Float4& factors : mixing) {
        float sum = 0;
        for (std::size_t c = 0; c < channel_count; ++c)
            sum += (centre.colours[0][c] + centre.colours[1][c]) / scale * factors[c];
        sum += (centre.colours[3][0] + centre.colours[3][1]) / scale * factors[3];
        owner += std::abs((sum - std::floor(sum)) * 2 - 1);
    }
    Float4 weights = basis_weights(mode, normal);
    for (float& weight : weights)
        weight = std::max(weight, 0.0f);
    const auto shown = [&](std::size_t b) { return std::min(weights[b] + 0.4f * weights[3], 1.0f); };
    const float fresh = std::clamp(1 - 80 * share / 64, 0.0f, 1.0f);
    float most = 0;
    float least = 1e9f;
    Float3 largest{};
    for (const Float3& colour : centre.colours) {
        for (std::size_t c = 0; c < channel_count; ++c) {
            most = std::max(most, colour[c]);
            least = std::min(least, colour[c]);
            largest[c] = std::max(largest[c], colour[c]);
        }
    }
    const float end = settings.encoding == TexelEncoding::rgba16f ? 65504 : scale;
    const float grey = std::clamp((largest[0] + largest[1] + largest[2]) / (3 * scale), 0.0f, 1.0f);
    const float clipped = most >= 0.9995f * end ? 1 : least <= 0.00001f * scale ? 2 : 3 * grey;
    const float inside = sample.weight >= 1 ? 1.0f : 0.0f;
    const float far = 1 - sample.weight;
    return {0.125f * (probe[0] + owner) * inside,
            shown(0) + 2 * shown(1) + 4 * shown(2) + fresh + fresh * fresh,
            far + 2 * far * (1 - sky_factor) + clipped * inside};
}

void write_case(const std::filesystem::path& folder, const Case& of, int point_count) {
    std::filesystem::create_directories(folder);
    OwnedSet set(limits);
    OwnedRelit relit(limits);
    SceneLight light;
    light.mode = of.mode;
    light.sky = gradient_sky({{0.3f, 0.5f, 1}, {0.6f, 0.6f, 0.7f}, {0.4f, 0.2f, 0.1f}}, {1, 1, 1});
    light.sun = {{4, 3.5f, 3}, {0.6f, 0.3f, 1}};
    for (Float4& channel : light.sky) {
        for (float& coefficient : channel)
            coefficient *= of.brightness;
    }
    relit->set_light(Shown::now, light);
    std::vector<std::array<float, 2>> tiles(256 * tile_sectors * tile_sectors, {1, 0});
    for (std::int32_t j = -2; j < 3; ++j) {
        for (std::int32_t i = -2; i < 3; ++i) {
            const SectorId id{of.away + i, of.away + j};
            if (i == 1 && j == 0)
                continue;  // missing
            relit->relight(Shown::now, set.add(sector_at(id)), light, {});
            write_tile_texels(set->tile(id), id, tile_sectors, tiles);
        }
    }
    OwnedVolume volume(of.settings, limits);
    volume->set_scale(of.scale);
    const double origin = 64.0 * of.away;
    volume->update(*set, *relit, {origin - 300, origin + 200, 0});
    const Double3 camera = {origin + 11, origin - 7, 5};
    volume->update(*set, *relit, camera);

    const VolumeShaderInputs inputs = volume->shader_inputs();
    const BasisColours far = relit->fallback();
    const BasisColours indoors = {{{0.1f, 0.2f, 0.3f}, {0.5f, 0.1f, 0}, {0, 0.4f, 0.2f}, {0.9f, 0.7f, 0.5f}}};
    Numbers numbers;
    numbers.add(*volume);
    numbers.add(tile_shader_inputs(tile_sectors, inputs.snapped_camera));
    numbers.add(far);
    numbers.add(indoors);
    numbers.add(of.mode == RelightMode::literal ? 0 : 1);

    Numbers points, expected;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> one(0, 1);
    std::normal_distribution<float> normal_of(0, 1);
    for (int n = 0; n < point_count; ++n) {
        Float3 place{};
        Double3 world{};
        Double3 centre{};  // of the texel
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float reach = 0.55f / inputs.uv_scale[axis];  // some lie outside
            const double texel_m = static_cast<double>(of.settings.texel_m[axis]);
            double texels = 0;
            do {
                place[axis] = reach * (2 * one(random) - 1);
                world[axis] = inputs.snapped_camera[axis] + static_cast<double>(place[axis]);
                texels = world[axis] / texel_m;
            } while (std::abs(texels - std::round(texels)) < 0.001);  // where floats may choose another
            centre[axis] = (std::floor(texels) + 0.5) * texel_m;
            if (of.shift_m != 0 && axis < 2)
                place[axis] = static_cast<float>(world[axis] - of.shift_m) -
                              static_cast<float>(inputs.snapped_camera[axis] - of.shift_m);
        }
        const double x = static_cast<double>(normal_of(random));
        const double y = static_cast<double>(normal_of(random));
        const double z = static_cast<double>(normal_of(random));
        const double length = std::sqrt(x * x + y * y + z * z);
        const Float3 normal = {static_cast<float>(x / length), static_cast<float>(y / length),
                               static_cast<float>(z / length)};
        const float share = n % 2 == 0 ? 0 : one(random);
        points.add_all(place);
        points.add_all(normal);
        points.add(share);
        points.add(0);

        const Volume::Sample sample = volume->sample(world);
        const float sky_factor = set->sky_factor(world);
        BasisColours distant{};
        distant = mixed(distant, far, sky_factor);
        const BasisColours outdoors = mixed(distant, sample.colours, sample.weight);
        expected.add_all(shade_ambient(of.mode, mixed(outdoors, indoors, share), normal));
        expected.add(sample.weight);
        expected.add(sky_factor);
        expected.add_all(views_of(of.settings, inputs.scale, of.mode, normal, share, sample,
                                  volume->sample(centre), sky_factor));
        expected.add_all(basis_weights(of.mode, normal));
        const bool inside = sample.weight > 0;
        const BasisColours& held = sample.colours;
        expected.add_all(inside ? Float4{held[0][0], held[1][1], held[2][2], held[3][0]} : Float4{});
    }
    const std::size_t textures = of.settings.atlas ? 1 : 3;
    for (std::size_t k = 0; k < textures; ++k) {
        std::vector<std::byte> bytes;
        for (std::size_t third = k; third < (of.settings.atlas ? 3 : k + 1); ++third)
            bytes.insert(bytes.end(), volume->texels(third).begin(), volume->texels(third).end());
        write_file<std::byte>(folder / ("texels" + std::to_string(k)), bytes);
    }
    write_file<std::array<float, 2>>(folder / "tiles", tiles);
    write_file(folder / "numbers", numbers.all());
    write_file(folder / "points", points.all());
    write_file(folder / "expected", expected.all());
    const auto size = volume->texture_size();
    const char* format = of.settings.encoding == TexelEncoding::rgba16f ? "rgba16float" : "rgba8unorm";
    std::ofstream json(folder / "case.json");
    json << "{\"textures\": [";
    for (std::size_t k = 0; k < channel_count; ++k) {
        json << "{\"file\": \"texels" << (of.settings.atlas ? 0 : k) << "\", \"size\": [" << size[0] << ", "
             << size[1] << ", " << size[2] << "], \"format\": \"" << format << "\"}, ";
    }
    json << "{\"file\": \"tiles\", \"size\": [" << 16 * tile_sectors << ", " << 16 * tile_sectors
         << "], \"format\": \"rg32float\"}], \"atlas\": " << (of.settings.atlas ? "true" : "false")
         << ", \"repeat\": " << (of.settings.borders ? "false" : "true")
         << ", \"magnitude\": " << (of.brightness > 1 ? 65504 : 1) << "}\n";
}

}  // namespace
}  // namespace drtv::test

int main(int argc, char** argv) {
    if (argc != 2 && argc != 3)
        return std::fputs("usage: shader_cases FOLDER [POINTS]\n", stderr), 1;
    const int points = argc == 3 ? std::atoi(argv[2]) : 6000;
    for (const drtv::test::Case& of : drtv::test::cases())
        drtv::test::write_case(std::filesystem::path(argv[1]) / of.name, of, points);
}
