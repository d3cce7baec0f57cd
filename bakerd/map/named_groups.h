// Which nodes of a document name a light group, and whether anything there shines.
#pragma once

#include <map>
#include <set>
#include <string>

namespace drtv::map {

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
