#include "bakerd/bake/lights.h"

#include "bakerd/map/cos_sin.h"
#include "bakerd/map/texture.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x3.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::bake {
namespace {

float luminance(const glm::vec3& colour) {
    return colour.x + colour.y + colour.z;
}

glm::vec3 radiometric(const glm::vec3& photometric) {
    return photometric / lumens_per_watt;
}

PointLight point_light(const map::Light& light) {
    PointLight point;
    point.position = light.position;
    point.intensity = radiometric(light.colour * light.intensity);
    point.range_m = light.range_m;
    if (light.kind == map::LightKind::spot) {
        const double outer = map::cos_sin(static_cast<double>(light.outer_cone_radians)).x,
                     inner = map::cos_sin(static_cast<double>(light.inner_cone_radians)).x;
        point.direction = light.direction;
        point.cone_scale = static_cast<float>(1 / std::max(0.001, inner - outer));
        point.cone_offset = static_cast<float>(-outer) * point.cone_scale;
    }
    return point;
}

// About what a texture is on average.
glm::vec3 mean_colour(const map::Map& map, const map::TextureView& view) {
    if (!view.present())
        return glm::vec3(1);
    const map::Texture& texture = map.textures[view.texture];
    const glm::vec3 mean =
        map::sample_filtered(texture, {0.5f, 0.5f}, static_cast<std::uint32_t>(texture.mips.size()));
    // A few bright texels of a large picture round to nothing, and are something.
    return map::brightest(texture) == glm::vec3(0) ? mean : glm::max(mean, 1 / 65535.0f);
}

EmissiveObject emissive_object(const map::Map& map, std::uint32_t index) {
    const map::Object& object = map.objects[index];
    const map::Mesh& mesh = map.meshes[object.mesh];
    EmissiveObject emissive;
    emissive.object = index;
    emissive.numbers.resize(mesh.primitives.size());
    const glm::dmat4x3 world_from_object(object.world_from_object);
    const glm::dmat3 axes(world_from_object);
    const bool mirrored = glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0;
    glm::dvec3 low(1e30), high(-1e30);
    std::vector<double> powers;
    double sum = 0;
    for (std::uint32_t p = 0; p < mesh.primitives.size(); ++p) {
        const map::Primitive& primitive = mesh.primitives[p];
        const map::Material& material = map.materials[primitive.material];
        const double radiance = static_cast<double>(
            luminance(radiometric(material.emission) * mean_colour(map, material.emission_texture)));
        if (!(radiance > 0))
            continue;
        emissive.radiance = std::max(emissive.radiance, brightest(radiometric(material.emission)));
        emissive.numbers[p].assign(primitive.triangles.size(), UINT32_MAX);
        for (std::uint32_t t = 0; t < primitive.triangles.size(); ++t) {
            const auto corner = [&](glm::length_t k) {
                return world_from_object * glm::dvec4(primitive.positions[primitive.triangles[t][k]], 1);
            };
            const glm::dvec3 a = corner(0), b = corner(mirrored ? 2 : 1), c = corner(mirrored ? 1 : 2);
            // Of the corners as they are kept, in float.
            const double power = static_cast<double>(glm::length(
                                     glm::cross(glm::vec3(b) - glm::vec3(a), glm::vec3(c) - glm::vec3(a)))) /
                                 2 * radiance;
            if (!(power > 0))
                continue;
            emissive.numbers[p][t] = static_cast<std::uint32_t>(emissive.triangles.size());
            emissive.triangles.push_back(
                {p, t, glm::vec3(a), glm::vec3(b), glm::vec3(c), material.double_sided, 0, 0});
            powers.push_back(power);
            sum += power;
            for (const glm::dvec3& v : {a, b, c}) {
                low = glm::min(low, v);
                high = glm::max(high, v);
            }
        }
    }
    double before = 0;
    for (std::size_t n = 0; n < powers.size(); ++n) {
        emissive.triangles[n].share = static_cast<float>(powers[n] / sum);
        emissive.triangles[n].share_before = static_cast<float>(before / sum);
        before += powers[n];
    }
    emissive.centre = glm::vec3((low + high) / 2.0);
    emissive.radius_m = static_cast<float>(glm::length(high - low) / 2);
    emissive.power = static_cast<float>(sum);
    return emissive;
}

std::vector<std::size_t> emissive_triangles_of_meshes(const map::Map& map) {
    std::vector<std::size_t> counts(map.meshes.size(), 0);
    for (std::size_t n = 0; n < counts.size(); ++n) {
        for (const map::Primitive& primitive : map.meshes[n].primitives) {
            if (map.materials[primitive.material].emission != glm::vec3(0))
                counts[n] += primitive.triangles.size();
        }
    }
    return counts;
}

}  // namespace

