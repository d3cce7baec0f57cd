// Data embedded in a glTF document.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace drtv::map {

using SizeBytes = std::optional<std::size_t>;

// A data uri in the one form that tinygltf reads whatever its media type, cut to `size_bytes` of data where
// that is given. The sentence says what is wrong: not base64, no data, or too short.
[[nodiscard]] tl::expected<std::string, std::string> plain_data_uri(std::string_view uri,
                                                                    SizeBytes size_bytes);

}  // namespace drtv::map
