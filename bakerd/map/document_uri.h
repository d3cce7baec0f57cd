// The uris of a glTF document: data embedded in them, and paths that must stay in the map's folder.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace drtv::map {

using SizeBytes = std::optional<std::size_t>;

// Fails for a path that does not name a file in the map's folder or below: "the path '../x' leaves the map's
// folder".
[[nodiscard]] tl::expected<void, std::string> check_path(const std::string& path);

// The uri with its %xx decoded; nothing when one of them is not two hexadecimal digits.
[[nodiscard]] std::optional<std::string> decode_uri(const std::string& uri);

[[nodiscard]] bool is_data_uri(std::string_view uri);

// A data uri in the one form that tinygltf reads whatever its media type, cut to `size_bytes` of data where
// that is given. The sentence says what is wrong: not base64, no data, or too short.
[[nodiscard]] tl::expected<std::string, std::string> plain_data_uri(std::string_view uri,
                                                                    SizeBytes size_bytes);

}  // namespace drtv::map
