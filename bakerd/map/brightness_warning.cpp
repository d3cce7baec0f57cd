#include "bakerd/map/brightness_warning.h"

#include "bakerd/map/material_import.h"
#include "bakerd/map/texture.h"
#include "bakerd/map/warning.h"

#include <fmt/format.h>

#include <algorithm>

namespace drtv::map {
namespace {

float largest_of(const glm::vec3& colour) {
    return std::max({colour.x, colour.y, colour.z});
}

bool is_too_bright(const glm::vec3& albedo) {
    return largest_of(albedo) > max_albedo;
}

glm::vec3 brightest_vertex(const Primitive& primitive) {
    glm::vec3 largest(0);
    for (const glm::vec4& colour : primitive.colours)
        largest = glm::max(largest, glm::vec3(colour));
    return largest;
}

const glm::vec3& brightest_texel(const ImportState& state, std::uint32_t texture) {
    const auto [entry, added] = state.shared.brightest.try_emplace(texture);
    if (added)
        entry->second = brightest(state.map.textures[texture]);
    return entry->second;
}

}  // namespace

void warn_of_brightness(const ImportState& state, int gltf_material, const Primitive& primitive) {
    const Material& material = state.map.materials[primitive.material];
    glm::vec3 albedo(material.base_colour);
    // Clear glass lets it through instead; where a picture says how clear, some may not be.
    if (!material.transmission_texture.present())
        albedo *= 1 - material.transmission;
    if (gltf_material < 0 || !is_too_bright(albedo))
        return;  // glTF's default material is white, and nobody's choice
    if (!primitive.colours.empty())
        albedo *= brightest_vertex(primitive);
    if (material.base_texture.present())
        albedo *= brightest_texel(state, material.base_texture.texture);
    if (!is_too_bright(albedo))
        return;
    const GltfDocument& document = state.document;
    const std::string name = name_of_material(document, static_cast<std::size_t>(gltf_material));
    const std::string where = document.at(name);
    if (!state.shared.warned_of_brightness.insert(where).second)
        return;
    warn(state.map,
         fmt::format(
             "{}: its albedo reaches {:.3g}, and counts as {}", where, largest_of(albedo), max_albedo));
}

}  // namespace drtv::map
