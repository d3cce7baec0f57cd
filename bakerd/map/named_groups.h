// Light groups by name: the map's numbers of them, and which nodes of a document name one of which anything
// shines.
#pragma once

#include "bakerd/map/map.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace drtv::map {

// The map's number of a light group of that name, which may be new; none of an empty name.
[[nodiscard]] inline std::uint32_t light_group_of(const std::string& name, Map& map) {
    if (name.empty())
        return no_light_group;
    const auto known = std::ranges::find(map.light_groups, name);
    const auto index = static_cast<std::uint32_t>(known - map.light_groups.begin());
    if (known == map.light_groups.end())
        map.light_groups.push_back(name);
    return index;
}

class NamedGroups {
  public:
    void add(int node, const std::string& group) { named_.emplace(node, group); }

    // Something shines that has its group from that node; below 0 from none.
    void add_light(int node) { lit_.insert(node); }

    // Calls tell(node, group) for each that is of no use, by node.
    template <class Tell>
    void tell_unused(Tell tell) const {
        for (const auto& [node, group] : named_) {
            if (!lit_.contains(node))
                tell(node, group);
        }
    }

  private:
    std::map<int, std::string> named_;
    std::set<int> lit_;
};

}  // namespace drtv::map
