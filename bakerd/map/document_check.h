// Checks a glTF document's JSON before tinygltf sees it: what tinygltf skips over silently, or trusts.
#pragma once

#include "bakerd/map/buffer_check.h"

#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

struct CheckedDocument {
    // The document for tinygltf. Numbers stand as it wants them (an index written as 3.0 is 3), what no bake
    // needs is left out (animations, cameras), and the uri of a buffer or image outside is its place
    // in `outside`.
    std::string json;
    std::vector<OutsideBytes> outside;
};

// `json` is the text of a .gltf or of a .glb's first chunk, `path` the file's in the map. Sentences do not
// name the file; the caller does.
[[nodiscard]] tl::expected<CheckedDocument, std::string> check_document(std::string_view json,
                                                                        const std::string& path);

}  // namespace drtv::map
