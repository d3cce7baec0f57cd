#include "bakerd/map/material_import.h"

#include "bakerd/map/content_digest.h"
#include "bakerd/map/texture_import.h"
#include "bakerd/map/warning.h"

#include <fmt/format.h>

#include <utility>

namespace drtv::map {
namespace {

// Nits; the sun's disk has 1.6e9.
constexpr double max_emission = 1e12;

bool lies_in(double value, double low, double high) {
    return value >= low && value <= high;
}

// What is there of the base texture.
CoverageTest coverage_test_of(const Material& material) {
    if (material.alpha_mode == AlphaMode::blend)
        return {Coverage::alpha, 0};
    if (material.alpha_mode == AlphaMode::opaque)
        return {Coverage::whole, 0};
    constexpr float nowhere = 2;  // no texel has that alpha
    if (material.base_colour.w > 0)
        return {Coverage::cutoff, material.alpha_cutoff / material.base_colour.w};
    return {Coverage::cutoff, material.alpha_cutoff > 0 ? nowhere : 0};
}

class MaterialImporter {
  public:
    explicit MaterialImporter(const ImportState& state) : state_(state), textures_(state) {}

    tl::expected<Material, std::string> import(const tinygltf::Material& source, const std::string& where) {
        where_ = where;
        Material material;
        if (auto read = read_base(source, material); !read)
            return tl::unexpected(read.error());
        if (auto read = read_emission(source, material); !read)
            return tl::unexpected(read.error());
        if (auto read = read_diffuse_transmission(source, material); !read)
            return tl::unexpected(read.error());
        if (auto read = read_transmission(source, material); !read)
            return tl::unexpected(read.error());
        return material;
    }

  private:
    [[nodiscard]] tl::unexpected<std::string> fail(const std::string& rest) const {
        return tl::unexpected(state_.document.at(where_ + ": " + rest));
    }

    Imported read_base(const tinygltf::Material& source, Material& material) {
        if (auto read = read_base_colour(source, material); !read)
            return read;
        if (source.alphaMode == "MASK") {
            material.alpha_mode = AlphaMode::mask;
            material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
        } else if (source.alphaMode == "BLEND") {
            material.alpha_mode = AlphaMode::blend;
        } else if (!source.alphaMode.empty() && source.alphaMode != "OPAQUE") {
            return fail(fmt::format("alphaMode '{}' is unknown", source.alphaMode));
        }
        material.double_sided = source.doubleSided;
        return read_view(base_texture_of(source), coverage_test_of(material), material.base_texture);
    }

    Imported read_base_colour(const tinygltf::Material& source, Material& material) {
        std::vector<double> factors = source.pbrMetallicRoughness.baseColorFactor;
        const char* name = "baseColorFactor";
        if (const tinygltf::Value* specular_glossiness = specular_glossiness_of(source)) {
            name = "diffuseFactor";
            factors.clear();
            const bool present = specular_glossiness->Has(name);
            for (int k = 0; present && k < 4; ++k)
                factors.push_back(specular_glossiness->Get(name).Get(k).GetNumberAsDouble());
        }
        for (std::size_t k = 0; k < 4 && k < factors.size(); ++k) {
            if (!lies_in(factors[k], 0, 1))
                return fail(fmt::format("{} {} lies outside [0, 1]", name, factors[k]));
            material.base_colour[static_cast<glm::length_t>(k)] = static_cast<float>(factors[k]);
        }
        return {};
    }

    Imported read_emission(const tinygltf::Material& source, Material& material) {
        double strength = 1;
        const auto extension = source.extensions.find("KHR_materials_emissive_strength");
        if (extension != source.extensions.end() && extension->second.Has("emissiveStrength"))
            strength = extension->second.Get("emissiveStrength").GetNumberAsDouble();
        if (!lies_in(strength, 0, max_emission))
            return fail(fmt::format("emissiveStrength {} lies outside [0, {}]", strength, max_emission));
        for (std::size_t k = 0; k < 3 && k < source.emissiveFactor.size(); ++k) {
            const double factor = source.emissiveFactor[k];
            if (!lies_in(factor, 0, max_emission))
                return fail(fmt::format("emissiveFactor {} lies outside [0, {}]", factor, max_emission));
            const double emission = factor * strength;
            if (!(emission <= max_emission))
                return fail(fmt::format("emissiveFactor {} x emissiveStrength {} is over {} nits",
                                        factor,
                                        strength,
                                        max_emission));
            material.emission[static_cast<glm::length_t>(k)] = static_cast<float>(emission);
        }
        if (material.emission == glm::vec3(0))
            return {};  // then the picture shines nowhere
        return read_view(emission_texture_of(source), CoverageTest{}, material.emission_texture);
    }

