// Pictures: decoding PNG and JPEG, sampling albedo and alpha.
#pragma once

#include "bakerd/map/map.h"

#include <span>
#include <string>

#include <tl/expected.hpp>

namespace drtv::map {

// Decodes PNG or JPEG into an RGBA texture (wrapping left at repeat, digest empty). Sentence on failure.
[[nodiscard]] tl::expected<Texture, std::string> decode_texture(std::span<const std::uint8_t> encoded);

// Bilinear sample at uv: linear colour, alpha in w. Any uv is safe.
[[nodiscard]] glm::vec4 sample(const Texture& texture, glm::vec2 uv);

}  // namespace drtv::map
