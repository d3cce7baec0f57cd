#include "bakerd/map/node_role.h"

#include "bakerd/map/warning.h"
#include "format/spelling/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace drtv::map {
namespace {

struct RoleName {
    const char* name;
    NodeRole role;
};

constexpr std::array<RoleName, 6> role_names = {{{"static", NodeRole::fixed},
                                                 {"vegetation", NodeRole::vegetation},
                                                 {"ignore", NodeRole::ignore},
                                                 {"probe", NodeRole::probe},
                                                 {"no_probes", NodeRole::no_probes},
                                                 {"interior", NodeRole::interior}}};

// Beyond the upper one every sector would look far around itself (placement::decision_margin_m).
constexpr double min_spacing_m = 1;
constexpr double max_spacing_m = 8;

// Of a sector file (drtv/sector.h).
constexpr std::size_t max_light_group_name = 63;

tl::expected<void, std::string> read_role(const tinygltf::Value& value, NodeRole& role) {
    constexpr const char* known = "static, vegetation, ignore, probe, no_probes, interior";
    if (!value.IsString())
        return tl::unexpected(fmt::format("bake_role must be a string, one of {}", known));
    const std::string& name = value.Get<std::string>();
    const auto* found = std::ranges::find(role_names, name, &RoleName::name);
    if (found == role_names.end()) {
        std::vector<std::string> names;
        for (const RoleName& role_name : role_names)
            names.emplace_back(role_name.name);
        return tl::unexpected(
            fmt::format("bake_role '{}' is not one of {}{}", name, known, spelling::suggestion(name, names)));
    }
    role = found->role;
    return {};
}

tl::expected<float, std::string> read_spacing(const tinygltf::Value& value) {
    if (!value.IsNumber())
        return tl::unexpected(std::string("bake_spacing must be a number, of metres"));
    const double spacing_m = value.GetNumberAsDouble();
    if (!(spacing_m >= min_spacing_m && spacing_m <= max_spacing_m))
        return tl::unexpected(fmt::format(
            "bake_spacing is {}, not between {} and {} m", spacing_m, min_spacing_m, max_spacing_m));
    return static_cast<float>(spacing_m);
}

tl::expected<std::string, std::string> read_light_group(const tinygltf::Value& value) {
    if (!value.IsString())
        return tl::unexpected(std::string("light_group must be a string"));
    const std::string& name = value.Get<std::string>();
    if (std::ranges::any_of(name, is_control))
        return tl::unexpected(std::string("light_group has a control character in its name"));
    if (name.starts_with(' ') || name.ends_with(' '))
        return tl::unexpected(fmt::format("light_group '{}' begins or ends with a space", name));
    if (name.size() > max_light_group_name)
        return tl::unexpected(fmt::format(
            "light_group '{}' has {} bytes, over the limit of {}", name, name.size(), max_light_group_name));
    return name;
}

}  // namespace

bool has_role(const tinygltf::Node& node) {
    return node.extras.IsObject() && node.extras.Has("bake_role");
}

bool has_light_group(const tinygltf::Node& node) {
    return node.extras.IsObject() && node.extras.Has("light_group");
}

tl::expected<void, std::string> read_purpose(const tinygltf::Node& node, NodePurpose& purpose) {
    const tinygltf::Value& extras = node.extras;
    if (!extras.IsObject())
        return {};
    const bool says_role = has_role(node);
    if (says_role) {
        if (auto read = read_role(extras.Get("bake_role"), purpose.role); !read)
            return read;
        purpose.spacing_m = 0;
    }
    if (extras.Has("bake_probe")) {
        const tinygltf::Value& value = extras.Get("bake_probe");
        if (!value.IsString())
            return tl::unexpected(std::string("bake_probe must be a string"));
        purpose.bake_probe = value.Get<std::string>();
    }
    if (has_light_group(node)) {
        auto name = read_light_group(extras.Get("light_group"));
        if (!name)
            return tl::unexpected(name.error());
        purpose.light_group = std::move(*name);
    }
    if (extras.Has("bake_spacing")) {
        const auto spacing_m = read_spacing(extras.Get("bake_spacing"));
        if (!spacing_m)
            return tl::unexpected(spacing_m.error());
        if (says_role && purpose.role != NodeRole::fixed && purpose.role != NodeRole::interior)
            return tl::unexpected(
                std::string("bake_spacing goes with bake_role 'static' or 'interior', or alone"));
        purpose.spacing_m = *spacing_m;
        if (!says_role && purpose.role != NodeRole::interior)
            purpose.role = NodeRole::spacing;
    }
    return {};
}

std::string inherited_probe(std::size_t meshes) {
    const bool is_one = meshes == 1;
    return fmt::format(
        "{} below it {} its bake_role 'probe', and {} in no light's way: set it on the probe alone",
        is_one ? "a mesh" : fmt::format("{} meshes", meshes),
        is_one ? "inherits" : "inherit",
        is_one ? "stands" : "stand");
}

}  // namespace drtv::map
