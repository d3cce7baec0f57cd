#include "map_files/limits.h"

#include <fmt/format.h>

namespace drtv::map_files {

tl::expected<void, std::string> check_counts(std::int64_t documents, std::int64_t files) {
    if (documents > max_documents)
        return tl::unexpected(
            fmt::format("the map has {} .gltf and .glb files, over the limit of {}: join "
                        "neighbours into one file, or bake it in parts",
                        documents,
                        max_documents));
    if (files > max_files)
        return tl::unexpected(fmt::format(
            "the map has {} files, over the limit of {}: pack each .gltf and its files into one .glb",
            files,
            max_files));
    return {};
}

tl::expected<void, std::string> check_size(const std::string& path, std::int64_t size_bytes) {
    if (size_bytes <= max_file_bytes)
        return {};
    return tl::unexpected(
        fmt::format("{} has {} bytes, over the limit of {} for one file: export it in parts",
                    path,
                    size_bytes,
                    max_file_bytes));
}

}  // namespace drtv::map_files
