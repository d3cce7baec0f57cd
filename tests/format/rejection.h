// A case of a reader's test: what is wrong, which error, at which byte, and a word of the message.
#pragma once

#include "tests/format/sector_bytes.h"
#include "tests/format/sectors.h"

#include <drtv/read.h>
#include <drtv/validate.h>

#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <limits>

namespace drtv::test {

inline constexpr std::uint32_t nan_bits =
    std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN());
inline constexpr std::uint32_t infinity_bits =
    std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());

// For rules broken at a place that the case has to compute: checked by a test of its own.
inline constexpr std::uint64_t anywhere = UINT64_MAX;

struct Rejection {
    const char* name;
    ReadError error;
    std::uint64_t offset;
    const char* words;
    std::function<Bytes()> file;
};

inline void expect_rejected(const Rejection& rejection) {
    const Bytes file = rejection.file();
    Sector sector = golden_sector();
    const ReadStatus status = read_sector(file, sector);
    EXPECT_EQ(status.error, rejection.error) << status.message;
    if (rejection.offset != anywhere) {
        EXPECT_EQ(status.offset, rejection.offset);
    }
    EXPECT_LE(status.offset, file.size());
    EXPECT_NE(status.message.find(rejection.words), std::string::npos) << status.message;
    EXPECT_EQ(sector, golden_sector()) << "a failed read must leave the sector as it was";
    EXPECT_EQ(validate_sector(file).findings.size(), 1u);
}

}  // namespace drtv::test