glm::vec3 PointLight::irradiance_at(const glm::vec3& point) const {
    const glm::vec3 to_light = position - point;
    const float square =
        std::max(glm::dot(to_light, to_light), least_light_distance_m * least_light_distance_m);
    float attenuation = 1 / square;
    if (range_m > 0) {
        const float ratio = square / (range_m * range_m);
        attenuation *= std::clamp(1 - ratio * ratio, 0.0f, 1.0f);
    }
    const float cone =
        std::clamp(-glm::dot(direction, to_light) / std::sqrt(square) * cone_scale + cone_offset, 0.0f, 1.0f);
    return intensity * (attenuation * cone * cone);
}

const EmissiveObject::Triangle* EmissiveObject::find(std::uint32_t primitive, std::uint32_t triangle) const {
    if (numbers[primitive].empty() || numbers[primitive][triangle] == UINT32_MAX)
        return nullptr;
    return &triangles[numbers[primitive][triangle]];
}

bool shines(const map::Light& light) {
    return luminance(light.colour) * light.intensity > 0;
}

std::size_t emissive_triangles(const map::Map& map) {
    const std::vector<std::size_t> of_mesh = emissive_triangles_of_meshes(map);
    std::size_t count = 0;
    for (const map::Object& object : map.objects)
        count += of_mesh[object.mesh];
    return count;
}

StaticLights::StaticLights(std::shared_ptr<const map::Map> map) : map_(std::move(map)) {
    for (const map::Light& light : map_->lights) {
        if (!shines(light))
            continue;
        if (light.kind == map::LightKind::directional)
            suns_.push_back({-light.direction, radiometric(light.colour * light.intensity)});
        else
            points_.push_back(point_light(light));
    }
    const std::vector<std::size_t> triangles = emissive_triangles_of_meshes(*map_);
    for (std::uint32_t n = 0; n < map_->objects.size(); ++n) {
        if (triangles[map_->objects[n].mesh] == 0)
            continue;
        EmissiveObject emissive = emissive_object(*map_, n);
        if (emissive.power > 0)
            emissive_.push_back(std::move(emissive));
    }
}

LightTree::LightTree(const StaticLights& lights, const glm::vec3& centre, float reach_m) {
    std::vector<Node> leaves;
    for (const PointLight& point : lights.points()) {
        if (glm::length(point.position - centre) > reach_m)
            continue;
        points_.push_back(&point);
        leaves.push_back({point.position, 0, luminance(point.intensity), -1, -1, -1, {&point, nullptr}});
    }
    for (const EmissiveObject& emissive : lights.emissive()) {
        if (glm::length(emissive.centre - centre) - emissive.radius_m > reach_m)
            continue;
        leaves.push_back(
            {emissive.centre, emissive.radius_m, emissive.power, -1, -1, -1, {nullptr, &emissive}});
    }
    if (leaves.empty())
        return;
    nodes_.reserve(2 * leaves.size());
    build(leaves, -1);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
        if (nodes_[n].item.emissive != nullptr)
            leaf_of_object_.emplace_back(nodes_[n].item.emissive->object, static_cast<std::int32_t>(n));
    }
    std::ranges::sort(leaf_of_object_);
}

