#include "tests/trace/scenes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <stdexcept>

namespace drtv::test {

Shape level_square(float h, float z_m) {
    return quad({-h, -h, z_m}, {h, -h, z_m}, {h, h, z_m}, {-h, h, z_m});
}

Thing thing_of(const Shape& shape, const glm::vec3& colour, const std::string& role) {
    Thing thing;
    thing.shape = shape;
    thing.material.colour = glm::vec4(colour, 1);
    thing.role = role;
    return thing;
}

Picture half_masked() {
    Picture picture{2, 2, std::vector<std::uint8_t>(16, 255)};
    picture.rgba[3] = picture.rgba[11] = 0;
    return picture;
}

std::shared_ptr<const map::Map> map_of(std::span<const Thing> things) {
    const glm::dmat4 gltf_from_world(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, -1, 0), glm::dvec4(0, 1, 0, 0),
                                     glm::dvec4(0, 0, 0, 1));
    GltfBuilder builder;
    builder.add_texture(half_masked());
    for (const Thing& thing : things) {
        Shape shape = thing.shape;
        for (glm::vec3& p : shape.positions)
            p = gltf_from_world * glm::dvec4(p, 1);
        const glm::dmat4 m = gltf_from_world * thing.world_from_shape * glm::transpose(gltf_from_world);
        NodeSource node;
        node.mesh = builder.add_mesh(shape, builder.add_material(thing.material));
        node.role = thing.role;
        for (int c = 0; c < 4; ++c) {
            for (int r = 0; r < 4; ++r)
                node.matrix.push_back(m[c][r]);
        }
        builder.add_node(node);
    }
    auto map = builder.import();
    if (!map)
        throw std::runtime_error(map.error());
    return std::make_shared<const map::Map>(std::move(*map));
}

std::shared_ptr<const trace::Scene> scene_of(std::shared_ptr<const map::Map> map,
                                             const trace::WorldRectangle& region, float reach_m) {
    static const std::shared_ptr<trace::Device> device = trace::Device::open().value();
    trace::MapGeometry geometry(device, std::move(map));
    return trace::Scene::build(geometry, region, reach_m);
}

float between(std::mt19937& random, float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 1048576u) / 1048576.0f;
}

glm::vec3 random_direction(std::mt19937& random) {
    for (;;) {
        const glm::vec3 d(between(random, -1, 1), between(random, -1, 1), between(random, -1, 1));
        const float squared = glm::dot(d, d);
        if (squared > 0.01f && squared < 1)
            return d / std::sqrt(squared);
    }
}

Shape triangle_soup(std::mt19937& random, int count, float size_m) {
    Shape soup;
    for (int n = 0; n < count; ++n) {
        const glm::vec3 at(between(random, -10, 10), between(random, -10, 10), between(random, -10, 10));
        for (int k = 0; k < 3; ++k)
            soup.positions.push_back(at + random_direction(random) * size_m);
    }
    return soup;
}

glm::dmat4 random_placement(std::mt19937& random, float spread_m, bool mirrored) {
    glm::dmat4 m = glm::translate(
        glm::dmat4(1), glm::dvec3(between(random, -spread_m, spread_m), between(random, -spread_m, spread_m),
                                  between(random, -5, 5)));
    m = glm::rotate(m, double{between(random, 0, 6)}, glm::dvec3(random_direction(random)));
    return glm::scale(m, glm::dvec3(between(random, 0.3f, 2), between(random, 0.3f, 2),
                                    between(random, 0.3f, 2) * (mirrored ? -1.0f : 1.0f)));
}

}  // namespace drtv::test
