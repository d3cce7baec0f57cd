// Each digest begins with a tag of its own, so that two kinds never give the same bytes.
#include "bakerd/map/content_digest.h"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <utility>

namespace drtv::map {
namespace {

enum class Tag : std::uint32_t { texture = 1, material, primitive, mesh, object, volume, light, probe, map };

// -0 and 0 bake alike.
glm::vec3 plain(const glm::vec3& v) {
    return v + 0.0f;
}

void add_view(Hasher& hasher, const TextureView& view, const Map& map) {
    hasher.add(view.present());
    if (!view.present())
        return;
    hasher.add(map.textures[view.texture].digest);
    hasher.add(plain(view.u_from_uv));
    hasher.add(plain(view.v_from_uv));
}

// Puts things in the order of their digests, and the digests too.
template <class Thing>
void sort_by(std::vector<Digest>& digests, std::vector<Thing>& things) {
    std::vector<std::pair<Digest, Thing>> pairs;
    for (std::size_t n = 0; n < things.size(); ++n)
        pairs.emplace_back(digests[n], std::move(things[n]));
    std::ranges::stable_sort(pairs, {}, &std::pair<Digest, Thing>::first);
    for (std::size_t n = 0; n < things.size(); ++n)
        std::tie(digests[n], things[n]) = std::move(pairs[n]);
}

}  // namespace

void add_light_group(Hasher& hasher, std::uint32_t light_group, const Map& map) {
    if (light_group != no_light_group)
        hasher.add_sized(std::string_view(map.light_groups[light_group]));
}

Digest digest_texture(const Texture& texture) {
    Hasher hasher;
    hasher.add(Tag::texture);
    hasher.add(texture.width);
    hasher.add(texture.height);
    hasher.add(texture.wrap_u);
    hasher.add(texture.wrap_v);
    hasher.add(texture.coverage);
    hasher.add(texture.cutoff);
    hasher.add_sized(texture.rgba);
    return hasher.finish();
}

Digest digest_material(const Material& material, const Map& map) {
    Hasher hasher;
    hasher.add(Tag::material);
    hasher.add(plain(glm::vec3(material.base_colour)));
    add_view(hasher, material.base_texture, map);
    hasher.add(plain(material.emission));
    add_view(hasher, material.emission_texture, map);
    hasher.add(material.diffuse_transmission);
    if (material.diffuse_transmission > 0)
        hasher.add(plain(material.diffuse_transmission_colour));
    hasher.add(material.alpha_mode);
    if (material.alpha_mode != AlphaMode::opaque)
        hasher.add(material.base_colour.w);
    if (material.alpha_mode == AlphaMode::mask)
        hasher.add(material.alpha_cutoff);
    hasher.add(material.double_sided);
    hasher.add(material.transmission);
    if (material.transmission > 0)
        add_view(hasher, material.transmission_texture, map);
    return hasher.finish();
}

Digest digest_primitive(const Primitive& primitive, const Map& map) {
    Hasher hasher;
    hasher.add(Tag::primitive);
    hasher.add_sized(primitive.positions);
    hasher.add_sized(primitive.triangles);
    hasher.add_sized(primitive.uvs);
    hasher.add_sized(primitive.emission_uvs);
    hasher.add_sized(primitive.transmission_uvs);
    hasher.add_sized(primitive.colours);
    hasher.add(map.materials[primitive.material].digest);
    return hasher.finish();
}

Digest digest_mesh(const Mesh& mesh) {
    Hasher hasher;
    hasher.add(Tag::mesh);
    hasher.add(static_cast<std::uint64_t>(mesh.primitives.size()));
    for (const Primitive& primitive : mesh.primitives)
        hasher.add(primitive.digest);
    return hasher.finish();
}

Digest digest_object(const Object& object, const Map& map) {
    Hasher hasher;
    hasher.add(Tag::object);
    hasher.add(map.meshes[object.mesh].digest);
    hasher.add(object.role);
    for (glm::length_t column = 0; column < 4; ++column)
        hasher.add(plain(object.world_from_object[column]));
    add_light_group(hasher, object.light_group, map);
    return hasher.finish();
}

Digest digest_volume(const VolumeNode& volume) {
    Hasher hasher;
    hasher.add(Tag::volume);
    hasher.add(volume.kind);
    hasher.add_sized(volume.positions);
    hasher.add_sized(volume.triangles);
    hasher.add(volume.spacing_m);
    return hasher.finish();
}

Digest digest_light(const Light& light, const Map& map) {
    Hasher hasher;
    hasher.add(Tag::light);
    hasher.add(light.kind);
    hasher.add(plain(light.colour));
    for (float value : {light.intensity, light.range_m, light.inner_cone_radians, light.outer_cone_radians})
        hasher.add(value);
    // A sun stands nowhere, and a point light shines all around.
    if (light.kind != LightKind::directional)
        hasher.add(plain(light.position));
    if (light.kind != LightKind::point)
        hasher.add(plain(light.direction));
    add_light_group(hasher, light.light_group, map);
    return hasher.finish();
}

void finish_content(Map& map) {
    std::ranges::stable_sort(map.objects, {}, &Object::digest);
    std::stable_sort(map.probes.begin(), map.probes.end(), [](const ProbeNode& a, const ProbeNode& b) {
        return std::tuple(a.position.x, a.position.y, a.position.z) <
               std::tuple(b.position.x, b.position.y, b.position.z);
    });
    std::vector<Digest> lights;
    std::vector<Digest> volumes;
    for (Light& light : map.lights)
        light.digest = digest_light(light, map);
    std::ranges::stable_sort(map.lights, {}, &Light::digest);
    for (const Light& light : map.lights)
        lights.push_back(light.digest);
    for (const VolumeNode& volume : map.volumes) {
        Hasher hasher;
        hasher.add(volume.digest);
        // The name says which probe an interior uses; what counts is where that probe stands.
        hasher.add(!volume.probe_name.empty());
        if (!volume.probe_name.empty())
            hasher.add(std::ranges::find(map.probes, volume.probe_name, &ProbeNode::name)->position);
        volumes.push_back(hasher.finish());
    }
    sort_by(volumes, map.volumes);

    Hasher hasher;
    hasher.add(Tag::map);
    hasher.add(static_cast<std::uint64_t>(map.objects.size()));
    for (const Object& object : map.objects)
        hasher.add(object.digest);
    hasher.add(static_cast<std::uint64_t>(map.probes.size()));
    for (const ProbeNode& probe : map.probes)
        hasher.add(probe.position);
    hasher.add_sized(volumes);
    hasher.add_sized(lights);
    map.content = hasher.finish();
}

}  // namespace drtv::map
