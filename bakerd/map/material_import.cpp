#include "bakerd/map/import_parts.h"

#include "bakerd/map/cos_sin.h"
#include "bakerd/map/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>

namespace drtv::map {
namespace {

Wrap wrap_of(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE)
        return Wrap::clamp;
    if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT)
        return Wrap::mirror;
    return Wrap::repeat;
}

// Far beyond any picture; further out, coordinates would overflow.
constexpr float max_transform = 1e6f;

// Nits; the sun's disk has 1.6e9.
constexpr double max_emission = 1e12;

// KHR_texture_transform: offset, rotation, scale, in that order around the texture's origin. The document's
// check saw to the types.
tl::expected<void, std::string> apply_texture_transform(const tinygltf::Value& extension, TextureView& view) {
    glm::dvec2 offset(0), scale(1);
    const auto read_pair = [&](const char* name, glm::dvec2& pair) {
        if (extension.Has(name))
            pair = {extension.Get(name).Get(0).GetNumberAsDouble(),
                    extension.Get(name).Get(1).GetNumberAsDouble()};
    };
    read_pair("offset", offset);
    read_pair("scale", scale);
    const double rotation = extension.Has("rotation") ? extension.Get("rotation").GetNumberAsDouble() : 0;
    const glm::dvec2 turned = cos_sin(rotation);
    view.u_from_uv = glm::vec3(glm::dvec3(turned.x * scale.x, turned.y * scale.y, offset.x));
    view.v_from_uv = glm::vec3(glm::dvec3(-turned.y * scale.x, turned.x * scale.y, offset.y));
    for (const glm::vec3& row : {view.u_from_uv, view.v_from_uv}) {
        for (glm::length_t k = 0; k < 3; ++k) {
            if (!(std::abs(row[k]) <= max_transform))
                return tl::unexpected(
                    fmt::format("KHR_texture_transform: {} is over the limit of {}", row[k], max_transform));
        }
    }
    return {};
}

// A picture as materials use it: many may share one.
struct Use {
    int image = 0;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    Coverage coverage = Coverage::whole;
    float cutoff = 0;

    auto operator<=>(const Use&) const = default;
};

// The materials of one document on their way into the map.
class MaterialImporter {
  public:
    MaterialImporter(const GltfDocument& document, Map& map, Shared& shared)
        : document_(document), map_(map), shared_(shared) {}

    tl::expected<Material, std::string> import(const tinygltf::Material& source, const std::string& where) {
        where_ = where;
        Material material;
        if (auto read = read_base(source, material); !read)
            return tl::unexpected(read.error());
        if (auto read = read_emission(source, material); !read)
            return tl::unexpected(read.error());
        if (auto read = read_transmission(source, material); !read)
            return tl::unexpected(read.error());
        return material;
    }

  private:
    [[nodiscard]] tl::unexpected<std::string> fail(const std::string& rest) const {
        return tl::unexpected(document_.at(where_ + ": " + rest));
    }

    Imported read_base(const tinygltf::Material& source, Material& material) {
        const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
        for (std::size_t k = 0; k < 4 && k < pbr.baseColorFactor.size(); ++k) {
            const double factor = pbr.baseColorFactor[k];
            if (!(factor >= 0 && factor <= 1))
                return fail(fmt::format("baseColorFactor {} lies outside [0, 1]", factor));
            material.base_colour[static_cast<glm::length_t>(k)] = static_cast<float>(factor);
        }
        if (source.alphaMode == "MASK") {
            material.alpha_mode = AlphaMode::mask;
            material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
        } else if (source.alphaMode == "BLEND") {
            material.alpha_mode = AlphaMode::blend;
        } else if (!source.alphaMode.empty() && source.alphaMode != "OPAQUE") {
            return fail(fmt::format("alphaMode '{}' is unknown", source.alphaMode));
        }
        material.double_sided = source.doubleSided;
        Coverage coverage = Coverage::whole;
        float cutoff = 0;
        if (material.alpha_mode == AlphaMode::blend)
            coverage = Coverage::alpha;
        if (material.alpha_mode == AlphaMode::mask) {
            constexpr float nowhere = 2;  // no texel has that alpha
            coverage = Coverage::cutoff;
            cutoff = material.base_colour.w > 0  ? material.alpha_cutoff / material.base_colour.w
                     : material.alpha_cutoff > 0 ? nowhere
                                                 : 0;
        }
        return read_view(pbr.baseColorTexture, coverage, cutoff, material.base_texture);
    }

