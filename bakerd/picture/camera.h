// Where the rays of a picture's pixels start and go.
#pragma once

#include "bakerd/picture/rectangle.h"
#include "bakerd/trace/ray.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <optional>

namespace drtv::picture {

// Farther away nothing is seen, metres.
inline constexpr float sight_m = 8192;

// Of a picture, and of a sheet of them.
inline constexpr std::size_t max_pixels = 64'000'000;

struct Size {
    std::size_t width = 960;  // pixels
    std::size_t height = 540;

    bool operator==(const Size&) const = default;
};

class Camera {
  public:
    // `fov_deg`: from the left side to the right, 1 to 170. REQUIRES: eye != look.
    [[nodiscard]] static Camera at(const glm::vec3& eye, const glm::vec3& look, float fov_deg, Size size);
    // Straight down from the height `top_m`; north is up.
    [[nodiscard]] static Camera above(const trace::WorldRectangle& world, float top_m, Size size);

    // Through a point of the picture, in pixels from its upper left corner: a pixel's middle is at 1/2.
    [[nodiscard]] trace::Ray ray(glm::vec2 pixel) const;
    // Where a place shows; nothing of one behind the camera.
    struct Shown {
        glm::vec2 pixel{};
        float distance_m = 0;
    };
    [[nodiscard]] std::optional<Shown> show(const glm::vec3& place) const;
    // How wide a pixel is at that distance, metres.
    [[nodiscard]] float pixel_m(float distance_m) const { return pixel_m_ + distance_m * pixel_radians_; }
    // How many times as many pixels a thing there takes up as one in the middle of the picture, at most.
    [[nodiscard]] float drawn_out(const glm::vec3& place) const;
    [[nodiscard]] bool is_parallel() const { return is_parallel_; }
    [[nodiscard]] const glm::vec3& eye() const { return eye_; }
    [[nodiscard]] const glm::vec3& forward() const { return forward_; }
    [[nodiscard]] Size size() const { return size_; }

  private:
    Size size_;
    glm::vec3 eye_{};
    glm::vec3 forward_{};
    glm::vec3 right_{};  // half a picture's width: of directions, or of metres from above
    glm::vec3 up_{};     // half its height
    bool is_parallel_ = false;
    float pixel_m_ = 0;
    float pixel_radians_ = 0;
};

}  // namespace drtv::picture
