#include "bakerd/map/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace drtv::map {
namespace {

constexpr std::size_t max_elements = std::size_t{1} << 27;
// An accessor without bufferView is all zeros, at no cost in the file: it needs a limit of its own.
constexpr std::size_t max_zeros = std::size_t{1} << 20;

std::size_t bytes_of(int component_type) {
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

template <class Value>
Value load(const std::uint8_t* at) {
    Value value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

float load_float(const std::uint8_t* at, int component_type, bool normalized) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return load<float>(at);
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            const auto v = static_cast<float>(load<std::int8_t>(at));
            return normalized ? std::max(v / 127.0f, -1.0f) : v;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return static_cast<float>(*at) / (normalized ? 255.0f : 1.0f);
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            const auto v = static_cast<float>(load<std::int16_t>(at));
            return normalized ? std::max(v / 32767.0f, -1.0f) : v;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return static_cast<float>(load<std::uint16_t>(at)) / (normalized ? 65535.0f : 1.0f);
        default:
            return static_cast<float>(load<std::uint32_t>(at));
    }
}

std::uint32_t load_index(const std::uint8_t* at, int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return *at;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(at);
        default:
            return load<std::uint32_t>(at);
    }
}

// A checked run of equally spaced elements in a buffer.
struct Run {
    const std::uint8_t* first = nullptr;
    std::size_t stride = 0;
};

tl::expected<Run, std::string> locate(const GltfDocument& document,
                                      const std::string& where,
                                      int view_index,
                                      std::size_t offset,
                                      std::size_t count,
                                      std::size_t element_bytes) {
    const tinygltf::Model& model = document.model;
    const auto fail = [&](const std::string& rest) {
        return tl::unexpected(document.at(where + ": " + rest));
    };
    if (view_index < 0 || static_cast<std::size_t>(view_index) >= model.bufferViews.size())
        return fail(fmt::format("bufferView {} does not exist", view_index));
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(view_index)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
        return fail(fmt::format("buffer {} does not exist", view.buffer));
    const std::vector<unsigned char>& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
        return fail(fmt::format("bufferView {} ends at {}, its buffer has {} bytes",
                                view_index,
                                view.byteOffset + view.byteLength,
                                data.size()));
    }
    const std::size_t stride = view.byteStride != 0 ? view.byteStride : element_bytes;
    if (stride < element_bytes)
        return fail(
            fmt::format("the stride of {} bytes is smaller than an element of {}", stride, element_bytes));
    // count - 1 strides and one element; sizes are below 2^40, so that nothing overflows.
    if (count > 0 && (offset > view.byteLength || count > max_elements ||
                      (count - 1) * stride + element_bytes > view.byteLength - offset)) {
        return fail(fmt::format("its {} elements end at byte {}, bufferView {} has {}",
                                count,
                                offset + (count - 1) * stride + element_bytes,
                                view_index,
                                view.byteLength));
    }
    return Run{data.data() + view.byteOffset + offset, stride};
}

struct Checked {
    const tinygltf::Accessor* accessor;
    std::string where;
    std::size_t component_bytes;
};

tl::expected<Checked, std::string> check(const GltfDocument& document, int index, std::size_t components) {
    const std::string where = fmt::format("accessor {}", index);
    const auto fail = [&](const std::string& rest) {
        return tl::unexpected(document.at(where + ": " + rest));
    };
    if (index < 0 || static_cast<std::size_t>(index) >= document.model.accessors.size())
        return fail("it does not exist");
    const tinygltf::Accessor& accessor = document.model.accessors[static_cast<std::size_t>(index)];
    const std::size_t component_bytes = bytes_of(accessor.componentType);
    if (component_bytes == 0)
        return fail(fmt::format("component type {} is unknown", accessor.componentType));
    if (component_count(document, index) != components)
        return fail(fmt::format(
            "it has {} components, {} are needed here", component_count(document, index), components));
    if (accessor.count > max_elements)
        return fail(fmt::format("its {} elements are over the limit of {}", accessor.count, max_elements));
    if (accessor.bufferView < 0 && accessor.count > max_zeros)
        return fail(fmt::format(
            "it has {} elements and no bufferView, over the limit of {}", accessor.count, max_zeros));
    return Checked{&accessor, where, component_bytes};
}

