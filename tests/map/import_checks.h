// What the importer's tests say about a result.
#pragma once

#include "bakerd/map/map.h"

#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <initializer_list>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::test {

// One clear sentence: a single line of sensible length that holds all of `parts`.
template <class Value>
void expect_refused(const tl::expected<Value, std::string>& result,
                    std::initializer_list<std::string> parts) {
    ASSERT_FALSE(result.has_value()) << "accepted";
    const std::string& sentence = result.error();
    EXPECT_FALSE(sentence.empty());
    EXPECT_LT(sentence.size(), 600u) << sentence;
    for (char c : sentence)
        EXPECT_FALSE(static_cast<unsigned char>(c) < 0x20 || c == 0x7F) << sentence;
    for (const std::string& part : parts)
        EXPECT_NE(sentence.find(part), std::string::npos) << "'" << part << "' is not in: " << sentence;
}

// The value, or a failure with the sentence and an empty value.
template <class Value>
Value expect_accepted(tl::expected<Value, std::string> result) {
    EXPECT_TRUE(result.has_value()) << result.error();
    return result ? std::move(*result) : Value{};
}

inline void expect_near(const glm::vec3& actual, const glm::vec3& expected, float tolerance = 0) {
    for (glm::length_t k = 0; k < 3; ++k)
        EXPECT_NEAR(actual[k], expected[k], tolerance) << "component " << k;
}

struct WorldTriangle {
    glm::vec3 corners[3];
    glm::vec3 front;  // unit normal of the side that reflects
};

// All triangles of an object in world space. Where the object mirrors, the front is the other side of what
// the corners' order says in the world: the winding in object space counts.
inline std::vector<WorldTriangle> world_triangles(const map::Map& map, const map::Object& object) {
    std::vector<WorldTriangle> triangles;
    const float side = glm::determinant(glm::mat3(object.world_from_object)) < 0 ? -1.0f : 1.0f;
    for (const map::Primitive& primitive : map.meshes[object.mesh].primitives) {
        for (const glm::uvec3& t : primitive.triangles) {
            WorldTriangle triangle;
            for (glm::length_t k = 0; k < 3; ++k)
                triangle.corners[k] = object.world_from_object * glm::vec4(primitive.positions[t[k]], 1);
            triangle.front = side * glm::normalize(glm::cross(triangle.corners[1] - triangle.corners[0],
                                                              triangle.corners[2] - triangle.corners[0]));
            triangles.push_back(triangle);
        }
    }
    return triangles;
}

}  // namespace drtv::test
