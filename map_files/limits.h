// How much a map may be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <tl/expected.hpp>

namespace drtv::map_files {

inline constexpr std::int64_t max_documents = 10'000;  // .gltf and .glb files
inline constexpr std::int64_t max_files = 20'000;      // with all that they refer to
// Of one file: its readers count in 32 bits.
inline constexpr std::int64_t max_file_bytes = INT32_MAX;

// Fails with a sentence above the limits.
[[nodiscard]] tl::expected<void, std::string> check_counts(std::int64_t documents, std::int64_t files);
[[nodiscard]] tl::expected<void, std::string> check_size(const std::string& path, std::int64_t size_bytes);

}  // namespace drtv::map_files
