// write_frame FOLDER: a frame of the yard for shaders, and the ambient light that the C++ finds at each
// pixel.
//
// texels0, 1, 2, tiles, numbers: as shader_cases has them, without an interior and the mode.
// pixels: 8 floats each: the asked place relative to the snapped camera, the normal, the distance (0: the
// sky), 0. expected: 4 floats each: colour, 0. frame.json: sizes.
#include "bakerd/picture/camera.h"
#include "bakerd/picture/surface_point.h"
#include "bakerd/picture/vectors.h"
#include "bakerd/trace/device.h"
#include "tests/picture/yard.h"
#include "tests/shaders/case_files.h"

#include <drtv/ambient.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace drtv::test {
namespace {

constexpr picture::Size size = {320, 240};
constexpr std::uint32_t tile_sectors = 8;
// So small that much of the picture lies outside.
constexpr VolumeSettings settings{.size = {16, 16, 12}, .encoding = TexelEncoding::rgba16f};

void run(const std::filesystem::path& folder) {
    const trace::FloatMode float_mode;
    std::filesystem::create_directories(folder);
    const SectorSet& set = baked_yard().set();
    const auto light = morning();
    const picture::Camera camera = picture::Camera::at({30, 2, 3.5f}, {60, 40, 1}, 75, size);
    OwnedRelit relit(set.limits());
    OwnedVolume volume(settings, set.limits());
    relit->set_light(Shown::now, light->light);
    std::vector<std::array<float, 2>> tiles(256 * tile_sectors * tile_sectors, {1, 0});
    for (const LoadedSector* sector : baked_yard().sectors()) {
        relit->relight(Shown::now, *sector, light->light, {});
        const SectorId id{sector->view.i, sector->view.j};
        write_tile_texels(set.tile(id), id, tile_sectors, tiles);
    }
    volume->update(set, *relit, picture::as_place(camera.eye()));

    const Double3 origin = volume->shader_inputs().snapped_camera;
    Numbers numbers, pixels, expected;
    numbers.add(*volume);
    numbers.add(tile_shader_inputs(tile_sectors, origin));
    numbers.add(relit->fallback());
    for (std::size_t n = 0; n < size.width * size.height; ++n) {
        const auto ray = camera.ray(glm::vec2(n % size.width, n / size.width) + 0.5f);
        const auto point = surface_on(yard_scenery().scene(), camera, ray);
        if (!point) {
            pixels.add_all(std::array<float, 8>{});
            expected.add_all(Float4{});
            continue;
        }
        AmbientPlace place;
        place.at = picture::as_place(point->at);
        place.normal = picture::as_float3(point->hit.normal);
        place.offset_m = surface_offset_m;
        place.interiors = false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double asked = place.at[axis] + static_cast<double>(surface_offset_m * place.normal[axis]);
            pixels.add(static_cast<float>(asked - origin[axis]));
        }
        pixels.add_all(place.normal);
        pixels.add(point->hit.distance_m);
        pixels.add(0);
        expected.add_all(ambient_in(*volume, set, light->light, {}, place).colour);
        expected.add(0);
    }
    for (std::size_t k = 0; k < 3; ++k)
        write_file<std::byte>(folder / ("texels" + std::to_string(k)), volume->texels(k));
    write_file<std::array<float, 2>>(folder / "tiles", tiles);
    write_file(folder / "numbers", numbers.all());
    write_file(folder / "pixels", pixels.all());
    write_file(folder / "expected", expected.all());
    const auto texels = volume->texture_size();
    std::ofstream json(folder / "frame.json");
    json << "{\"size\": [" << size.width << ", " << size.height << "], \"texels\": [" << texels[0] << ", "
         << texels[1] << ", " << texels[2] << "], \"tiles\": " << 16 * tile_sectors << "}\n";
}

}  // namespace
}  // namespace drtv::test

int main(int argc, char** argv) {
    if (argc != 2)
        return std::fputs("usage: write_frame FOLDER\n", stderr), 2;
    drtv::test::run(argv[1]);
}
