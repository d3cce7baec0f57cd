// Checks where a glTF document's bytes lie: buffers, buffer views, images, and the uris of them.
#pragma once

#include "bakerd/map/data_uri.h"
#include "bakerd/map/json_checker.h"

#include <cstddef>
#include <string>
#include <vector>

namespace drtv::map {

// Bytes that lie outside the JSON.
struct OutsideBytes {
    std::string element;  // "buffer 0", for messages
    // Of the map, the likeliest first; without one, the GLB's binary chunk.
    std::vector<std::string> files;
    SizeBytes size_bytes;  // a buffer's byteLength; an image has its whole file
};

// Checks all of them, each view against its buffer too. The uri of a buffer or image outside becomes its
// place in `outside`, to which it is added; a data uri becomes one that tinygltf reads. `document` is the
// path of the glTF file in the map.
[[nodiscard]] CheckResult check_buffers(const Checker& check,
                                        const std::string& document,
                                        std::vector<OutsideBytes>& outside);

}  // namespace drtv::map
