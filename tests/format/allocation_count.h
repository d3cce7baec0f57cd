// How often the test program has asked for memory.
#pragma once

#include <cstddef>

namespace drtv::test {

[[nodiscard]] std::size_t allocation_count();

}  // namespace drtv::test
