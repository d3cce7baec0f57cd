#include "bakerd/store/blob_store.h"
#include "bakerd/store/sweep.h"
#include "bakerd/store/temporary_name.h"
#include "tests/store/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

namespace drtv::store {
namespace {

namespace fs = std::filesystem;
using test::bytes_of, test::noise, test::files_below;
using Bytes = std::vector<std::uint8_t>;

std::span<const std::uint8_t> part(const Bytes& bytes, std::size_t first, std::size_t end) {
    return std::span(bytes).subspan(first, end - first);
}

class BlobStoreTest : public testing::Test {
  protected:
    BlobStoreTest() : store(std::move(*BlobStore::open(folder.path()))) {}

    [[nodiscard]] std::string object(const Digest& digest) const {
        return folder.path() + "/objects/" + to_hex(digest).substr(0, 2) + "/" + to_hex(digest);
    }
    [[nodiscard]] std::size_t temporaries() const { return files_below(folder.path() + "/tmp"); }
    [[nodiscard]] std::size_t parts() const { return files_below(folder.path() + "/uploads"); }

    test::TemporaryFolder folder;
    std::unique_ptr<BlobStore> store;
};

TEST_F(BlobStoreTest, WhatWasPutIsGot) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{300000}}) {
        const Bytes bytes = noise(size, 1);
        const auto digest = store->put(bytes);
        ASSERT_TRUE(digest) << digest.error().message;
        EXPECT_EQ(*digest, map::digest_of(bytes));
        EXPECT_TRUE(store->has(*digest));
        EXPECT_EQ(store->get(*digest).value(), bytes);
        EXPECT_EQ(store->put(bytes).value(), *digest);
    }
    EXPECT_EQ(temporaries(), 0u);
    EXPECT_EQ(files_below(folder.path()), 3u);
}

TEST_F(BlobStoreTest, AnUnknownBlobIsNotFound) {
    const Digest digest = map::digest_of(bytes_of("nowhere"));
    EXPECT_FALSE(store->has(digest));
    const auto got = store->get(digest);
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().code, ErrorCode::not_found);
    EXPECT_NE(got.error().message.find(to_hex(digest)), std::string::npos) << got.error().message;
}

TEST_F(BlobStoreTest, AnUnreadableBlobIsNotCalledMissing) {
    const Digest digest = store->put(bytes_of("a")).value();
    fs::remove(object(digest));
    fs::create_directory(object(digest));
    const auto got = store->get(digest);
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().code, ErrorCode::unavailable) << got.error().message;
}

TEST_F(BlobStoreTest, ADamagedBlobIsRemovedAndReported) {
    for (const char* damage : {"axc", "ab", "abcd", ""}) {
        const Digest digest = store->put(bytes_of("abc")).value();
        test::write_file(object(digest), damage);
        const auto got = store->get(digest);
        ASSERT_FALSE(got) << damage;
        EXPECT_EQ(got.error().code, ErrorCode::data_loss);
        EXPECT_FALSE(store->has(digest));
    }
    EXPECT_TRUE(store->put(bytes_of("abc")));
}

// As this machine's names begin.
std::string this_host() {
    const std::string name = temporary_name();
    return name.substr(0, name.find('.' + std::to_string(::getpid()) + '.'));
}

TEST_F(BlobStoreTest, ADeadProcessesTemporaryIsNoObstacle) {
    // The same number may come again after a restart; the names count from anywhere.
    for (int n = 0; n < 200; ++n)
        test::write_file(fmt::format("{}/tmp/{}.{}.{}", folder.path(), this_host(), ::getpid(), n),
                         "left behind");
    EXPECT_TRUE(store->put(bytes_of("new")));
    EXPECT_TRUE(store->has(map::digest_of(bytes_of("new"))));
}

TEST_F(BlobStoreTest, LeftoversGoAndWhatOthersAreWritingStays) {
    const pid_t dead = ::fork();
    if (dead == 0)
        ::_exit(0);
    ASSERT_EQ(::waitpid(dead, nullptr, 0), dead);
    const auto temporary = [&](const std::string& host, pid_t pid) {
        const std::string path = fmt::format("{}/tmp/{}.{}.0", folder.path(), host, pid);
        test::write_file(path, "half");
        return path;
    };
    const std::string of_the_dead = temporary(this_host(), dead), of_the_living = temporary(this_host(), 1);
    // A container of that name has other numbers.
    const std::string elsewhere = temporary(this_host() + "2", dead), old = temporary("far", 1);
    fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(25));
    store->remove_leftovers();
    EXPECT_FALSE(fs::exists(of_the_dead));
    EXPECT_TRUE(fs::exists(of_the_living));
    EXPECT_TRUE(fs::exists(elsewhere));
    EXPECT_FALSE(fs::exists(old));
    EXPECT_EQ(temporaries(), 2u);
}

