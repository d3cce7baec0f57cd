#include "bakerd/map/import.h"

#include "bakerd/map/content_digest.h"
#include "bakerd/map/extension_check.h"
#include "bakerd/map/gltf_document.h"
#include "bakerd/map/import_state.h"
#include "bakerd/map/material_import.h"
#include "bakerd/map/mesh_import.h"
#include "bakerd/map/node_import.h"
#include "bakerd/map/roles_file.h"
#include "bakerd/map/warning.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <future>

namespace drtv::map {
namespace {

// Where the volumes of each file end in Map::volumes.
struct FileEnd {
    std::string path;
    std::size_t volumes;
};

// Roles that refer to something must find it.
Imported check_interiors(const Map& map, const std::vector<FileEnd>& ends) {
    auto end = ends.begin();
    for (std::size_t n = 0; n < map.volumes.size(); ++n) {
        while (n >= end->volumes)
            ++end;
        const VolumeNode& volume = map.volumes[n];
        if (volume.probe_name.empty())
            continue;
        const auto named = std::ranges::count(map.probes, volume.probe_name, &ProbeNode::name);
        if (named != 1) {
            return tl::unexpected(fmt::format(
                "{}: interior '{}': bake_probe names '{}', and the map has {} probe nodes of that name",
                end->path,
                volume.name,
                volume.probe_name,
                named));
        }
    }
    return {};
}

void warn_of_extensions(const GltfDocument& document, Map& map) {
    for (const std::string& name : document.model.extensionsUsed) {
        if (is_passed_over(name))
            warn(map,
                 document.at(fmt::format(
                     "the extension {} is passed over: what it says of light, alpha or geometry is not baked",
                     name)));
    }
}

// Documents in the order of their paths; the next two are loaded meanwhile. Not more, because a document
// takes several times its file's memory.
class Documents {
  public:
    // REQUIRES: both outlive this.
    Documents(std::span<const std::string> paths, const FileSource& files) : left_(paths), files_(files) {
        load_ahead();
    }

    [[nodiscard]] tl::expected<GltfDocument, std::string> next() {
        auto document = ahead_.front().get();
        ahead_.pop_front();
        load_ahead();
        return document;
    }

  private:
    void load_ahead() {
        // Where no thread is to be had, when its turn has come.
        constexpr auto when = std::launch::async | std::launch::deferred;
        for (; ahead_.size() < 2 && !left_.empty(); left_ = left_.subspan(1))
            ahead_.push_back(std::async(when, load_document, left_.front(), std::cref(files_)));
    }

    std::span<const std::string> left_;
    const FileSource& files_;
    std::deque<std::future<tl::expected<GltfDocument, std::string>>> ahead_;
};

tl::expected<Map, std::string> import_files(std::span<const std::string> paths, const FileSource& files) {
    Map map;
    Shared shared;
    std::vector<FileEnd> ends;
    RolesFiles roles(files);
    Documents documents(paths, files);
    for (const std::string& path : paths) {
        auto document = documents.next();
        if (!document)
            return tl::unexpected(document.error());
        if (auto applied = roles.apply(*document); !applied)
            return tl::unexpected(applied.error());
        if (auto checked = check_mesh_sizes(*document); !checked)
            return tl::unexpected(checked.error());
        warn_of_extensions(*document, map);
        const ImportState state{*document, map, shared};
        const auto materials = import_materials(state);
        if (!materials)
            return tl::unexpected(materials.error());
        if (auto imported = import_nodes(state, *materials); !imported)
            return tl::unexpected(imported.error());
        ends.push_back({path, map.volumes.size()});
    }
    if (auto checked = check_interiors(map, ends); !checked)
        return tl::unexpected(checked.error());
    for (const std::string& sentence : roles.warnings())
        warn(map, sentence);
    finish_content(map);
    return map;
}

}  // namespace

tl::expected<Map, std::string> import_map(std::span<const std::string> paths, const FileSource& files) {
    return import_files(paths, files).map_error(as_sentence);
}

}  // namespace drtv::map
