// What tasks printed, and who may not be shown it.
#include "bakerd/farm/sector_log.h"
#include "tests/store/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace drtv::farm {
namespace {

class SectorLogTest : public testing::Test {
  protected:
    SectorLogTest() {
        std::filesystem::create_directories(folder.path() + "/logs/drtv-1");
        std::string text;
        for (int n = 0; n < 100; ++n)
            text += "line " + std::to_string(n) + ": sector (" + std::to_string(n % 10) + ", 1): 7 probes\n";
        test::write_file(folder.path() + "/logs/drtv-1/4.log", text + "the last line, cut");
        view.row.sector = {3, 1};
        view.row.state = SectorState::done;
        view.row.origin = SectorOrigin::baked;
        view.row.node = "node2";
        view.row.log = "logs/drtv-1/4.log";
    }
    [[nodiscard]] std::string refusal() const {
        const auto log = read_sector_log(folder.path(), 5, view);
        return log ? "" : log.error().message;
    }

    const test::TemporaryFolder folder;
    JobSectorView view;
};

TEST_F(SectorLogTest, HasTheLinesThatNameTheSector) {
    const auto log = read_sector_log(folder.path(), 5, view);
    ASSERT_TRUE(log) << log.error().message;
    EXPECT_EQ(log->node, "node2");
    EXPECT_EQ(log->file, "logs/drtv-1/4.log");
    ASSERT_EQ(log->lines.size(), 10u);
    EXPECT_EQ(log->lines[0], "line 3: sector (3, 1): 7 probes");
}

TEST_F(SectorLogTest, OfAFailureHasTheEndAsWell) {
    view.row.state = SectorState::failed;
    const auto log = read_sector_log(folder.path(), 5, view);
    ASSERT_TRUE(log);
    EXPECT_EQ(log->lines.size(), 8u + 20u);
    EXPECT_EQ(log->lines.back(), "the last line, cut");
}

TEST_F(SectorLogTest, SaysWhyThereIsNone) {
    view.row.log = "";
    EXPECT_NE(refusal().find("the daemon's own log"), std::string::npos) << refusal();
    view.row.origin = SectorOrigin::hit;
    EXPECT_NE(refusal().find("reused"), std::string::npos) << refusal();
    view.row.state = SectorState::waiting;
    EXPECT_NE(refusal().find("not been baked"), std::string::npos) << refusal();
    view.running = true;
    EXPECT_EQ(refusal(), "sector (3, 1) of job 5 is being baked: it has a log when its task has ended");
}

TEST_F(SectorLogTest, NoOtherFileIsShown) {
    test::write_file(folder.path() + "/secret", "sector (3, 1)");
    for (const char* file : {"secret", "logs/../secret", "/etc/passwd"}) {
        view.row.log = file;
        EXPECT_NE(refusal(), "") << file;
    }
    view.row.log = "logs/gone/1.log";
    EXPECT_NE(refusal().find("logs/gone/1.log"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace drtv::farm
