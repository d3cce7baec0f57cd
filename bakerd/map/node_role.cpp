#include "bakerd/map/node_role.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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

}  // namespace

tl::expected<void, std::string> read_purpose(const tinygltf::Node& node, NodePurpose& purpose) {
    const tinygltf::Value& extras = node.extras;
    if (!extras.IsObject())
        return {};
    if (extras.Has("bake_role")) {
        const tinygltf::Value& value = extras.Get("bake_role");
        if (!value.IsString())
            return tl::unexpected(std::string("bake_role must be a string"));
        const std::string& name = value.Get<std::string>();
        const auto* found = std::ranges::find(role_names, name, &RoleName::name);
        if (found == role_names.end())
            return tl::unexpected(fmt::format(
                "bake_role '{}' is not one of static, vegetation, ignore, probe, no_probes, interior", name));
        purpose.role = found->role;
    }
    if (extras.Has("bake_probe")) {
        const tinygltf::Value& value = extras.Get("bake_probe");
        if (!value.IsString())
            return tl::unexpected(std::string("bake_probe must be a string"));
        purpose.bake_probe = value.Get<std::string>();
    }
    return {};
}

}  // namespace drtv::map