    Imported read_emission(const tinygltf::Material& source, Material& material) {
        double strength = 1;
        const auto extension = source.extensions.find("KHR_materials_emissive_strength");
        if (extension != source.extensions.end() && extension->second.Has("emissiveStrength"))
            strength = extension->second.Get("emissiveStrength").GetNumberAsDouble();
        if (!(strength >= 0 && strength <= max_emission))
            return fail(fmt::format("emissiveStrength {} lies outside [0, {}]", strength, max_emission));
        for (std::size_t k = 0; k < 3 && k < source.emissiveFactor.size(); ++k) {
            const double factor = source.emissiveFactor[k];
            if (!(factor >= 0 && factor <= max_emission))
                return fail(fmt::format("emissiveFactor {} lies outside [0, {}]", factor, max_emission));
            if (!(factor * strength <= max_emission))
                return fail(fmt::format("emissiveFactor {} x emissiveStrength {} is over {} nits",
                                        factor,
                                        strength,
                                        max_emission));
            material.emission[static_cast<glm::length_t>(k)] = static_cast<float>(factor * strength);
        }
        if (material.emission == glm::vec3(0))
            return {};  // then the picture shines nowhere
        return read_view(source.emissiveTexture, Coverage::whole, 0, material.emission_texture);
    }

    Imported read_transmission(const tinygltf::Material& source, Material& material) {
        const auto extension = source.extensions.find("KHR_materials_diffuse_transmission");
        if (extension == source.extensions.end())
            return {};
        const tinygltf::Value& value = extension->second;
        const double factor = value.Has("diffuseTransmissionFactor")
                                  ? value.Get("diffuseTransmissionFactor").GetNumberAsDouble()
                                  : 0;
        if (!(factor >= 0 && factor <= 1))
            return fail(fmt::format("diffuseTransmissionFactor {} lies outside [0, 1]", factor));
        material.transmission = static_cast<float>(factor);
        if (value.Has("diffuseTransmissionColorFactor")) {
            for (int k = 0; k < 3; ++k) {
                const double colour = value.Get("diffuseTransmissionColorFactor").Get(k).GetNumberAsDouble();
                if (!(colour >= 0 && colour <= 1))
                    return fail(fmt::format("diffuseTransmissionColorFactor {} lies outside [0, 1]", colour));
                material.transmission_colour[k] = static_cast<float>(colour);
            }
        }
        for (const char* texture : {"diffuseTransmissionTexture", "diffuseTransmissionColorTexture"}) {
            if (value.Has(texture))
                warn(map_,
                     document_.at(
                         fmt::format("{}: its {} is ignored, the factors alone count", where_, texture)));
        }
        return {};
    }

    // Of tinygltf's TextureInfo or what looks like it.
    template <class TextureInfo>
    Imported read_view(const TextureInfo& info, Coverage coverage, float cutoff, TextureView& view) {
        if (info.index < 0)
            return {};
        const auto texture = texture_index(info.index, coverage, cutoff);
        if (!texture)
            return tl::unexpected(texture.error());
        view.texture = *texture;
        const auto transform = info.extensions.find("KHR_texture_transform");
        if (transform == info.extensions.end())
            return {};
        if (auto applied = apply_texture_transform(transform->second, view); !applied)
            return fail(applied.error());
        return {};
    }

