// A map as it lies on a disk: the glTF documents that a command line names, and the folder that holds them.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map_files {

class LocalMap {
  public:
    // `arguments` are .gltf or .glb files, or folders of them. The map's folder is the lowest one that holds
    // all documents. A link to a document stands where the link stands. Fails with a sentence that names the
    // argument.
    [[nodiscard]] static tl::expected<LocalMap, std::string> find(std::span<const std::string> arguments);

    // Paths relative to the map's folder, '/' between names, sorted. Not empty.
    [[nodiscard]] const std::vector<std::string>& documents() const { return documents_; }

    // Documents that were named more than once; each is there once.
    [[nodiscard]] const std::vector<std::string>& repeated() const { return repeated_; }

    // Where the file of this path lies: in the map's folder, or else beside a document to which a link there
    // leads. Nothing where neither is a regular file.
    [[nodiscard]] std::optional<std::filesystem::path> on_disk(const std::string& path) const;

  private:
    // What stands below `at` in the map may lie below `folder` on the disk.
    struct Place {
        std::filesystem::path at;
        std::filesystem::path folder;
    };

    std::vector<std::string> documents_;
    std::vector<std::string> repeated_;
    std::vector<Place> places_;
};

}  // namespace drtv::map_files
