#include "bakerd/picture/scenery.h"

#include "bakerd/map/import.h"
#include "format/folder/manifest.h"
#include "map_files/local_map.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <vector>

namespace drtv::picture {
namespace {

std::size_t triangles_of(const map::Mesh& mesh) {
    std::size_t count = 0;
    for (const map::Primitive& primitive : mesh.primitives)
        count += primitive.triangles.size();
    return count;
}

bool is_near(const map::Bounds& bounds, glm::vec2 place) {
    return glm::all(glm::lessThan(glm::vec2(bounds.low), place + sight_m)) &&
           glm::all(glm::greaterThan(glm::vec2(bounds.high), place - sight_m));
}

std::size_t triangles_near(const map::Map& map, glm::vec2 place) {
    std::vector<bool> counted(map.meshes.size());
    std::size_t count = 0;
    for (const map::Object& object : map.objects) {
        const bool is_instance = !trace::is_kept_in_world_space(object.bounds);
        if ((is_instance && counted[object.mesh]) || !is_near(object.bounds, place))
            continue;
        counted[object.mesh] = is_instance;
        count += triangles_of(map.meshes[object.mesh]);
    }
    return count;
}

}  // namespace

cli::Result<std::shared_ptr<const map::Map>> read_map(std::span<const std::string> arguments) {
    const auto local = map_files::LocalMap::find(arguments);
    if (!local)
        return cli::fail(cli::exit_unreadable, local.error());
    auto map = map::import_map(local->documents(), map::local_source(*local));
    if (!map)
        return cli::fail(cli::exit_invalid, map.error());
    return std::make_shared<const map::Map>(std::move(*map));
}

cli::Result<void> check_manifest(const std::string& folder, const map::Map& map) {
    const auto manifest = folder::read_manifest(folder);
    if (!manifest)
        return tl::unexpected(manifest.error());
    if (!*manifest)
        return {};
    folder::warn_of_pull(folder, **manifest);
    const std::string content = to_hex(map.content);
    if ((*manifest)->map == content)
        return {};
    return cli::fail(
        cli::exit_invalid,
        fmt::format("the sectors of {} were baked of another map, or before an edit of this one: submit "
                    "the map again ({} names {}..., the map is {}...)",
                    folder,
                    folder::manifest_path(folder),
                    (*manifest)->map.substr(0, 8),
                    content.substr(0, 8)));
}

map::Bounds bounds_of(const map::Map& map) {
    map::Bounds bounds;
    for (const map::Object& object : map.objects) {
        bounds.extend(object.bounds.low);
        bounds.extend(object.bounds.high);
    }
    return bounds;
}

cli::Result<std::unique_ptr<const Scenery>> Scenery::build(std::shared_ptr<const map::Map> map,
                                                           glm::vec2 around) {
    const std::size_t triangles = triangles_near(*map, around);
    if (triangles > max_triangles)
        return cli::fail(
            cli::exit_invalid,
            fmt::format("the map has {} million triangles in sight, over the limit of {} million; "
                        "name fewer of its files",
                        triangles / 1'000'000,
                        max_triangles / 1'000'000));
    auto device = trace::Device::open();
    if (!device)
        return cli::fail(cli::exit_unreadable, device.error());
    trace::MapGeometry geometry(*device, map);
    std::unique_ptr<Scenery> scenery(new Scenery(map));
    scenery->scene_ = trace::Scene::build(geometry, {around, around}, sight_m);
    return scenery;
}

}  // namespace drtv::picture
