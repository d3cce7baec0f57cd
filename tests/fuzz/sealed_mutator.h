// Mutants of a sector file whose checksums are right, so that what lies behind them is reached. Include once
// a target.
#pragma once

#include "tests/format/sector_bytes.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

// Every eighth stays as it is.
extern "C" inline std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                      std::size_t max_size, unsigned int seed) {
    using namespace drtv::test;
    size = LLVMFuzzerMutate(data, size, max_size);
    const bool is_sector = size >= at::table && std::memcmp(data, "DRTV", 4) == 0;
    if (seed % 8 == 0 || !is_sector)
        return size;
    Edit edit(Bytes(data, data + size));
    if (seed % 8 < 5)
        edit.u32(at::file_bytes, size);
    const Bytes sealed = edit.sealed();
    std::copy(sealed.begin(), sealed.end(), data);
    return size;
}
