#include "cli/exit_code.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

namespace drtv::cli {
namespace {

std::string row_of(const ExitMeaning& meaning) {
    const auto mark = [](bool yes) { return yes ? " x |" : " |"; };
    return "| " + std::to_string(meaning.code) + " | " + std::string(meaning.meaning) + " |" +
           mark(meaning.drtv) + mark(meaning.bake) + mark(meaning.bakerd);
}

TEST(ExitCodes, EachStandsOnceAndHasAProgram) {
    std::set<int> codes;
    for (const ExitMeaning& meaning : exit_meanings()) {
        EXPECT_TRUE(codes.insert(meaning.code).second) << meaning.code;
        EXPECT_TRUE(meaning.drtv || meaning.bake || meaning.bakerd) << meaning.code;
    }
    EXPECT_EQ(codes, (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 130}));
}

TEST(ExitCodes, ThePageHasTheTable) {
    std::ifstream file(DRTV_SOURCE_DIR "/docs/exit-codes.md");
    std::ostringstream text;
    text << file.rdbuf();
    for (const ExitMeaning& meaning : exit_meanings())
        EXPECT_NE(text.str().find("\n" + row_of(meaning) + "\n"), std::string::npos) << row_of(meaning);
}

TEST(ExitCodes, HelpListsThoseOfTheProgram) {
    EXPECT_NE(exit_code_help("drtv").find("\n  4    diff found a difference\n"), std::string::npos);
    EXPECT_EQ(exit_code_help("drtv").find("\n  5 "), std::string::npos);
    EXPECT_NE(exit_code_help("bake").find("\n  5    the job failed\n"), std::string::npos);
    EXPECT_EQ(exit_code_help("bakerd").find("\n  8 "), std::string::npos);
}

}  // namespace
}  // namespace drtv::cli
