#include "bakerd/map/mesh_attributes.h"

#include "bakerd/map/material_textures.h"

#include <fmt/format.h>

#include <utility>

namespace drtv::map {
namespace {

// The number of the TEXCOORD that a texture is laid on by.
int uv_set_of(const TextureUse& texture) {
    const auto transform = texture.extensions.find("KHR_texture_transform");
    if (transform == texture.extensions.end() || !transform->second.Has("texCoord"))
        return texture.tex_coord;
    const tinygltf::Value& set = transform->second.Get("texCoord");
    return set.IsNumber() ? set.GetNumberAsInt() : texture.tex_coord;
}

class AttributeReader {
  public:
    AttributeReader(const GltfDocument& document, const NamedPrimitive& primitive)
        : document_(document), primitive_(primitive) {}

    tl::expected<Attributes, std::string> read(const Material& material) {
        auto positions = read_attribute("POSITION", 3);
        if (!positions)
            return tl::unexpected(positions.error());
        attributes_.positions = std::move(*positions);
        attributes_.vertex_count = attributes_.positions.size() / 3;
        if (attributes_.vertex_count == 0)
            return std::move(attributes_);
        if (auto done = read_all_uvs(material); !done)
            return tl::unexpected(done.error());
        if (auto done = read_colours(); !done)
            return tl::unexpected(done.error());
        return std::move(attributes_);
    }

  private:
    // Empty where the primitive has none.
    [[nodiscard]] tl::expected<Floats, std::string> read_attribute(const std::string& name,
                                                                   std::size_t components) const {
        const auto found = primitive_.gltf.attributes.find(name);
        if (found == primitive_.gltf.attributes.end())
            return Floats{};
        const std::size_t count = at_index(document_.model.accessors, found->second).count;
        const std::size_t wanted = attributes_.vertex_count;
        if (wanted != 0 && count != wanted) {
            return tl::unexpected(document_.at(fmt::format(
                "{}: {} has {} elements, POSITION has {}", primitive_.where, name, count, wanted)));
        }
        auto values = read_floats(document_, found->second, components);
        if (!values)
            return tl::unexpected(fmt::format("{} (in {}, {})", values.error(), primitive_.where, name));
        return values;
    }

    [[nodiscard]] tl::expected<Floats, std::string> read_uvs(const TextureUse& texture) const {
        auto uvs = read_attribute(fmt::format("TEXCOORD_{}", uv_set_of(texture)), 2);
        // Without coordinates a texture shows its first texel everywhere, as renderers do.
        if (uvs && uvs->empty())
            uvs->assign(attributes_.vertex_count * 2, 0.0f);
        return uvs;
    }

    tl::expected<void, std::string> read_all_uvs(const Material& material) {
        struct Use {
            const TextureView& view;
            TextureUse (*texture_of)(const tinygltf::Material&);
            Floats& uvs;
        };
        for (const Use& use :
             {Use{material.base_texture, base_texture_of, attributes_.uvs},
              Use{material.emission_texture, emission_texture_of, attributes_.emission_uvs},
              Use{material.transmission_texture, transmission_texture_of, attributes_.transmission_uvs}}) {
            if (!use.view.present())
                continue;
            auto uvs = read_uvs(use.texture_of(gltf_material()));
            if (!uvs)
                return tl::unexpected(uvs.error());
            use.uvs = std::move(*uvs);
        }
        return {};
    }

    [[nodiscard]] const tinygltf::Material& gltf_material() const {
        return at_index(document_.model.materials, primitive_.gltf.material);
    }

    tl::expected<void, std::string> read_colours() {
        const auto found = primitive_.gltf.attributes.find("COLOR_0");
        if (found == primitive_.gltf.attributes.end())
            return {};
        const bool without_alpha = component_count(document_, found->second) == 3;
        attributes_.colour_components = without_alpha ? 3 : 4;
        auto colours = read_attribute("COLOR_0", attributes_.colour_components);
        if (!colours)
            return tl::unexpected(colours.error());
        attributes_.colours = std::move(*colours);
        return {};
    }

    const GltfDocument& document_;
    const NamedPrimitive& primitive_;
    Attributes attributes_;
};

}  // namespace

tl::expected<Attributes, std::string> read_attributes(const GltfDocument& document,
                                                      const NamedPrimitive& primitive,
                                                      const Material& material) {
    return AttributeReader(document, primitive).read(material);
}

}  // namespace drtv::map
