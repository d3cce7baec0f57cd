// What changed between two maps, and what that does to a sector, in words for people.
#pragma once

#include "bakerd/reuse/assessment.h"
#include "bakerd/reuse/inventory.h"

#include <span>
#include <string>

namespace drtv::reuse {

// "palm_017 moved".
[[nodiscard]] std::string describe(const Change& change);

// "palm_017 moved: rays cross sector (12, 7), bound 0.8 %"; nothing of a hit. `changes` are those that were
// assessed.
[[nodiscard]] std::string describe(const Assessment& assessment, std::span<const Change> changes);

// That part of it which other sectors share: "palm_017 moved".
[[nodiscard]] std::string describe_cause(const Assessment& assessment, std::span<const Change> changes);

}  // namespace drtv::reuse
