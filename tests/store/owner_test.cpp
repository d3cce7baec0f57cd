#include "bakerd/store/owner.h"
#include "tests/store/temporary_folder.h"

#include <gtest/gtest.h>

namespace drtv::store {
namespace {

TEST(ClaimFolder, IsTheFirstOnesForGood) {
    const test::TemporaryFolder folder;
    const std::string store = folder.path() + "/a/b";
    EXPECT_TRUE(claim_folder(store, "one", "/data on farm1", false));
    EXPECT_TRUE(claim_folder(store, "one", "/data on farm1", false));
    const auto refused = claim_folder(store, "two", "/data on farm2", false);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::failed_precondition);
    EXPECT_NE(refused.error().message.find("(/data on farm1)"), std::string::npos) << refused.error().message;
    EXPECT_NE(refused.error().message.find(store + "/owner"), std::string::npos) << refused.error().message;
}

TEST(ClaimFolder, WhatWasOursAndIsEmptyIsNotMounted) {
    const test::TemporaryFolder folder;
    const auto refused = claim_folder(folder.path(), "one", "/data on farm1", true);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("is it mounted?"), std::string::npos) << refused.error().message;
    EXPECT_EQ(test::files_below(folder.path()), 0u);
    EXPECT_TRUE(claim_folder(folder.path(), "one", "/data on farm1", false));
    EXPECT_TRUE(claim_folder(folder.path(), "one", "/data on farm1", true));
}

TEST(ClaimFolder, WhoDiedOverIt) {
    const test::TemporaryFolder folder;
    test::write_file(folder.path() + "/owner", "");
    EXPECT_TRUE(claim_folder(folder.path(), "one", "/data on farm1", false));
    EXPECT_FALSE(claim_folder(folder.path(), "two", "/data on farm1", false));
}

TEST(ClaimFolder, APlaceThatCannotBeWrittenIsASentence) {
    const auto claimed = claim_folder("/proc/drtv", "one", "/data on farm1", false);
    ASSERT_FALSE(claimed);
    EXPECT_NE(claimed.error().message.find("/proc/drtv"), std::string::npos) << claimed.error().message;
}

}  // namespace
}  // namespace drtv::store