// Halves along the longest axis.
std::int32_t LightTree::build(std::span<Node> leaves, std::int32_t parent) {
    const auto index = static_cast<std::int32_t>(nodes_.size());
    if (leaves.size() == 1) {
        nodes_.push_back(leaves[0]);
        nodes_.back().parent = parent;
        return index;
    }
    map::Bounds bounds, centres;
    Node node;
    node.parent = parent;
    for (const Node& leaf : leaves) {
        bounds.extend(leaf.centre - leaf.radius_m);
        bounds.extend(leaf.centre + leaf.radius_m);
        centres.extend(leaf.centre);
        node.power += leaf.power;
    }
    node.centre = (bounds.low + bounds.high) * 0.5f;
    node.radius_m = glm::length(bounds.high - bounds.low) * 0.5f;
    const glm::vec3 extent = centres.high - centres.low;
    const glm::length_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                               : extent.y >= extent.z                       ? 1
                                                                            : 2;
    std::ranges::stable_sort(leaves, {}, [axis](const Node& leaf) { return leaf.centre[axis]; });
    nodes_.push_back(node);
    const std::int32_t left = build(leaves.first(leaves.size() / 2), index),
                       right = build(leaves.subspan(leaves.size() / 2), index);
    nodes_[static_cast<std::size_t>(index)].left = left;
    nodes_[static_cast<std::size_t>(index)].right = right;
    return index;
}

float LightTree::share_of_left(const Node& node, const glm::vec3& from) const {
    const Node& left = nodes_[static_cast<std::size_t>(node.left)];
    const Node& right = nodes_[static_cast<std::size_t>(node.right)];
    const auto square = [&](const Node& child) {
        const glm::vec3 d = child.centre - from;
        return std::max({glm::dot(d, d),
                         child.radius_m * child.radius_m,
                         least_light_distance_m * least_light_distance_m});
    };
    const float of_left = left.power * square(right), of_right = right.power * square(left);
    // Never quite 0 or 1: no light is left out.
    return std::clamp(of_left / (of_left + of_right), 0.01f, 0.99f);
}

LightTree::Drawn LightTree::draw(const glm::vec3& from, double u, const Roulette& roulette) const {
    Drawn drawn;
    drawn.probability = 1;
    const Node* node = nodes_.data();
    for (;;) {
        // Given up as soon as the rest of the tree cannot matter.
        const glm::vec3 way = node->centre - from;
        const float squared = glm::dot(way, way);
        if (squared > node->radius_m * node->radius_m) {
            const float distance_m = std::max(std::sqrt(squared) - node->radius_m, least_light_distance_m);
            const float scaled = roulette.faint * distance_m * distance_m * drawn.probability;
            if (node->power < drawn.survival * scaled)
                drawn.survival = node->power / scaled;
            if (roulette.number >= drawn.survival) {
                drawn.probability = 0;
                return drawn;
            }
        }
        if (node->left < 0)
            break;
        const double share = share_of_left(*node, from);
        const bool left = u < share;
        u = std::clamp(left ? u / share : (u - share) / (1 - share), 0.0, 1 - 0x1p-32);
        drawn.probability *= static_cast<float>(left ? share : 1 - share);
        node = &nodes_[static_cast<std::size_t>(left ? node->left : node->right)];
    }
    drawn.item = node->item;
    drawn.rest = u;
    return drawn;
}

LightTree::Drawn LightTree::find(const glm::vec3& from, std::uint32_t object) const {
    const auto leaf =
        std::ranges::lower_bound(leaf_of_object_, object, {}, &std::pair<std::uint32_t, std::int32_t>::first);
    if (leaf == leaf_of_object_.end() || leaf->first != object)
        return {};
    Drawn drawn;
    drawn.item = nodes_[static_cast<std::size_t>(leaf->second)].item;
    drawn.probability = 1;
    for (std::int32_t n = leaf->second; nodes_[static_cast<std::size_t>(n)].parent >= 0;) {
        const std::int32_t parent = nodes_[static_cast<std::size_t>(n)].parent;
        const Node& node = nodes_[static_cast<std::size_t>(parent)];
        const float share = share_of_left(node, from);
        drawn.probability *= n == node.left ? share : 1 - share;
        n = parent;
    }
    return drawn;
}

}  // namespace drtv::bake