    Imported read_transmission(const tinygltf::Material& source, Material& material) {
        const tinygltf::Value* extension = transmission_of(source);
        if (extension == nullptr || !extension->Has("transmissionFactor"))
            return {};
        const double factor = extension->Get("transmissionFactor").GetNumberAsDouble();
        if (!lies_in(factor, 0, 1))
            return fail(fmt::format("transmissionFactor {} lies outside [0, 1]", factor));
        material.transmission = static_cast<float>(factor);
        if (!(material.transmission > 0))
            return {};
        return read_view(transmission_texture_of(source), CoverageTest{}, material.transmission_texture);
    }

    Imported read_diffuse_transmission(const tinygltf::Material& source, Material& material) {
        const auto extension = source.extensions.find("KHR_materials_diffuse_transmission");
        if (extension == source.extensions.end())
            return {};
        const tinygltf::Value& value = extension->second;
        if (value.Has("diffuseTransmissionFactor")) {
            const double factor = value.Get("diffuseTransmissionFactor").GetNumberAsDouble();
            if (!lies_in(factor, 0, 1))
                return fail(fmt::format("diffuseTransmissionFactor {} lies outside [0, 1]", factor));
            material.diffuse_transmission = static_cast<float>(factor);
        }
        if (value.Has("diffuseTransmissionColorFactor")) {
            const tinygltf::Value& colours = value.Get("diffuseTransmissionColorFactor");
            for (int k = 0; k < 3; ++k) {
                const double colour = colours.Get(k).GetNumberAsDouble();
                if (!lies_in(colour, 0, 1))
                    return fail(fmt::format("diffuseTransmissionColorFactor {} lies outside [0, 1]", colour));
                material.diffuse_transmission_colour[k] = static_cast<float>(colour);
            }
        }
        for (const char* texture : {"diffuseTransmissionTexture", "diffuseTransmissionColorTexture"}) {
            if (value.Has(texture))
                warn_of_ignored(texture);
        }
        return {};
    }

    void warn_of_ignored(const char* texture) {
        const std::string rest =
            fmt::format("{}: its {} is ignored, the factors alone count", where_, texture);
        warn(state_.map, state_.document.at(rest));
    }

    Imported read_view(const TextureUse& use, CoverageTest coverage, TextureView& view) {
        const auto read = textures_.view_of(use, coverage);
        if (!read)
            return fail(read.error());
        view = *read;
        return {};
    }

    const ImportState& state_;
    TextureImporter textures_;
    std::string where_;
};

std::uint32_t keep(Material material, const ImportState& state) {
    material.digest = digest_material(material, state.map);
    return keep_once(std::move(material), state.map.materials, state.shared.materials);
}

// Whether some primitive wears each material.
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

std::string name_of_material(const GltfDocument& document, std::size_t material) {
    const std::string& name = document.model.materials[material].name;
    return name.empty() ? fmt::format("material {}", material)
                        : fmt::format("material {} ('{}')", material, name);
}

tl::expected<MaterialIndices, std::string> import_materials(const ImportState& state) {
    const GltfDocument& document = state.document;
    MaterialIndices indices;
    MaterialImporter importer(state);
    const std::vector<bool> worn = worn_materials(document.model);
    for (std::size_t n = 0; n < document.model.materials.size(); ++n) {
        if (!worn[n]) {
            indices.push_back(UINT32_MAX);
            continue;
        }
        auto material = importer.import(document.model.materials[n], name_of_material(document, n));
        if (!material)
            return tl::unexpected(material.error());
        indices.push_back(keep(std::move(*material), state));
    }
    indices.push_back(keep(Material{}, state));
    return indices;
}

}  // namespace drtv::map