// Visits (element index, bytes) first of the dense part, then of the sparse replacements.
template <class Visit>
tl::expected<void, std::string> visit_elements(const GltfDocument& document,
                                               const Checked& checked,
                                               std::size_t components,
                                               Visit visit) {
    const tinygltf::Accessor& accessor = *checked.accessor;
    const std::size_t element_bytes = checked.component_bytes * components;
    if (accessor.bufferView >= 0) {
        const auto run = locate(
            document, checked.where, accessor.bufferView, accessor.byteOffset, accessor.count, element_bytes);
        if (!run)
            return tl::unexpected(run.error());
        for (std::size_t n = 0; n < accessor.count; ++n)
            visit(n, run->first + n * run->stride);
    }
    if (!accessor.sparse.isSparse)
        return {};
    const auto count = static_cast<std::size_t>(accessor.sparse.count);
    const std::size_t index_bytes = bytes_of(accessor.sparse.indices.componentType);
    const auto fail = [&](const std::string& rest) {
        return tl::unexpected(document.at(checked.where + " sparse: " + rest));
    };
    if (accessor.sparse.count < 0 || count > accessor.count)
        return fail(fmt::format("{} replacements for {} elements", accessor.sparse.count, accessor.count));
    if (index_bytes == 0 || accessor.sparse.indices.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT)
        return fail(fmt::format("index type {} is unknown", accessor.sparse.indices.componentType));
    if (accessor.sparse.indices.byteOffset < 0 || accessor.sparse.values.byteOffset < 0)
        return fail("a byte offset is negative");
    const auto indices = locate(document,
                                checked.where + " sparse indices",
                                accessor.sparse.indices.bufferView,
                                static_cast<std::size_t>(accessor.sparse.indices.byteOffset),
                                count,
                                index_bytes);
    if (!indices)
        return tl::unexpected(indices.error());
    const auto values = locate(document,
                               checked.where + " sparse values",
                               accessor.sparse.values.bufferView,
                               static_cast<std::size_t>(accessor.sparse.values.byteOffset),
                               count,
                               element_bytes);
    if (!values)
        return tl::unexpected(values.error());
    for (std::size_t n = 0; n < count; ++n) {
        const std::uint32_t element =
            load_index(indices->first + n * indices->stride, accessor.sparse.indices.componentType);
        if (element >= accessor.count)
            return fail(fmt::format("index {} is past the {} elements", element, accessor.count));
        visit(element, values->first + n * values->stride);
    }
    return {};
}

}  // namespace

std::size_t component_count(const GltfDocument& document, int accessor) {
    switch (document.model.accessors[static_cast<std::size_t>(accessor)].type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        default:
            return 0;
    }
}

tl::expected<std::vector<float>, std::string> read_floats(const GltfDocument& document,
                                                          int index,
                                                          std::size_t components) {
    const auto checked = check(document, index, components);
    if (!checked)
        return tl::unexpected(checked.error());
    const tinygltf::Accessor& accessor = *checked->accessor;
    std::vector<float> values(accessor.count * components, 0.0f);
    const auto visited =
        visit_elements(document, *checked, components, [&](std::size_t element, const std::uint8_t* bytes) {
            for (std::size_t k = 0; k < components; ++k) {
                values[element * components + k] = load_float(
                    bytes + k * checked->component_bytes, accessor.componentType, accessor.normalized);
            }
        });
    if (!visited)
        return tl::unexpected(visited.error());
    for (std::size_t n = 0; n < values.size(); ++n) {
        if (!std::isfinite(values[n]))
            return tl::unexpected(
                document.at(fmt::format("accessor {}: element {} is {}", index, n / components, values[n])));
    }
    return values;
}

tl::expected<std::vector<std::uint32_t>, std::string> read_indices(const GltfDocument& document, int index) {
    const auto checked = check(document, index, 1);
    if (!checked)
        return tl::unexpected(checked.error());
    const int type = checked->accessor->componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        return tl::unexpected(
            document.at(fmt::format("accessor {}: component type {} cannot hold indices", index, type)));
    }
    std::vector<std::uint32_t> values(checked->accessor->count, 0);
    const auto visited =
        visit_elements(document, *checked, 1, [&](std::size_t element, const std::uint8_t* bytes) {
            values[element] = load_index(bytes, type);
        });
    if (!visited)
        return tl::unexpected(visited.error());
    return values;
}

}  // namespace drtv::map
