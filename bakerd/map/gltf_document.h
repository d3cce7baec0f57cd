// One glTF file, parsed and checked, with its buffers loaded. tinygltf's types stay in this room.
#pragma once

#include "bakerd/map/file_source.h"

#include <tiny_gltf.h>

#include <cstddef>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

struct GltfDocument {
    std::string path;  // as the map names it, for messages
    tinygltf::Model model;

    // "island.glb: <rest>"
    [[nodiscard]] std::string at(const std::string& rest) const { return path + ": " + rest; }
};

// What an index of the document names. REQUIRES: it lies in the vector; check_document saw to the document's
// own.
template <class Element>
[[nodiscard]] const Element& at_index(const std::vector<Element>& elements, int index) {
    return elements[static_cast<std::size_t>(index)];
}

// Loads `path` and its buffers. Images are kept as encoded bytes in `Image::image`; decoding is the
// material's.
[[nodiscard]] tl::expected<GltfDocument, std::string> load_document(const std::string& path,
                                                                    const FileSource& files);

}  // namespace drtv::map
