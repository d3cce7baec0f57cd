// The framing of a GLB file (glTF 2.0, section 4).
#pragma once

#include "bakerd/map/file_source.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace drtv::map {

// Parts of the file, which must outlive them.
struct GlbChunks {
    std::string_view json;
    std::optional<std::span<const std::uint8_t>> binary;
};

// The chunks of a GLB. Chunks of unknown types are passed over. The sentence says which chunk is wrong, and
// does not name the file. REQUIRES: the bytes begin with "glTF".
[[nodiscard]] tl::expected<GlbChunks, std::string> glb_chunks(const FileBytes& bytes);

}  // namespace drtv::map
