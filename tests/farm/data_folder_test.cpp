#include "bakerd/farm/data_folder.h"
#include "tests/store/temporary_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace drtv::farm {
namespace {

TEST(DataFolder, IsMadeWhenMissing) {
    const test::TemporaryFolder folder;
    const auto locked = DataFolder::lock(folder.path() + "/a/b");
    ASSERT_TRUE(locked) << locked.error().message;
    EXPECT_EQ((*locked)->path(), folder.path() + "/a/b");
}

TEST(DataFolder, ASecondLockIsRefusedAndNamesTheProcess) {
    const test::TemporaryFolder folder;
    {
        const auto first = DataFolder::lock(folder.path());
        ASSERT_TRUE(first);
        for (int n = 0; n < 2; ++n) {  // a refused one must not free the lock
            const auto second = DataFolder::lock(folder.path());
            ASSERT_FALSE(second);
            EXPECT_EQ(second.error().code, store::ErrorCode::failed_precondition);
            EXPECT_NE(second.error().message.find("(process " + std::to_string(::getpid()) + ")"),
                      std::string::npos)
                << second.error().message;
        }
    }
    EXPECT_TRUE(DataFolder::lock(folder.path()));
}

TEST(DataFolder, AFormerOwnersLongerNumberIsGone) {
    const test::TemporaryFolder folder;
    test::write_file(folder.path() + "/lock", "123456789012345");
    const auto first = DataFolder::lock(folder.path());
    const auto second = DataFolder::lock(folder.path());
    EXPECT_NE(second.error().message.find("(process " + std::to_string(::getpid()) + ")"), std::string::npos)
        << second.error().message;
}

TEST(DataFolder, ItsIdStays) {
    const test::TemporaryFolder one, other;
    const std::string id = DataFolder::lock(one.path()).value()->id().value();
    EXPECT_EQ(id.size(), 16u);
    EXPECT_EQ(DataFolder::lock(one.path()).value()->id(), id);
    EXPECT_NE(DataFolder::lock(other.path()).value()->id(), id);
}

// No such file system can be mounted here: the numbers are those of statfs(2).
TEST(DataFolder, FileSystemsOverANetworkAreKnown) {
    EXPECT_EQ(network_file_system(0x6969), "NFS");
    EXPECT_EQ(network_file_system(0xFF534D42), "SMB");
    EXPECT_EQ(network_file_system(0x0BD00BD0), "Lustre");
    EXPECT_EQ(network_file_system(0x00C36400), "Ceph");
    EXPECT_EQ(network_file_system(0xEF53), "");      // ext4
    EXPECT_EQ(network_file_system(0x01021994), "");  // tmpfs
}

TEST(DataFolder, APlaceThatCannotBeWrittenIsASentence) {
    const test::TemporaryFolder folder;
    test::write_file(folder.path() + "/file", "");
    for (const std::string& path :
         {folder.path() + "/file", folder.path() + "/file/below", std::string("/proc/drtv")}) {
        const auto locked = DataFolder::lock(path);
        ASSERT_FALSE(locked) << path;
        EXPECT_NE(locked.error().message.find(path), std::string::npos) << locked.error().message;
    }
}

}  // namespace
}  // namespace drtv::farm