// As on a store that is not reached: a path that cannot be followed to its end.
TEST_F(BlobStoreTest, WhatCannotBeReadMayBeThere) {
    const Digest digest = store->put(bytes_of("blob")).value();
    const std::string part = folder.path() + "/objects/" + to_hex(digest).substr(0, 2);
    fs::remove_all(part);
    EXPECT_FALSE(store->has(digest));
    EXPECT_EQ(store->get(digest).error().code, ErrorCode::not_found);
    fs::create_symlink(part, part);
    EXPECT_TRUE(store->has(digest));
    EXPECT_EQ(store->get(digest).error().code, ErrorCode::unavailable);
    EXPECT_NE(store->get(digest).error().message.find(part), std::string::npos);
}

TEST(Sweep, OldFilesGoAtAnyDepth) {
    const test::TemporaryFolder folder;
    for (const char* part : {"/a", "/b", "/tmp"})
        fs::create_directories(folder.path() + part);
    const auto aged = [&](const std::string& name, std::chrono::hours age) {
        test::write_file(folder.path() + name, "x");
        fs::last_write_time(folder.path() + name, fs::file_time_type::clock::now() - age);
    };
    aged("/a/old", std::chrono::hours(30));
    aged("/b/old", std::chrono::hours(30));
    aged("/b/new", std::chrono::hours(20));
    aged("/tmp/old", std::chrono::hours(30));
    fs::last_write_time(folder.path() + "/a", fs::file_time_type::clock::now() - std::chrono::hours(30));
    remove_old_files(folder.path(), std::chrono::hours(25));
    EXPECT_FALSE(fs::exists(folder.path() + "/a/old"));
    EXPECT_FALSE(fs::exists(folder.path() + "/b/old"));
    EXPECT_TRUE(fs::exists(folder.path() + "/b/new"));
    EXPECT_TRUE(fs::exists(folder.path() + "/tmp/old"));
    EXPECT_EQ(test::files_below(folder.path()), 2u);
    remove_old_files(folder.path() + "/nowhere", std::chrono::hours(25));
}

TEST_F(BlobStoreTest, ManyThreadsPutTheSameBlobs) {
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&] {
            for (std::uint32_t n = 0; n < 20; ++n)
                EXPECT_TRUE(store->put(noise(5000, n)));
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    for (std::uint32_t n = 0; n < 20; ++n)
        EXPECT_EQ(store->get(map::digest_of(noise(5000, n))).value(), noise(5000, n));
    EXPECT_EQ(temporaries(), 0u);
}

TEST_F(BlobStoreTest, AnUploadInPiecesBecomesABlobAtItsEnd) {
    const Bytes bytes = noise(10000, 3);
    const Digest digest = map::digest_of(bytes);
    auto upload = store->upload(digest, 10000, 0);
    ASSERT_TRUE(upload);
    for (std::size_t at = 0; at < bytes.size(); at += 1000)
        ASSERT_TRUE(upload->append(part(bytes, at, at + 1000)));
    EXPECT_FALSE(store->has(digest));
    ASSERT_TRUE(upload->finish());
    EXPECT_EQ(store->get(digest).value(), bytes);
    EXPECT_EQ(parts(), 0u);
}

TEST_F(BlobStoreTest, ADroppedUploadGoesOnWhereItStopped) {
    const Bytes bytes = noise(9000, 4);
    const Digest digest = map::digest_of(bytes);
    {
        auto upload = store->upload(digest, 9000, 0);
        ASSERT_TRUE(upload->append(part(bytes, 0, 4000)));
        const auto early = upload->finish();  // as when the line broke
        ASSERT_FALSE(early);
        EXPECT_EQ(early.error().code, ErrorCode::invalid_argument);
    }
    EXPECT_EQ(store->received_bytes(digest), 4000);
    store = std::move(*BlobStore::open(folder.path()));  // after a restart, too
    auto upload = store->upload(digest, 9000, 4000);
    ASSERT_TRUE(upload) << upload.error().message;
    ASSERT_TRUE(upload->append(part(bytes, 4000, 9000)));
    ASSERT_TRUE(upload->finish());
    EXPECT_EQ(store->get(digest).value(), bytes);
}

TEST_F(BlobStoreTest, AnOffsetOtherThanWhatWasReceivedIsRefused) {
    const Bytes bytes = noise(100, 5);
    const Digest digest = map::digest_of(bytes);
    EXPECT_EQ(store->upload(digest, 100, 1).error().code, ErrorCode::aborted);
    ASSERT_TRUE(store->upload(digest, 100, 0)->append(part(bytes, 0, 60)));
    for (const std::int64_t offset : {1, 59, 61, 100}) {
        const auto refused = store->upload(digest, 100, offset);
        ASSERT_FALSE(refused) << offset;
        EXPECT_EQ(refused.error().code, ErrorCode::aborted);
        EXPECT_NE(refused.error().message.find("60"), std::string::npos) << refused.error().message;
    }
    // From the start is always possible, and forgets what was there.
    auto upload = store->upload(digest, 100, 0);
    ASSERT_TRUE(upload);
    EXPECT_EQ(store->received_bytes(digest), 0);
    ASSERT_TRUE(upload->append(bytes));
    EXPECT_TRUE(upload->finish());
}

