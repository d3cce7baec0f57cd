// Decodes pictures. stb_image stays in this file's source, with its symbols private.
#pragma once

#include "bakerd/map/map.h"

#include <cstdint>
#include <span>
#include <string>

#include <tl/expected.hpp>

namespace drtv::map {

// Decodes PNG or JPEG into an RGBA texture (wrapping left at repeat, digest empty). Sentence on failure.
[[nodiscard]] tl::expected<Texture, std::string> decode_texture(std::span<const std::uint8_t> encoded);

}  // namespace drtv::map
