#include "bakerd/map/node_transform.h"

#include "bakerd/map/accessor.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <cstdint>

namespace drtv::map {
namespace {

// A transform in parts; those not given change nothing.
struct Parts {
    glm::dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    glm::dvec3 scale{1};
};

template <class Number>
glm::dvec3 vector_at(const std::vector<Number>& numbers, std::size_t element) {
    const Number* v = &numbers[3 * element];
    return {v[0], v[1], v[2]};
}

// glTF writes x, y, z, w.
template <class Number>
glm::dquat quaternion_at(const std::vector<Number>& numbers, std::size_t element) {
    const Number* q = &numbers[4 * element];
    return {q[3], q[0], q[1], q[2]};
}

tl::expected<glm::dmat4, std::string> compose(const Parts& parts) {
    const double length = glm::length(parts.rotation);
    if (!(length > 1e-6 && length < 1e6))
        return tl::unexpected(fmt::format("its rotation is a quaternion of length {}", length));
    glm::dmat4 local(glm::mat3_cast(parts.rotation * (1 / length)));
    for (glm::length_t c = 0; c < 3; ++c)
        local[c] *= parts.scale[c];
    local[3] = glm::dvec4(parts.translation, 1);
    return local;
}

tl::expected<glm::dmat4, std::string> affine(const std::vector<double>& numbers) {
    glm::dmat4 local(1);
    auto number = numbers.begin();
    for (glm::length_t c = 0; c < 4; ++c) {
        for (glm::length_t r = 0; r < 4; ++r)
            local[c][r] = *number++;
    }
    // An inverse in single precision has it nearly so.
    constexpr double rounding = 1e-6;
    for (glm::length_t c = 0; c < 4; ++c) {
        const double exact = c == 3 ? 1 : 0;
        if (!(std::abs(local[c][3] - exact) <= rounding))
            return tl::unexpected(fmt::format(
                "its matrix is not affine: its last row is {}, {}, {}, {}, and must be 0, 0, 0, 1",
                local[0][3],
                local[1][3],
                local[2][3],
                local[3][3]));
        local[c][3] = exact;
    }
    return local;
}

// The attributes of EXT_mesh_gpu_instancing; those not given are empty.
class InstanceAttributes {
  public:
    InstanceAttributes(const GltfDocument& document, const tinygltf::Value& attributes)
        : document_(document), attributes_(attributes) {}

    tl::expected<void, std::string> read() {
        if (auto done = read_one("TRANSLATION", 3, translations_); !done)
            return done;
        if (auto done = read_one("ROTATION", 4, rotations_); !done)
            return done;
        if (auto done = read_one("SCALE", 3, scales_); !done)
            return done;
        if (count_ == unknown)
            return tl::unexpected(std::string("it has none of TRANSLATION, ROTATION, SCALE"));
        return {};
    }

    [[nodiscard]] std::size_t count() const { return count_; }

    [[nodiscard]] Parts parts_of(std::size_t instance) const {
        Parts parts;
        if (!translations_.empty())
            parts.translation = vector_at(translations_, instance);
        if (!rotations_.empty())
            parts.rotation = quaternion_at(rotations_, instance);
        if (!scales_.empty())
            parts.scale = vector_at(scales_, instance);
        return parts;
    }

  private:
    tl::expected<void, std::string> read_one(const char* name, std::size_t components, Floats& out) {
        if (!attributes_.Has(name))
            return {};
        const int accessor = attributes_.Get(name).GetNumberAsInt();
        auto values = read_floats(document_, accessor, components);
        if (!values)
            return tl::unexpected(values.error());
        out = std::move(*values);
        const std::size_t elements = out.size() / components;
        if (count_ != unknown && elements != count_)
            return tl::unexpected(fmt::format("{} has {} elements, others have {}", name, elements, count_));
        count_ = elements;
        return {};
    }

    static constexpr std::size_t unknown = SIZE_MAX;

    const GltfDocument& document_;
    const tinygltf::Value& attributes_;
    Floats translations_;
    Floats rotations_;
    Floats scales_;
    std::size_t count_ = unknown;
};

}  // namespace

tl::expected<glm::dmat4, std::string> local_transform(const tinygltf::Node& node) {
    if (node.matrix.size() == 16)
        return affine(node.matrix);
    Parts parts;
    if (node.translation.size() == 3)
        parts.translation = vector_at(node.translation, 0);
    if (node.rotation.size() == 4)
        parts.rotation = quaternion_at(node.rotation, 0);
    if (node.scale.size() == 3)
        parts.scale = vector_at(node.scale, 0);
    return compose(parts);
}

tl::expected<std::vector<glm::dmat4>, std::string> instance_transforms(const GltfDocument& document,
                                                                       const tinygltf::Value& extension) {
    InstanceAttributes attributes(document, extension.Get("attributes"));
    if (auto read = attributes.read(); !read)
        return tl::unexpected(read.error());
    std::vector<glm::dmat4> transforms;
    for (std::size_t n = 0; n < attributes.count(); ++n) {
        const auto local = compose(attributes.parts_of(n));
        if (!local)
            return tl::unexpected(fmt::format("instance {}: {}", n, local.error()));
        transforms.push_back(*local);
    }
    return transforms;
}

}  // namespace drtv::map
