#include "bakerd/map/material_check.h"

#include "bakerd/map/extension_check.h"

namespace drtv::map {
namespace {

CheckResult check_sampler(const Checker& check, Json& sampler, const std::string& where) {
    return check.properties(sampler, where, {index_at("wrapS"), index_at("wrapT")});
}

CheckResult check_texture(const Checker& check, Json& texture, const std::string& where) {
    return check.properties(
        texture, where, {reference_at("source", "images"), reference_at("sampler", "samplers")});
}

// A texture as a material wears it.
CheckResult check_texture_use(const Checker& check, Json& owner, const char* name, const std::string& where) {
    const auto texture = owner.find(name);
    if (texture == owner.end())
        return {};
    const std::initializer_list<Property> members = {
        required(reference_at("index", "textures")), index_at("texCoord"), object_at("extensions")};
    if (CheckResult checked = check.properties(*texture, where + " " + name, members); !checked)
        return checked;
    Json* transform = extension_of(*texture, "KHR_texture_transform");
    if (transform == nullptr)
        return {};
    return check.properties(
        *transform,
        where + ": KHR_texture_transform",
        {numbers_at("offset", 2), numbers_at("scale", 2), number_at("rotation"), index_at("texCoord")});
}

CheckResult check_material_extensions(const Checker& check, Json& material, const std::string& where) {
    if (Json* strength = extension_of(material, "KHR_materials_emissive_strength")) {
        const std::string inner = where + ": KHR_materials_emissive_strength";
        if (CheckResult checked = check.properties(*strength, inner, {number_at("emissiveStrength")});
            !checked)
            return checked;
    }
    if (Json* transmission = extension_of(material, "KHR_materials_diffuse_transmission")) {
        const std::string inner = where + ": KHR_materials_diffuse_transmission";
        const std::initializer_list<Property> members = {number_at("diffuseTransmissionFactor"),
                                                         numbers_at("diffuseTransmissionColorFactor", 3)};
        if (CheckResult checked = check.properties(*transmission, inner, members); !checked)
            return checked;
    }
    if (Json* transmission = extension_of(material, "KHR_materials_transmission")) {
        const std::string inner = where + ": KHR_materials_transmission";
        if (CheckResult checked = check.properties(
                *transmission, inner, {number_at("transmissionFactor"), object_at("transmissionTexture")});
            !checked)
            return checked;
        if (CheckResult checked = check_texture_use(check, *transmission, "transmissionTexture", inner);
            !checked)
            return checked;
    }
    if (Json* colours = extension_of(material, "KHR_materials_pbrSpecularGlossiness")) {
        const std::string inner = where + ": KHR_materials_pbrSpecularGlossiness";
        if (CheckResult checked = check.properties(
                *colours, inner, {numbers_at("diffuseFactor", 4), object_at("diffuseTexture")});
            !checked)
            return checked;
        if (CheckResult checked = check_texture_use(check, *colours, "diffuseTexture", inner); !checked)
            return checked;
    }
    return {};
}

CheckResult check_material(const Checker& check, Json& material, const std::string& where) {
    const std::initializer_list<Property> members = {object_at("pbrMetallicRoughness"),
                                                     string_at("alphaMode"),
                                                     number_at("alphaCutoff"),
                                                     boolean_at("doubleSided"),
                                                     numbers_at("emissiveFactor", 3),
                                                     object_at("emissiveTexture"),
                                                     object_at("extensions")};
    if (CheckResult checked = check.properties(material, where, members); !checked)
        return checked;
    if (CheckResult checked = check_texture_use(check, material, "emissiveTexture", where); !checked)
        return checked;
    if (CheckResult checked = check_material_extensions(check, material, where); !checked)
        return checked;
    const auto pbr = material.find("pbrMetallicRoughness");
    if (pbr == material.end())
        return {};
    const std::initializer_list<Property> pbr_members = {numbers_at("baseColorFactor", 4),
                                                         object_at("baseColorTexture")};
    if (CheckResult checked = check.properties(*pbr, where, pbr_members); !checked)
        return checked;
    return check_texture_use(check, *pbr, "baseColorTexture", where);
}

}  // namespace

CheckResult check_materials(const Checker& check) {
    const auto with = [&](auto check_one) {
        return [&check, check_one](Json& element, const std::string& where) {
            return check_one(check, element, where);
        };
    };
    if (CheckResult checked = check.each("samplers", "sampler", with(check_sampler)); !checked)
        return checked;
    if (CheckResult checked = check.each("textures", "texture", with(check_texture)); !checked)
        return checked;
    return check.each("materials", "material", with(check_material));
}

}  // namespace drtv::map
