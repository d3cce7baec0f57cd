#include "tests/farm/books.h"

namespace drtv::farm {
namespace {

class ResultCacheTest : public BooksTest {
  protected:
    ResultCacheTest() : cache(std::make_unique<ResultCache>(*database, *blobs, INT64_MAX)) {}

    void add(map::SectorCoordinate sector, const std::string& file,
             const std::string& inventory = "inventory") {
        worker::SectorResult result = this->result(file);
        result.blobs.inventory = put(inventory);
        write([&](Connection& connection) {
            insert_result(connection, {0, sector, digest_of("settings"), result});
        });
        cache->added(result);
    }
    CacheEntry find(map::SectorCoordinate sector, const std::string& inventory = "inventory",
                    float tolerance = 0) {
        CachePin pin(*cache);
        const CacheQuery query{digest_of("settings"), digest_of(inventory), tolerance};
        return cache->find(std::vector{sector}, query, pin).value().at(0);
    }
    void use(const ResultRow& row, const std::string& inventory, float bound) {
        write([&](Connection& connection) { use_result(connection, {row.id, digest_of(inventory), bound}); });
    }

    std::unique_ptr<ResultCache> cache;
};

TEST_F(ResultCacheTest, AResultHoldsForTheMapOfWhichItWasBaked) {
    add({1, -2}, "a");
    const CacheEntry entry = find({1, -2});
    ASSERT_TRUE(entry.held);
    EXPECT_EQ(entry.held->result.blobs.file, digest_of("a"));
    EXPECT_EQ(entry.held->result.warnings, result("a").warnings);
    EXPECT_EQ(entry.held->result.numbers, result("a").numbers);
    EXPECT_EQ(std::tuple(entry.held->result.file_bytes, entry.held->result.footprint_bytes,
                         entry.held->result.seconds),
              std::tuple(100, 20, 1.5));
    EXPECT_FALSE(find({1, -1}).held);
    EXPECT_TRUE(find({1, -1}).candidates.empty());
    CachePin pin(*cache);
    const std::vector<map::SectorCoordinate> sectors{{1, -2}};
    EXPECT_FALSE(
        cache->find(sectors, {digest_of("other settings"), digest_of("inventory"), 0}, pin)->at(0).held);
}

TEST_F(ResultCacheTest, OfAnotherMapItIsACandidateUntilItIsKnownToHold) {
    add({0, 0}, "a");
    add({0, 0}, "b", "another");
    const CacheEntry asked = find({0, 0}, "new map");
    EXPECT_FALSE(asked.held);
    ASSERT_EQ(asked.candidates.size(), 2u);
    EXPECT_EQ(asked.candidates[0].result.blobs.file, digest_of("b")) << "the one used last first";
    use(asked.candidates[1], "new map", 0.01f);
    EXPECT_FALSE(find({0, 0}, "new map", 0.005f).held);
    const CacheEntry near = find({0, 0}, "new map", 0.01f);
    ASSERT_TRUE(near.held);
    EXPECT_EQ(std::tuple(near.held->result.blobs.file, near.bound), std::tuple(digest_of("a"), 0.01f));
}

TEST_F(ResultCacheTest, OneThatHoldsIsFoundBehindAnyNumberOfOthers) {
    add({0, 0}, "first");
    for (int n = 0; n < 20; ++n)
        add({0, 0}, std::to_string(n), "map " + std::to_string(n));
    ASSERT_TRUE(find({0, 0}).held);
    EXPECT_EQ(find({0, 0}).held->result.blobs.file, digest_of("first"));
}

TEST_F(ResultCacheTest, WithoutItsFileItIsLost) {
    add({0, 0}, "a");
    blobs->remove(digest_of("a"));
    const CacheEntry entry = find({0, 0});
    EXPECT_FALSE(entry.held);
    EXPECT_TRUE(entry.lost);
}

TEST_F(ResultCacheTest, ARowThatSomebodyElseChangedIsAMissAndIsReported) {
    for (const char* change_of_row :
         {"UPDATE result SET footprint_bytes = 21", "UPDATE result SET file = (SELECT max(file) FROM result)",
          "UPDATE result SET i = 2", "UPDATE result SET bound = 0.5"}) {
        reopen();
        cache = std::make_unique<ResultCache>(*database, *blobs, INT64_MAX);
        write([&](Connection& connection) { connection.execute("DELETE FROM result; DELETE FROM hold"); });
        add({0, 0}, "a");
        ASSERT_TRUE(find({0, 0}).held);
        SQLite::Database(path, SQLite::OPEN_READWRITE).exec(std::string(change_of_row) + ", used = used");
        const std::string at = change_of_row;
        const CacheEntry entry = find({at.find("i = 2") != std::string::npos ? 2 : 0, 0});
        if (at.find("max") != std::string::npos)
            continue;  // the same value: nothing has changed
        EXPECT_FALSE(entry.held) << change_of_row;
        EXPECT_NE(entry.warning.find("damaged"), std::string::npos) << change_of_row;
    }
}

TEST_F(ResultCacheTest, AHoldThatSomebodyElseChangedDoesNotCount) {
    add({0, 0}, "a");
    change("UPDATE hold SET inventory = '" + to_hex(digest_of("other")) + "'");
    EXPECT_FALSE(find({0, 0}, "other").held);
    EXPECT_FALSE(find({0, 0}).held);
    EXPECT_EQ(find({0, 0}, "other").candidates.size(), 1u);
}

TEST_F(ResultCacheTest, ThoseUsedLongestAgoGoFirstWithTheirBlobs) {
    for (int n = 0; n < 10; ++n)
        add({n, 0}, std::to_string(n));
    use(*find({0, 0}).held, "inventory", 0);
    cache = std::make_unique<ResultCache>(*database, *blobs, 600);
    ASSERT_TRUE(cache->open());
    ASSERT_TRUE(cache->keep_to_limit());
    EXPECT_LE(cache->counts()->bytes, 600);
    EXPECT_TRUE(find({0, 0}).held);
    EXPECT_FALSE(find({1, 0}).held);
    EXPECT_FALSE(blobs->has(digest_of("1")));
    EXPECT_FALSE(blobs->has(digest_of("1 footprint")));
    EXPECT_TRUE(blobs->has(digest_of("9")));
    EXPECT_TRUE(blobs->has(digest_of("inventory"))) << "others have it";
    ASSERT_TRUE(cache->clear());
    EXPECT_EQ(cache->counts()->results, 0);
    EXPECT_FALSE(blobs->has(digest_of("inventory")));
}

TEST_F(ResultCacheTest, WhatARunningJobOrAPlanHoldsStays) {
    for (int n = 0; n < 3; ++n)
        add({n, 0}, std::to_string(n));
    const JobRow job = add_job({{0, 0}, {5, 5}});
    write([&](Connection& connection) {
        JobSectorRow row = sector_row(job.id, {0, 0}, SectorState::done);
        row.file = digest_of("0");
        EXPECT_TRUE(record_sector(connection, row));
    });
    {
        CachePin pin(*cache);
        pin.add(digest_of("1"));
        ASSERT_TRUE(cache->clear());
        EXPECT_TRUE(find({0, 0}).held);
        EXPECT_TRUE(find({1, 0}).held);
        EXPECT_FALSE(find({2, 0}).held);
    }
    ASSERT_TRUE(cache->clear());
    EXPECT_FALSE(find({1, 0}).held);
    EXPECT_TRUE(blobs->has(digest_of("0")));
}

TEST_F(ResultCacheTest, CountsAndMeans) {
    EXPECT_EQ(cache->mean_seconds(digest_of("settings")).value(), 0);
    add({0, 0}, "a");
    add({0, 1}, "b");
    write([&](Connection& connection) {
        count_sectors(connection, 3, 2, 1);
        count_sectors(connection, 1, 0, 0);
    });
    const CacheCounts counts = cache->counts().value();
    EXPECT_EQ(std::tuple(counts.results, counts.bytes, counts.hits, counts.near_hits, counts.baked),
              std::tuple(2, 240, 4, 2, 1));
    EXPECT_EQ(cache->mean_seconds(digest_of("settings")).value(), 1.5);
    EXPECT_EQ(cache->mean_seconds(digest_of("never asked for")).value(), 1.5);
}

}  // namespace
}  // namespace drtv::farm
