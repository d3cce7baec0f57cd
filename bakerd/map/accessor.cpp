#include "bakerd/map/accessor.h"

#include "bakerd/map/component.h"

#include <fmt/format.h>

#include <cmath>

namespace drtv::map {
namespace {

constexpr std::size_t max_elements = std::size_t{1} << 27;
// An accessor without bufferView is all zeros, at no cost in the file: it needs a limit of its own.
constexpr std::size_t max_zeros = std::size_t{1} << 20;

using Done = tl::expected<void, std::string>;

// A checked run of equally spaced elements in a buffer.
struct Run {
    const std::uint8_t* first = nullptr;
    std::size_t stride = 0;

    [[nodiscard]] const std::uint8_t* at(std::size_t element) const { return first + element * stride; }
};

// What a run shall hold, and where the file says it is.
struct Wanted {
    int view_index;
    std::size_t offset;
    std::size_t count;
    std::size_t element_bytes;
};

tl::expected<Run, std::string> locate(const GltfDocument& document,
                                      const std::string& where,
                                      const Wanted& wanted) {
    const tinygltf::Model& model = document.model;
    const auto fail = [&](const std::string& rest) {
        return tl::unexpected(document.at(where + ": " + rest));
    };
    const auto& [view_index, offset, count, element_bytes] = wanted;
    if (view_index < 0 || static_cast<std::size_t>(view_index) >= model.bufferViews.size())
        return fail(fmt::format("bufferView {} does not exist", view_index));
    const tinygltf::BufferView& view = at_index(model.bufferViews, view_index);
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
        return fail(fmt::format("buffer {} does not exist", view.buffer));
    const std::vector<unsigned char>& data = at_index(model.buffers, view.buffer).data;
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
    // Sizes are below 2^40, so that only a count past the limit can make this overflow.
    const std::size_t run_bytes = (count - 1) * stride + element_bytes;
    const bool starts_past = offset > view.byteLength;
    const bool ends_past = starts_past || count > max_elements || run_bytes > view.byteLength - offset;
    if (count > 0 && ends_past) {
        return fail(fmt::format("its {} elements end at byte {}, bufferView {} has {}",
                                count,
                                offset + run_bytes,
                                view_index,
                                view.byteLength));
    }
    return Run{data.data() + view.byteOffset + offset, stride};
}

// An accessor that exists, of as many components as wanted.
struct Checked {
    const GltfDocument& document;
    const tinygltf::Accessor& accessor;
    std::string where;
    std::size_t components;
    std::size_t component_size;

