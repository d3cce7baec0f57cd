#include "bakerd/map/import.h"

#include "bakerd/map/gltf_document.h"
#include "bakerd/map/import_parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace drtv::map {
namespace {

// Roles that refer to something must find it.
Imported check_interiors(const Map& map) {
    for (const Volume& volume : map.volumes) {
        if (volume.probe_name.empty()) continue;
        const auto named = std::count_if(map.probes.begin(), map.probes.end(), [&](const ManualProbe& probe) { return probe.name == volume.probe_name; });
        if (named != 1) {
            return tl::unexpected(fmt::format("interior '{}': bake_probe names '{}', and the map has {} probe nodes of that name", volume.name, volume.probe_name, named));
        }
    }
    return {};
}

}  // namespace

tl::expected<Map, std::string> import_map(std::span<const std::string> paths, const FileSource& files) {
    Map map;
    Shared shared;
    for (const std::string& path : paths) {
        const auto document = load_document(path, files);
        if (!document) return tl::unexpected(document.error());
        const auto materials = import_materials(*document, map, shared);
        if (!materials) return tl::unexpected(materials.error());
        if (auto imported = import_nodes(*document, *materials, map, shared); !imported) return tl::unexpected(imported.error());
    }
    if (auto checked = check_interiors(map); !checked) return tl::unexpected(checked.error());
    finish_content(map);
    return map;
}

}  // namespace drtv::map
