// The reference's only source of chance.
#pragma once

#include <cstdint>
#include <random>

namespace drtv::reference {

struct Random {
    std::mt19937_64 engine;

    explicit Random(std::uint64_t seed) : engine(seed) {}
    double next() { return static_cast<double>(engine() >> 11) * 0x1p-53; }  // [0, 1)
};

}  // namespace drtv::reference
