// What people read of settings is what the table says.
#include "settings/table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace drtv::settings {
namespace {

std::string text_of_file(const std::string& path) {
    std::ifstream file(std::string(DRTV_SOURCE_DIR "/") + path);
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_FALSE(text.str().empty()) << path;
    return text.str();
}

std::string range_of(const Setting& setting) {
    return fmt::format("{} to {}", text_of(setting.min), text_of(setting.max));
}

std::string row_of(const Setting& setting) {
    const std::string unit = setting.unit.empty() ? "" : " " + std::string(setting.unit);
    std::string row =
        fmt::format("| `{}` | {} | {}{} |", setting.name, setting.help, range_of(setting), unit);
    for (const double value : setting.defaults)
        row += fmt::format(" {} |", short_text(value));
    return row;
}

TEST(SettingsDocuments, ReadmesTableHasARowForEach) {
    const std::string readme = text_of_file("README.md");
    std::string rows = "|---|---|---|---|---|---|\n";
    for (const Setting& setting : table())
        rows += row_of(setting) + "\n";
    // All of the table: no row is left over.
    EXPECT_NE(readme.find("| `--set` | what | range | draft | console | pc |\n" + rows + "\n"),
              std::string::npos)
        << rows;
}

// The comment above a field names its range.
TEST(SettingsDocuments, TheContractNamesEachRange) {
    const std::string proto = text_of_file("proto/drtv/v1/job.proto");
    for (const Setting& setting : table()) {
        const std::size_t field = proto.find(fmt::format(" {} = ", setting.name));
        ASSERT_NE(field, std::string::npos) << setting.name;
        const std::size_t comment = proto.rfind(";\n", field);
        ASSERT_NE(comment, std::string::npos);
        const bool is_bool = is_integer(setting) && setting.max == 1;
        const std::string text = proto.substr(comment, field - comment);
        const bool names_range = text.find(" " + range_of(setting) + ".") != std::string::npos ||
                                 text.find(" " + range_of(setting) + ";") != std::string::npos;
        EXPECT_TRUE(is_bool || names_range) << setting.name << ": " << text;
    }
}

}  // namespace
}  // namespace drtv::settings
