// How a file of one schema becomes one of the next, in SQL. A step that has left this house is never changed:
// a new one is added at the end, with a file of the schema before it for the tests (tests/farm/schemas).
#pragma once

#include <array>

namespace drtv::farm {

// Step n takes a file of schema n to n + 1.
[[nodiscard]] std::array<const char*, 5> schema_steps_0_to_4();
[[nodiscard]] std::array<const char*, 4> schema_steps_5_to_8();
[[nodiscard]] std::array<const char*, 1> schema_steps_from_9();

}  // namespace drtv::farm