    tl::expected<std::uint32_t, std::string> texture_index(int index, Coverage coverage, float cutoff) {
        const tinygltf::Model& model = document_.model;
        const tinygltf::Texture& source = model.textures[static_cast<std::size_t>(index)];
        if (source.source < 0)
            return fail(fmt::format("texture {} has no PNG or JPEG source", index));
        Use use{source.source, Wrap::repeat, Wrap::repeat, coverage, cutoff};
        if (source.sampler >= 0) {
            const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(source.sampler)];
            use.wrap_u = wrap_of(sampler.wrapS);
            use.wrap_v = wrap_of(sampler.wrapT);
        }
        const auto known = decoded_.find(use);
        if (known != decoded_.end())
            return known->second;

        const tinygltf::Image& image = model.images[static_cast<std::size_t>(source.source)];
        const std::string image_name = image.name.empty()
                                           ? fmt::format("image {}", source.source)
                                           : fmt::format("image {} ('{}')", source.source, image.name);
        if (image.image.empty())
            return fail(fmt::format("{} has no bytes; is the file missing?", image_name));
        auto texture = decode_texture(image.image);
        if (!texture)
            return fail(fmt::format("{}: {}", image_name, texture.error()));
        texture->wrap_u = use.wrap_u;
        texture->wrap_v = use.wrap_v;
        texture->coverage = coverage;
        texture->cutoff = cutoff;
        texture->digest = digest_texture(*texture);
        const auto [entry, added] =
            shared_.textures.try_emplace(texture->digest, static_cast<std::uint32_t>(map_.textures.size()));
        if (added) {
            prefilter(*texture);
            map_.textures.push_back(std::move(*texture));
        }
        decoded_.emplace(use, entry->second);
        return entry->second;
    }

    const GltfDocument& document_;
    Map& map_;
    Shared& shared_;
    std::map<Use, std::uint32_t> decoded_;  // index into Map::textures
    std::string where_;
};

std::uint32_t keep(Material material, Map& map, Shared& shared) {
    material.digest = digest_material(material, map);
    const auto [entry, added] =
        shared.materials.try_emplace(material.digest, static_cast<std::uint32_t>(map.materials.size()));
    if (added)
        map.materials.push_back(material);
    return entry->second;
}

// Whether some primitive wears each material; a picture missing from one that none wears is no harm.
std::vector<bool> worn_materials(const tinygltf::Model& model) {
    std::vector<bool> worn(model.materials.size(), false);
    for (const tinygltf::Mesh& mesh : model.meshes) {
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            if (primitive.material >= 0)
                worn[static_cast<std::size_t>(primitive.material)] = true;
        }
    }
    return worn;
}

}  // namespace

void warn(Map& map, const std::string& text) {
    constexpr std::size_t most = 100;  // more, nobody reads
    const std::string sentence = as_sentence(text);
    if (map.warnings.size() < most && std::ranges::find(map.warnings, sentence) == map.warnings.end())
        map.warnings.push_back(sentence);
}

std::string name_of_material(const GltfDocument& document, std::size_t material) {
    const std::string& name = document.model.materials[material].name;
    return name.empty() ? fmt::format("material {}", material)
                        : fmt::format("material {} ('{}')", material, name);
}

tl::expected<MaterialIndices, std::string> import_materials(const GltfDocument& document,
                                                            Map& map,
                                                            Shared& shared) {
    MaterialIndices indices;
    MaterialImporter importer(document, map, shared);
    const std::vector<bool> worn = worn_materials(document.model);
    for (std::size_t n = 0; n < document.model.materials.size(); ++n) {
        if (!worn[n]) {
            indices.push_back(UINT32_MAX);
            continue;
        }
        auto material = importer.import(document.model.materials[n], name_of_material(document, n));
        if (!material)
            return tl::unexpected(material.error());
        indices.push_back(keep(*material, map, shared));
    }
    indices.push_back(keep(Material{}, map, shared));
    return indices;
}

}  // namespace drtv::map