    [[nodiscard]] std::size_t element_bytes() const { return component_size * components; }
};

tl::expected<Checked, std::string> check(const GltfDocument& document, int index, std::size_t components) {
    const std::string where = fmt::format("accessor {}", index);
    const auto fail = [&](const std::string& rest) {
        return tl::unexpected(document.at(where + ": " + rest));
    };
    const std::vector<tinygltf::Accessor>& accessors = document.model.accessors;
    if (index < 0 || static_cast<std::size_t>(index) >= accessors.size())
        return fail("it does not exist");
    const tinygltf::Accessor& accessor = at_index(accessors, index);
    const std::size_t component_size = component_bytes(accessor.componentType);
    if (component_size == 0)
        return fail(fmt::format("component type {} is unknown", accessor.componentType));
    const std::size_t found = component_count(document, index);
    if (found != components)
        return fail(fmt::format("it has {} components, {} are needed here", found, components));
    if (accessor.count > max_elements)
        return fail(fmt::format("its {} elements are over the limit of {}", accessor.count, max_elements));
    if (accessor.bufferView < 0 && accessor.count > max_zeros)
        return fail(fmt::format(
            "it has {} elements and no bufferView, over the limit of {}", accessor.count, max_zeros));
    return Checked{document, accessor, where, components, component_size};
}

// Visits (element index, bytes) of the replacements.
template <class Visit>
Done visit_sparse(const Checked& checked, Visit visit) {
    const tinygltf::Accessor& accessor = checked.accessor;
    const auto& indices = accessor.sparse.indices;
    const auto& values = accessor.sparse.values;
    const int given_count = accessor.sparse.count;
    const auto fail = [&](const std::string& rest) {
        return tl::unexpected(checked.document.at(checked.where + " sparse: " + rest));
    };
    const auto count = static_cast<std::size_t>(given_count);
    if (given_count < 0 || count > accessor.count)
        return fail(fmt::format("{} replacements for {} elements", given_count, accessor.count));
    const int index_type = indices.componentType;
    const std::size_t index_bytes = component_bytes(index_type);
    if (index_bytes == 0 || index_type == TINYGLTF_COMPONENT_TYPE_FLOAT)
        return fail(fmt::format("index type {} is unknown", index_type));
    if (indices.byteOffset < 0 || values.byteOffset < 0)
        return fail("a byte offset is negative");
    const Wanted wanted_indices{
        indices.bufferView, static_cast<std::size_t>(indices.byteOffset), count, index_bytes};
    const auto index_run = locate(checked.document, checked.where + " sparse indices", wanted_indices);
    if (!index_run)
        return tl::unexpected(index_run.error());
    const Wanted wanted_values{
        values.bufferView, static_cast<std::size_t>(values.byteOffset), count, checked.element_bytes()};
    const auto value_run = locate(checked.document, checked.where + " sparse values", wanted_values);
    if (!value_run)
        return tl::unexpected(value_run.error());
    for (std::size_t n = 0; n < count; ++n) {
        const std::uint32_t element = load_index(index_run->at(n), index_type);
        if (element >= accessor.count)
            return fail(fmt::format("index {} is past the {} elements", element, accessor.count));
        visit(element, value_run->at(n));
    }
    return {};
}

// Visits (element index, bytes) first of the dense part, then of the sparse replacements.
template <class Visit>
Done visit_elements(const Checked& checked, Visit visit) {
    const tinygltf::Accessor& accessor = checked.accessor;
    if (accessor.bufferView >= 0) {
        const Wanted wanted{
            accessor.bufferView, accessor.byteOffset, accessor.count, checked.element_bytes()};
        const auto run = locate(checked.document, checked.where, wanted);
        if (!run)
            return tl::unexpected(run.error());
        for (std::size_t n = 0; n < accessor.count; ++n)
            visit(n, run->at(n));
    }
    if (!accessor.sparse.isSparse)
        return {};
    return visit_sparse(checked, visit);
}

bool can_hold_indices(int component_type) {
    return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

}  // namespace

std::size_t component_count(const GltfDocument& document, int accessor) {
    switch (at_index(document.model.accessors, accessor).type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        case TINYGLTF_TYPE_MAT4:
            return 16;
        default:
            return 0;
    }
}

tl::expected<Floats, std::string> read_floats(const GltfDocument& document,
                                              int index,
                                              std::size_t components) {
    const auto checked = check(document, index, components);
    if (!checked)
        return tl::unexpected(checked.error());
    const int type = checked->accessor.componentType;
    const bool normalized = checked->accessor.normalized;
    const std::size_t component_size = checked->component_size;
    Floats values(checked->accessor.count * components, 0.0f);
    const auto convert = [&](std::size_t element, const std::uint8_t* bytes) {
        float* out = &values[element * components];
        for (std::size_t k = 0; k < components; ++k)
            out[k] = load_float(bytes + k * component_size, type, normalized);
    };
    if (const Done visited = visit_elements(*checked, convert); !visited)
        return tl::unexpected(visited.error());
    for (std::size_t n = 0; n < values.size(); ++n) {
        if (!std::isfinite(values[n]))
            return tl::unexpected(
                document.at(fmt::format("accessor {}: element {} is {}", index, n / components, values[n])));
    }
    return values;
}

tl::expected<Indices, std::string> read_indices(const GltfDocument& document, int index) {
    const auto checked = check(document, index, 1);
    if (!checked)
        return tl::unexpected(checked.error());
    const int type = checked->accessor.componentType;
    if (!can_hold_indices(type))
        return tl::unexpected(
            document.at(fmt::format("accessor {}: component type {} cannot hold indices", index, type)));
    Indices values(checked->accessor.count, 0);
    const auto convert = [&](std::size_t element, const std::uint8_t* bytes) {
        values[element] = load_index(bytes, type);
    };
    if (const Done visited = visit_elements(*checked, convert); !visited)
        return tl::unexpected(visited.error());
    return values;
}

}  // namespace drtv::map