TEST_F(BlobStoreTest, BytesOfAnotherDigestAreThrownAway) {
    const Digest digest = map::digest_of(bytes_of("promised"));
    auto upload = store->upload(digest, 8, 0);
    ASSERT_TRUE(upload->append(bytes_of("deliverd")));
    const auto finished = upload->finish();
    ASSERT_FALSE(finished);
    EXPECT_EQ(finished.error().code, ErrorCode::invalid_argument);
    EXPECT_FALSE(store->has(digest));
    EXPECT_EQ(store->received_bytes(digest), 0);
    EXPECT_EQ(files_below(folder.path()), 0u);
}

TEST_F(BlobStoreTest, AnUploadLongerThanItSaidIsThrownAway) {
    const Digest digest = map::digest_of(bytes_of("12345678"));
    auto upload = store->upload(digest, 8, 0);
    ASSERT_TRUE(upload->append(bytes_of("1234")));
    const auto appended = upload->append(bytes_of("56789"));
    ASSERT_FALSE(appended);
    EXPECT_EQ(appended.error().code, ErrorCode::invalid_argument);
    EXPECT_FALSE(upload->finish());
    EXPECT_EQ(files_below(folder.path()), 0u);
}

TEST_F(BlobStoreTest, OneBlobHasOneUploaderAtATime) {
    const Digest one = map::digest_of(bytes_of("one")), other = map::digest_of(bytes_of("other"));
    {
        const auto first = store->upload(one, 3, 0);
        ASSERT_TRUE(first);
        const auto second = store->upload(one, 3, 0);
        ASSERT_FALSE(second);
        EXPECT_EQ(second.error().code, ErrorCode::aborted);
        EXPECT_TRUE(store->upload(other, 5, 0));
    }
    auto next = store->upload(one, 3, 0);
    ASSERT_TRUE(next);
    auto moved = std::move(*next);  // the lock goes with it
    EXPECT_FALSE(store->upload(one, 3, 0));
    ASSERT_TRUE(moved.append(bytes_of("one")));
    EXPECT_TRUE(moved.finish());
}

TEST_F(BlobStoreTest, UploadsLeaveNoDescriptorOpen) {
    const auto open_files = [] {
        return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
    };
    const auto before = open_files();
    for (std::uint32_t n = 0; n < 20; ++n) {
        const Bytes bytes = noise(10, n);
        auto upload = store->upload(map::digest_of(bytes), 10, 0);
        ASSERT_TRUE(upload);
        if (n % 3 == 0)
            continue;  // dropped
        const auto appended =
            upload->append(n % 3 == 1 ? part(bytes, 0, 10) : std::span<const std::uint8_t>(noise(11, 99)));
        if (appended)
            static_cast<void>(upload->finish());
    }
    EXPECT_EQ(open_files(), before);
}

// 64 KiB of disk.
class FullDiskTest : public testing::Test {
  protected:
    void SetUp() override {
        if (::geteuid() != 0 || ::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=64k") != 0)
            GTEST_SKIP() << "needs to mount a small disk";
        mounted = true;
        store = std::move(*BlobStore::open(folder.path()));
    }
    void TearDown() override {
        store.reset();
        if (mounted) {
            EXPECT_EQ(::umount(folder.path().c_str()), 0);
        }
    }

    test::TemporaryFolder folder;
    std::unique_ptr<BlobStore> store;
    bool mounted = false;
};

TEST_F(FullDiskTest, PutSaysSoAndLeavesNothing) {
    const Bytes bytes = noise(200000, 1);
    const auto put = store->put(bytes);
    ASSERT_FALSE(put);
    EXPECT_EQ(put.error().code, ErrorCode::resource_exhausted);
    EXPECT_NE(put.error().message.find("No space left"), std::string::npos) << put.error().message;
    EXPECT_FALSE(store->has(map::digest_of(bytes)));
    EXPECT_EQ(files_below(folder.path()), 0u);
    EXPECT_TRUE(store->put(noise(1000, 2)));  // there is room for smaller ones
}

TEST_F(FullDiskTest, AnUploadSaysSoAndGoesOnWhenThereIsRoom) {
    const Bytes ballast = noise(40000, 1), bytes = noise(30000, 2);
    const Digest ballast_digest = store->put(ballast).value(), digest = map::digest_of(bytes);
    {
        auto upload = store->upload(digest, 30000, 0);
        ASSERT_TRUE(upload);
        const auto appended = upload->append(bytes);
        ASSERT_FALSE(appended);
        EXPECT_EQ(appended.error().code, ErrorCode::resource_exhausted);
    }
    EXPECT_FALSE(store->has(digest));
    fs::remove(folder.path() + "/objects/" + to_hex(ballast_digest).substr(0, 2) + "/" +
               to_hex(ballast_digest));
    const std::int64_t received = store->received_bytes(digest);
    auto upload = store->upload(digest, 30000, received);
    ASSERT_TRUE(upload);
    ASSERT_TRUE(upload->append(part(bytes, static_cast<std::size_t>(received), 30000)));
    ASSERT_TRUE(upload->finish());
    EXPECT_EQ(store->get(digest).value(), bytes);
}

}  // namespace
}  // namespace drtv::store
