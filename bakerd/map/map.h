// A map after import: meshes kept once, objects that place them, and all else the bake needs. Plain data,
// constant after import, shared by all threads. World axes and units: format/SPEC.md section 2 (z up,
// metres).
#pragma once

#include "bakerd/map/digest.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace drtv::map {

struct Bounds {
    glm::vec3 low{std::numeric_limits<float>::infinity()};
    glm::vec3 high{-std::numeric_limits<float>::infinity()};

    void extend(const glm::vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    [[nodiscard]] bool empty() const { return low.x > high.x; }
};

// Objects lie between -max_height_m and max_height_m.
inline constexpr float max_height_m = 8192;

enum class Wrap : std::uint8_t { repeat, clamp, mirror };

// How much of a texel is there: what averages of its colour count it with.
enum class Coverage : std::uint8_t {
    whole,   // all of it: alpha has no say
    alpha,   // its alpha
    cutoff,  // all or nothing, by Texture::cutoff
};

// A picture at half the size or less: 16-bit linear RGBA. Colour is multiplied by coverage, coverage stands
// in w.
struct MipLevel {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint16_t> rgba;
};

// Least and largest alpha of a block of texels.
struct AlphaRange {
    std::uint8_t low = 255;
    std::uint8_t high = 255;
};

// A decoded picture with the sampler's wrapping: RGBA, 8 bits, colour still sRGB-encoded, alpha linear.
struct Texture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    Coverage coverage = Coverage::whole;
    float cutoff = 0;                      // of alpha; Coverage::cutoff only
    std::vector<std::uint8_t> rgba;        // rows from v = 0
    std::vector<MipLevel> mips;            // level 1 and up, to 1 x 1
    std::vector<AlphaRange> alpha_blocks;  // 8 x 8 texels each, row by row; empty where coverage is whole
    Digest digest;
};

inline constexpr std::uint32_t no_texture = UINT32_MAX;

// A texture as a material wears it: its uv = (row 0, row 1) . (u, v, 1), from KHR_texture_transform.
struct TextureView {
    std::uint32_t texture = no_texture;
    glm::vec3 u_from_uv{1, 0, 0};
    glm::vec3 v_from_uv{0, 1, 0};

    [[nodiscard]] bool present() const { return texture != no_texture; }
};

// Albedo is base colour factor x texture x vertex colour, linear Rec. 709, at most max_albedo; where a
// surface also transmits, both together are at most that. Metals and unlit materials are no exception: they
// send their base colour back as Lambert surfaces do, and an unlit one shines no light.
inline constexpr float max_albedo = 0.95f;

enum class AlphaMode : std::uint8_t {
    opaque,
    mask,   // there where alpha is at least the cutoff
    blend,  // there with the probability alpha
};

struct Material {
    glm::vec4 base_colour{1};  // linear; w is alpha
    TextureView base_texture;
    // Radiance of the front (of both sides where double_sided), nits: factor x strength.
    glm::vec3 emission{0};
    TextureView emission_texture;
    // KHR_materials_diffuse_transmission: the share of scattered light that goes through instead of back, and
    // its colour.
    float diffuse_transmission = 0;
    glm::vec3 diffuse_transmission_colour{1};
    // KHR_materials_transmission, clear glass: the share of light that goes straight on, in the base colour;
    // times the red channel of the picture. The rest is scattered.
    float transmission = 0;
    TextureView transmission_texture;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;  // AlphaMode::mask only
    bool double_sided = false;  // reflects on both sides; else its back absorbs
    Digest digest;
};

// Triangles of one material. Vertices stand in the order of their first use.
struct Primitive {
    std::vector<glm::vec3> positions;         // object space
    std::vector<glm::uvec3> triangles;        // counter-clockwise seen from the front
    std::vector<glm::vec2> uvs;               // of the base texture; empty unless the material has one
    std::vector<glm::vec2> emission_uvs;      // of the emission texture; empty unless the material has one
    std::vector<glm::vec2> transmission_uvs;  // likewise
    std::vector<glm::vec4> colours;           // linear; empty unless the mesh has them
    std::uint32_t material = 0;
    Digest digest;
};

struct Mesh {
    std::vector<Primitive> primitives;  // sorted by digest
    Bounds bounds;                      // object space
    Digest digest;
};

inline constexpr std::uint32_t no_light_group = UINT32_MAX;

enum class Role : std::uint8_t { fixed, vegetation };  // "static" and "vegetation"

// One placed mesh. `world_from_object` may mirror; then the winding of the object space still tells the
// front.
struct Object {
    std::uint32_t mesh = 0;
    Role role = Role::fixed;
    glm::mat4x3 world_from_object{1};
    std::uint32_t light_group = no_light_group;  // of one that shines: an index into Map::light_groups
    Bounds bounds;                               // world
    Digest digest;                               // mesh, place, role, light group
    std::string name;
};

// A hand-placed probe. Its name serves `bake_probe` only.
struct ProbeNode {
    glm::dvec3 position{};  // world
    std::string name;
};

enum class VolumeKind : std::uint8_t { no_probes, interior, spacing };

// A closed mesh in world space (closedness is checked by placement, which has the tools for it).
struct VolumeNode {
    VolumeKind kind = VolumeKind::no_probes;
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> triangles;
    std::string probe_name;  // interior: `bake_probe`, may be empty
    float spacing_m = 0;     // spacing: `bake_spacing`, the least distance of automatic probes inside
    std::string name;
    std::string where;  // file and node, for messages
    Digest digest;
};

enum class LightKind : std::uint8_t { point, spot, directional };

// KHR_lights_punctual, in its own units (candela, or lux for directional); range 0 means unlimited.
struct Light {
    LightKind kind = LightKind::point;
    glm::vec3 colour{1};
    float intensity = 1;
    float range_m = 0;
    float inner_cone_radians = 0;
    float outer_cone_radians = 0;
    glm::vec3 position{};                        // world
    glm::vec3 direction{};                       // world; in which a spot or directional light shines
    std::uint32_t light_group = no_light_group;  // an index into Map::light_groups
    Digest digest;
    std::string name;
};

// A dark light is none.
[[nodiscard]] inline bool shines(const Light& light) {
    return light.intensity > 0 && light.colour != glm::vec3(0);
}

struct Map {
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Object> objects;  // sorted by digest, so that their order does not depend on the files
    std::vector<ProbeNode> probes;
    std::vector<VolumeNode> volumes;
    std::vector<Light> lights;
    std::vector<std::string> light_groups;  // names, one of each
    std::vector<std::string> warnings;      // one sentence each
    std::int64_t ignored_nodes = 0;         // with a bake_role 'ignore' of their own
    // Covers all that can change a bake and nothing else: no names, no order of files, nodes or buffers.
    Digest content;
};

}  // namespace drtv::map
