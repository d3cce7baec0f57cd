// The numbers that accessors are made of: one component of glTF, by its type. Here for inlining.
#pragma once

#include <tiny_gltf.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace drtv::map {

// Size of one, or 0 for an unknown type.
[[nodiscard]] inline std::size_t component_bytes(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

// In a file numbers stand at any address.
template <class Value>
[[nodiscard]] Value load_unaligned(const std::uint8_t* at) {
    Value value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

// A signed one in [-1, 1].
[[nodiscard]] inline float normalized_signed(float value, float max) {
    return std::max(value / max, -1.0f);
}

// Converted as KHR_mesh_quantization and the normalisation rule say. REQUIRES: `at` has its bytes.
[[nodiscard]] inline float load_float(const std::uint8_t* at, int component_type, bool normalized) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return load_unaligned<float>(at);
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            const auto value = static_cast<float>(load_unaligned<std::int8_t>(at));
            return normalized ? normalized_signed(value, 127.0f) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
            const auto value = static_cast<float>(*at);
            return normalized ? value / 255.0f : value;
        }
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            const auto value = static_cast<float>(load_unaligned<std::int16_t>(at));
            return normalized ? normalized_signed(value, 32767.0f) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
            const auto value = static_cast<float>(load_unaligned<std::uint16_t>(at));
            return normalized ? value / 65535.0f : value;
        }
        default:
            return static_cast<float>(load_unaligned<std::uint32_t>(at));
    }
}

// REQUIRES: the type is an unsigned integer, `at` has its bytes.
[[nodiscard]] inline std::uint32_t load_index(const std::uint8_t* at, int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return *at;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load_unaligned<std::uint16_t>(at);
        default:
            return load_unaligned<std::uint32_t>(at);
    }
}

}  // namespace drtv::map
