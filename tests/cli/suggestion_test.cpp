#include "spelling/suggestion.h"

#include <gtest/gtest.h>

namespace drtv::spelling {
namespace {

TEST(EditDistance, CountsLettersLeftOutPutInExchangedAndSwapped) {
    EXPECT_EQ(edit_distance("", ""), 0u);
    EXPECT_EQ(edit_distance("out", "out"), 0u);
    EXPECT_EQ(edit_distance("ot", "out"), 1u);
    EXPECT_EQ(edit_distance("outt", "out"), 1u);
    EXPECT_EQ(edit_distance("oat", "out"), 1u);
    EXPECT_EQ(edit_distance("otu", "out"), 1u);
    EXPECT_EQ(edit_distance("", "out"), 3u);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
    EXPECT_EQ(edit_distance("sitting", "kitten"), 3u);
    EXPECT_EQ(edit_distance("ca", "abc"), 3u);  // of the optimal string alignment; Damerau's is 2
}

TEST(Suggestion, IsTheNearestWordOrNone) {
    const std::vector<std::string> words = {"rays", "bounces", "reach", "min_distance", "lprt", "lprt_rays"};
    EXPECT_EQ(suggestion("ray", words), ". Did you mean \"rays\"?");
    EXPECT_EQ(suggestion("rais", words), ". Did you mean \"rays\"?");
    EXPECT_EQ(suggestion("bonces", words), ". Did you mean \"bounces\"?");
    EXPECT_EQ(suggestion("mindistance", words), ". Did you mean \"min_distance\"?");
    EXPECT_EQ(suggestion("lprt_ray", words), ". Did you mean \"lprt_rays\"?");
    EXPECT_EQ(suggestion("colour", words), "");
    EXPECT_EQ(suggestion("x", words), "");
    EXPECT_EQ(suggestion("", words), "");
    EXPECT_EQ(suggestion("rays", {}), "");
}

}  // namespace
}  // namespace drtv::spelling
