// Maps for tests, written as glTF 2.0 in memory and read back by the product's own importer. All arguments
// are in world axes (z up); the builder turns them into glTF's.
#pragma once

#include "bakerd/map/map.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace drtv::reference {

// An RGBA picture as PNG, with stored (uncompressed) deflate blocks. REQUIRES: rgba.size() == 4 width height
// < 65536 - height.
[[nodiscard]] std::vector<std::uint8_t> encode_png(std::uint32_t width, std::uint32_t height,
                                                   std::span<const std::uint8_t> rgba);

// Triangles of one material; counter-clockwise is the front. `uvs` and `colours` are empty or one a position.
struct Patch {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::vector<glm::vec2> uvs;
    std::vector<glm::vec4> colours;

    // Corners counter-clockwise seen from the front; uvs (0,0) (1,0) (1,1) (0,1).
    void add_quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);
    // Six quads that face outwards.
    void add_box(const glm::vec3& low, const glm::vec3& high);
};

struct Surfacing {
    glm::vec4 base_colour{1};
    bool double_sided = false, masked = false;
    double alpha_cutoff = 0.5;
    int texture = -1;
    bool blended = false;
    glm::vec3 emission{0};  // factor, at most 1
    double emission_strength = 1;
    int emission_texture = -1;
    double transmission = 0;
    glm::vec3 transmission_colour{1};
    double clear = 0;  // KHR_materials_transmission
};

// KHR_lights_punctual. `range_m` 0 is none.
struct Lamp {
    std::string type = "point";
    glm::vec3 colour{1};
    double intensity = 1;
    double range_m = 0;
    double inner_cone_radians = 0, outer_cone_radians = 0.7;  // spot only
    glm::vec3 position{0}, direction{0, 0, -1};
};

// Scale, then a turn about z, then a shift.
struct Placement {
    glm::vec3 shift_m{0};
    double turn_radians = 0;
    glm::vec3 scale{1};
};

class GltfBuilder {
  public:
    int add_texture(std::span<const std::uint8_t> png);
    int add_material(const Surfacing& surfacing);
    // One primitive a patch; patches[n] wears materials[n].
    int add_mesh(std::span<const Patch> patches, std::span<const int> materials);
    int add_mesh(const Patch& patch, int material) { return add_mesh({&patch, 1}, {&material, 1}); }
    void place(int mesh, const Placement& placement, const std::string& role = "static");
    // EXT_mesh_gpu_instancing.
    void place_instances(int mesh, std::span<const Placement> placements, const std::string& role = "static");

    void place_lamp(const Lamp& lamp);

    // Throws std::runtime_error when the importer refuses.
    [[nodiscard]] map::Map import() const;

  private:
    int add_accessor(std::span<const float> values, std::size_t components);
    int add_accessor(std::span<const std::uint32_t> values);
    int add_view(std::span<const std::uint8_t> bytes);
    void use_extension(const std::string& name);

    nlohmann::json root_ = {
        {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", nlohmann::json::array()}}}}};
};

}  // namespace drtv::reference
