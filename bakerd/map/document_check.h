// Checks a glTF document's JSON before tinygltf sees it: what tinygltf skips over silently, or trusts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

struct DocumentSummary {
    std::vector<std::string> external_files;  // decoded, relative to the document's folder
};

// `json` is the text of a .gltf or of a .glb's first chunk. Sentences do not name the file; the caller does.
[[nodiscard]] tl::expected<DocumentSummary, std::string> check_document(std::string_view json);

}  // namespace drtv::map
