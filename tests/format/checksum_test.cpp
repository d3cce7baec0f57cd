#include "format/src/checksum.h"

#include <gtest/gtest.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <random>
#include <vector>

namespace drtv {
namespace {

std::vector<std::uint8_t> random_bytes(std::size_t size) {
    std::mt19937 random(7);
    std::vector<std::uint8_t> bytes(size);
    for (std::uint8_t& byte : bytes)
        byte = static_cast<std::uint8_t>(random());
    return bytes;
}

TEST(Checksum, NothingHasTheValueOfTheSpecification) {
    EXPECT_EQ(xxh64({}), 0xEF46DB3751D8E999u);
}

TEST(Checksum, EveryLengthAgreesWithLibxxhash) {
    const std::vector<std::uint8_t> bytes = random_bytes(600);
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
        ASSERT_EQ(xxh64(std::span(bytes).first(size)), XXH64(bytes.data(), size, 0)) << size << " bytes";
    }
}

TEST(Checksum, LongInputAgreesWithLibxxhash) {
    const std::vector<std::uint8_t> bytes = random_bytes(1'000'003);
    EXPECT_EQ(xxh64(bytes), XXH64(bytes.data(), bytes.size(), 0));
}

TEST(Checksum, UnalignedInputAgreesWithLibxxhash) {
    const std::vector<std::uint8_t> bytes = random_bytes(200);
    for (std::size_t start = 0; start < 16; ++start) {
        EXPECT_EQ(xxh64(std::span(bytes).subspan(start)),
                  XXH64(bytes.data() + start, bytes.size() - start, 0))
            << start;
    }
}

}  // namespace
}  // namespace drtv
