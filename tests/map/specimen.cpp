#include "tests/map/specimen.h"

namespace drtv::test {

GltfBuilder specimen() {
    GltfBuilder b;
    const int texture = b.add_texture({2, 2, std::vector<std::uint8_t>(16, 99)}, {{"wrapS", 33071}});
    const int material = b.add_material({.mask_cutoff = 0.5, .texture = texture});
    Shape tinted = ground(3);
    tinted.colours.assign(4, glm::vec4(0.5f));
    b.add_node({.mesh = b.add_mesh(tinted, material),
                .rotation = glm::dvec4(0, 0.6, 0, 0.8),
                .name = "g",
                .role = "vegetation"});
    b.add_instances(b.add_mesh(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})), {{1, 2, 3}, {4, 5, 6}});
    b.add_node({.light = b.add_light(Json::parse(R"({"type": "spot", "spot": {"innerConeAngle": 0.1}})")),
                .matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}});
    b.add_node({.children = {0}, .role = "probe"});
    const int sparse = b.add_view(std::vector<std::uint8_t>{1}),
              values = b.add_view(std::vector<glm::vec3>{{9, 9, 9}});
    b.json["accessors"][0]["sparse"] = {{"count", 1},
                                        {"indices", {{"bufferView", sparse}, {"componentType", gltf_u8}}},
                                        {"values", {{"bufferView", values}}}};
    return b;
}

GltfBuilder extended_specimen() {
    GltfBuilder b;
    const int texture = b.add_texture({2, 1, {255, 0, 0, 255, 0, 255, 0, 0}});
    const int leaf = b.add_material({.texture = texture});
    Json& material = b.json["materials"][0];
    material["alphaMode"] = "BLEND";
    material["emissiveFactor"] = {1, 0.5, 0.25};
    material["emissiveTexture"] = {{"index", 0}};
    material["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.5, 0.5}}, {"rotation", 1}, {"scale", {2, 3}}};
    material["extensions"] = {
        {"KHR_materials_emissive_strength", {{"emissiveStrength", 40}}},
        {"KHR_materials_diffuse_transmission",
         {{"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionColorFactor", {0.5, 1, 0.5}}}}};
    b.json["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_emissive_strength",
                                "KHR_materials_diffuse_transmission", "KHR_mesh_quantization"};
    b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    b.place(ground(3), "static", leaf);
    b.place(box({-2, 0, -2}, {2, 2, 2}), "no_probes");
    b.add_node(
        {.mesh = b.add_mesh(box({4, 0, 4}, {6, 2, 6})), .name = "room", .role = "interior", .probe = "lamp"});
    b.add_node({.translation = glm::dvec3(5, 1, 5), .name = "lamp", .role = "probe"});
    const int quantised = b.add_mesh(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), leaf, gltf_strip);
    const std::vector<std::int16_t> corners = {0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0, 100, 100, 0, 0};
    const int view = b.add_view(corners, 8);
    b.json["meshes"][static_cast<std::size_t>(quantised)]["primitives"][0]["attributes"]["POSITION"] =
        b.add_accessor(view, gltf_i16, "VEC3", 4);
    b.json["meshes"][static_cast<std::size_t>(quantised)]["primitives"][0]["attributes"].erase("TEXCOORD_0");
    b.add_node({.mesh = quantised, .scale = glm::dvec3(0.01)});
    return b;
}

}  // namespace drtv::test
