#include "bakerd/picture/camera.h"

#include "bakerd/map/cos_sin.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace drtv::picture {

Camera Camera::at(const glm::vec3& eye, const glm::vec3& look, float fov_deg, Size size) {
    const glm::dvec2 half = map::cos_sin(static_cast<double>(fov_deg) * std::numbers::pi / 360);
    const auto across = static_cast<float>(half.y / half.x);
    Camera camera;
    camera.size_ = size;
    camera.eye_ = eye;
    camera.forward_ = glm::normalize(look - eye);
    const glm::vec3 sideways(camera.forward_.y, -camera.forward_.x, 0);
    const float length = glm::length(sideways);
    // Straight up or down, east is on the right.
    const glm::vec3 right = length > 1e-6f ? sideways / length : glm::vec3(1, 0, 0);
    camera.right_ = right * across;
    camera.up_ = glm::cross(right, camera.forward_) *
                 (across * static_cast<float>(size.height) / static_cast<float>(size.width));
    camera.pixel_radians_ = 2 * across / static_cast<float>(size.width);
    return camera;
}

Camera Camera::above(const trace::WorldRectangle& world, float top_m, Size size) {
    const glm::vec2 middle = (world.low + world.high) / 2.0f;
    const glm::vec2 half = (world.high - world.low) / 2.0f;
    Camera camera;
    camera.size_ = size;
    camera.eye_ = {middle.x, middle.y, top_m};
    camera.forward_ = {0, 0, -1};
    camera.right_ = {half.x, 0, 0};
    camera.up_ = {0, half.y, 0};
    camera.is_parallel_ = true;
    camera.pixel_m_ = 2 * half.x / static_cast<float>(size.width);
    return camera;
}

trace::Ray Camera::ray(glm::vec2 pixel) const {
    const glm::vec2 size(size_.width, size_.height);
    const glm::vec3 aside = right_ * (2 * pixel.x / size.x - 1) + up_ * (1 - 2 * pixel.y / size.y);
    if (is_parallel_)
        return {eye_ + aside, forward_, sight_m};
    return {eye_, glm::normalize(forward_ + aside), sight_m};
}

// By the square of the cosine: once because the picture's plane is farther there, once because it leans.
float Camera::drawn_out(const glm::vec3& place) const {
    const glm::vec3 way = place - eye_;
    const float ahead = glm::dot(way, forward_);
    return is_parallel_ || !(ahead > 0) ? 1 : glm::dot(way, way) / (ahead * ahead);
}

std::optional<Camera::Shown> Camera::show(const glm::vec3& place) const {
    const glm::vec3 way = place - eye_;
    const float ahead = glm::dot(way, forward_);
    if (!(ahead > 0))
        return std::nullopt;
    const float scale = is_parallel_ ? 1 : ahead;
    const glm::vec2 aside(glm::dot(way, right_) / glm::dot(right_, right_) / scale,
                          -glm::dot(way, up_) / glm::dot(up_, up_) / scale);
    const glm::vec2 size(size_.width, size_.height);
    return Shown{(aside + 1.0f) / 2.0f * size, is_parallel_ ? ahead : glm::length(way)};
}

}  // namespace drtv::picture
