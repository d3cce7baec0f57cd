#include "bakerd/bake/lights.h"

#include "bakerd/map/cos_sin.h"
#include "bakerd/map/texture.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x3.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace drtv::bake {
namespace {

glm::vec3 radiometric(const glm::vec3& photometric) {
    return photometric / lumens_per_watt;
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

// Emissive triangles of an object while they are gathered.
class EmissiveTriangles {
  public:
    EmissiveTriangles(const map::Object& object, std::size_t primitive_count)
        : world_from_object_(object.world_from_object), numbers_(primitive_count) {
        const glm::dmat3 axes(world_from_object_);
        mirrored_ = glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0;
    }

    void add(std::uint32_t p, const map::Primitive& primitive, double radiance, bool both_sides) {
        numbers_[p].assign(primitive.triangles.size(), UINT32_MAX);
        for (std::uint32_t t = 0; t < primitive.triangles.size(); ++t) {
            const auto corner = [&](glm::length_t k) {
                return world_from_object_ * glm::dvec4(primitive.positions[primitive.triangles[t][k]], 1);
            };
            const glm::dvec3 a = corner(0);
            const glm::dvec3 b = corner(mirrored_ ? 2 : 1);
            const glm::dvec3 c = corner(mirrored_ ? 1 : 2);
            // Of the corners as they are kept, in float.
            const glm::vec3 ab = glm::vec3(b) - glm::vec3(a);
            const glm::vec3 ac = glm::vec3(c) - glm::vec3(a);
            const double power = static_cast<double>(glm::length(glm::cross(ab, ac))) / 2 * radiance;
            if (!(power > 0))
                continue;
            numbers_[p][t] = static_cast<std::uint32_t>(triangles_.size());
            triangles_.push_back({p, t, glm::vec3(a), glm::vec3(b), glm::vec3(c), both_sides, 0, 0});
            powers_.push_back(power);
            sum_ += power;
            for (const glm::dvec3& v : {a, b, c}) {
                low_ = glm::min(low_, v);
                high_ = glm::max(high_, v);
            }
        }
    }

    void store(EmissiveObject& emissive) {
        double before = 0;
        for (std::size_t n = 0; n < powers_.size(); ++n) {
            triangles_[n].share = static_cast<float>(powers_[n] / sum_);
            triangles_[n].share_before = static_cast<float>(before / sum_);
            before += powers_[n];
        }
        emissive.centre = glm::vec3((low_ + high_) / 2.0);
        emissive.radius_m = static_cast<float>(glm::length(high_ - low_) / 2);
        emissive.power = static_cast<float>(sum_);
        emissive.triangles = std::move(triangles_);
        emissive.numbers = std::move(numbers_);
    }

  private:
    const glm::dmat4x3 world_from_object_;
    bool mirrored_ = false;
    std::vector<EmissiveObject::Triangle> triangles_;
    std::vector<std::vector<std::uint32_t>> numbers_;
    std::vector<double> powers_;  // by triangle
    double sum_ = 0;
    glm::dvec3 low_ = glm::dvec3(1e30);
    glm::dvec3 high_ = glm::dvec3(-1e30);
};

EmissiveObject emissive_object(const map::Map& map, std::uint32_t index) {
    const map::Object& object = map.objects[index];
    const map::Mesh& mesh = map.meshes[object.mesh];
    EmissiveObject emissive;
    emissive.object = index;
    EmissiveTriangles triangles(object, mesh.primitives.size());
    for (std::uint32_t p = 0; p < mesh.primitives.size(); ++p) {
        const map::Primitive& primitive = mesh.primitives[p];
        const map::Material& material = map.materials[primitive.material];
        const glm::vec3 emission = radiometric(material.emission);
        const float radiance = luminance(emission * mean_colour(map, material.emission_texture));
        if (!(radiance > 0))
            continue;
        emissive.radiance = std::max(emissive.radiance, brightest(emission));
        triangles.add(p, primitive, static_cast<double>(radiance), material.double_sided);
    }
    triangles.store(emissive);
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

StaticPointLight point_light(const map::Light& light) {
    StaticPointLight point;
    point.position = light.position;
    point.intensity = radiometric(light.colour * light.intensity);
    point.range_m = light.range_m;
    if (light.kind == map::LightKind::spot) {
        const double outer = map::cos_sin(static_cast<double>(light.outer_cone_radians)).x;
        const double inner = map::cos_sin(static_cast<double>(light.inner_cone_radians)).x;
        point.direction = light.direction;
        point.cone_scale = static_cast<float>(1 / std::max(0.001, inner - outer));
        point.cone_offset = static_cast<float>(-outer) * point.cone_scale;
    }
    return point;
}

glm::vec3 StaticPointLight::irradiance_at(const glm::vec3& point) const {
    const glm::vec3 to_light = position - point;
    const float square = std::max(glm::dot(to_light, to_light), min_light_distance_m * min_light_distance_m);
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

std::size_t emissive_triangles(const map::Map& map) {
    const std::vector<std::size_t> of_mesh = emissive_triangles_of_meshes(map);
    std::size_t count = 0;
    for (const map::Object& object : map.objects)
        count += of_mesh[object.mesh];
    return count;
}

StaticLights::StaticLights(std::shared_ptr<const map::Map> map) : map_(std::move(map)) {
    std::vector<std::uint32_t> group_of_point;
    std::vector<std::uint32_t> group_of_sun;
    for (const map::Light& light : map_->lights) {
        if (!map::shines(light))
            continue;
        if (light.kind == map::LightKind::directional) {
            suns_.push_back({-light.direction, radiometric(light.colour * light.intensity)});
            group_of_sun.push_back(light.light_group);
        } else {
            points_.push_back(point_light(light));
            group_of_point.push_back(light.light_group);
        }
    }
    const std::vector<std::size_t> triangles = emissive_triangles_of_meshes(*map_);
    for (std::uint32_t n = 0; n < map_->objects.size(); ++n) {
        if (triangles[map_->objects[n].mesh] == 0)
            continue;
        EmissiveObject emissive = emissive_object(*map_, n);
        if (emissive.power > 0)
            emissive_.push_back(std::move(emissive));
    }
    make_sets(group_of_point, group_of_sun);
}

void StaticLights::make_sets(std::span<const std::uint32_t> group_of_point,
                             std::span<const std::uint32_t> group_of_sun) {
    const std::vector<std::string>& names = map_->light_groups;
    std::vector<std::uint32_t> by_name(names.size());
    std::iota(by_name.begin(), by_name.end(), 0u);
    std::ranges::sort(by_name, {}, [&](std::uint32_t group) { return names[group]; });
    set_of_group_.resize(names.size());
    sets_.resize(1);
    for (const std::uint32_t group : by_name) {
        set_of_group_[group] = sets_.size();
        sets_.emplace_back().name = names[group];
    }
    for (std::size_t n = 0; n < points_.size(); ++n)
        sets_[set_of_group(group_of_point[n])].points.push_back(&points_[n]);
    for (std::size_t n = 0; n < suns_.size(); ++n)
        sets_[set_of_group(group_of_sun[n])].suns.push_back(&suns_[n]);
    for (const EmissiveObject& emissive : emissive_)
        sets_[set_of(emissive.object)].emissive.push_back(&emissive);
}

}  // namespace drtv::bake
