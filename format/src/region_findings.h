// What is found in a region, each finding with the sector at which it is told.
#pragma once

#include <drtv/issues.h>
#include <drtv/validate_region.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace drtv {

class RegionFindings {
  public:
    void add(std::size_t sector, Finding finding) { found_.push_back({sector, std::move(finding)}); }

    // By sector, then in the order of the table of issues, then in that of adding.
    [[nodiscard]] std::vector<RegionFinding> take() {
        const auto order = [](const RegionFinding& found) {
            const auto issues = all_issues();
            const auto in_table = std::ranges::find(issues, found.finding.issue);
            return std::pair(found.sector, in_table - issues.begin());
        };
        std::ranges::stable_sort(found_, {}, order);
        return std::move(found_);
    }

  private:
    std::vector<RegionFinding> found_;
};

}  // namespace drtv
