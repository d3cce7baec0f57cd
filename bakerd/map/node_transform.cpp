#include "bakerd/map/node_transform.h"

#include "bakerd/map/accessor.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

namespace drtv::map {
namespace {

tl::expected<glm::dmat4, std::string> compose(const glm::dvec3& translation,
                                              const glm::dquat& rotation,
                                              const glm::dvec3& scale) {
    const double length = glm::length(rotation);
    if (!(length > 1e-6 && length < 1e6))
        return tl::unexpected(fmt::format("its rotation is a quaternion of length {}", length));
    glm::dmat4 local(glm::mat3_cast(rotation * (1 / length)));
    for (glm::length_t c = 0; c < 3; ++c)
        local[c] *= scale[c];
    local[3] = glm::dvec4(translation, 1);
    return local;
}

}  // namespace

tl::expected<glm::dmat4, std::string> local_transform(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) {
        glm::dmat4 local(1);
        for (glm::length_t c = 0; c < 4; ++c) {
            for (glm::length_t r = 0; r < 4; ++r)
                local[c][r] = node.matrix[static_cast<std::size_t>(4 * c + r)];
        }
        if (local[0][3] != 0 || local[1][3] != 0 || local[2][3] != 0 || local[3][3] != 1)
            return tl::unexpected(std::string("its matrix is not affine"));
        return local;
    }
    const glm::dvec3 translation =
        node.translation.size() == 3
            ? glm::dvec3(node.translation[0], node.translation[1], node.translation[2])
            : glm::dvec3(0);
    const glm::dvec3 scale =
        node.scale.size() == 3 ? glm::dvec3(node.scale[0], node.scale[1], node.scale[2]) : glm::dvec3(1);
    glm::dquat rotation(1, 0, 0, 0);
    if (node.rotation.size() == 4)
        rotation = glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    return compose(translation, rotation, scale);
}

tl::expected<std::vector<glm::dmat4>, std::string> instance_transforms(const GltfDocument& document,
                                                                       const tinygltf::Value& extension) {
    std::vector<float> translations, rotations, scales;
    std::size_t count = SIZE_MAX;
    const tinygltf::Value& attributes = extension.Get("attributes");
    const auto read = [&](const char* name,
                          std::size_t components,
                          std::vector<float>& out) -> tl::expected<void, std::string> {
        if (!attributes.Has(name))
            return {};
        auto values = read_floats(document, attributes.Get(name).GetNumberAsInt(), components);
        if (!values)
            return tl::unexpected(values.error());
        out = std::move(*values);
        const std::size_t elements = out.size() / components;
        if (count != SIZE_MAX && elements != count)
            return tl::unexpected(fmt::format("{} has {} elements, others have {}", name, elements, count));
        count = elements;
        return {};
    };
    if (auto done = read("TRANSLATION", 3, translations); !done)
        return tl::unexpected(done.error());
    if (auto done = read("ROTATION", 4, rotations); !done)
        return tl::unexpected(done.error());
    if (auto done = read("SCALE", 3, scales); !done)
        return tl::unexpected(done.error());
    if (count == SIZE_MAX)
        return tl::unexpected(std::string("it has none of TRANSLATION, ROTATION, SCALE"));
    std::vector<glm::dmat4> transforms;
    for (std::size_t n = 0; n < count; ++n) {
        const glm::dvec3 t =
            translations.empty()
                ? glm::dvec3(0)
                : glm::dvec3(translations[3 * n], translations[3 * n + 1], translations[3 * n + 2]);
        const glm::dvec3 s =
            scales.empty() ? glm::dvec3(1) : glm::dvec3(scales[3 * n], scales[3 * n + 1], scales[3 * n + 2]);
        const glm::dquat r =
            rotations.empty()
                ? glm::dquat(1, 0, 0, 0)
                : glm::dquat(
                      rotations[4 * n + 3], rotations[4 * n], rotations[4 * n + 1], rotations[4 * n + 2]);
        const auto local = compose(t, r, s);
        if (!local)
            return tl::unexpected(fmt::format("instance {}: {}", n, local.error()));
        transforms.push_back(*local);
    }
    return transforms;
}

}  // namespace drtv::map
