// The results of sectors that are kept, and the maps for which each holds: the only cache, and the only place
// that is asked whether a sector has to be baked. Evicts those used longest ago. Thread-safe.
#pragma once

#include "bakerd/farm/database.h"
#include "bakerd/farm/records.h"
#include "bakerd/farm/result_table.h"
#include "bakerd/store/blob_store.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drtv::farm {

// What results are asked for.
struct CacheQuery {
    Digest results_key;  // reuse::results_key
    Digest inventory;    // of the map
    float tolerance = 0;
};

// What is known of one sector.
struct CacheEntry {
    std::optional<ResultRow> held;      // known to hold for the map
    float bound = 0;                    // of `held`
    std::vector<ResultRow> candidates;  // of other maps, which may hold; the one used last first
    std::string warning;                // of rows that are not as they were written
    bool lost = false;                  // there were some, and their files are gone
};

class ResultCache {
  public:
    // REQUIRES: both outlive it.
    ResultCache(Database& database, store::BlobStore& blobs, std::int64_t max_bytes);

    [[nodiscard]] store::Result<void> open();

    // One entry per sector. What an entry names is not evicted while `pin` lives.
    class Pin;
    [[nodiscard]] store::Result<std::vector<CacheEntry>> find(std::span<const map::SectorCoordinate> sectors,
                                                              const CacheQuery& query,
                                                              Pin& pin);

    // Mean of what sectors took with these settings, or with any when there are none; 0 without results.
    [[nodiscard]] store::Result<double> mean_seconds(const Digest& results_key);

    // Whether the result's blobs are there. They stay until `commit` has been called, which may insert the
    // result.
    template <class Commit>
    [[nodiscard]] store::Result<void> commit_if_there(const worker::SectorResult& result, Commit commit) {
        const std::lock_guard lock(files_mutex_);
        if (!blobs_.has(result.blobs.file) || !blobs_.has(result.blobs.footprint))
            return store::fail(store::ErrorCode::not_found, "its file left the store before it was recorded");
        return commit();
    }
    void added(const worker::SectorResult& result) { bytes_ += result.file_bytes + result.footprint_bytes; }

    // Evicts what is over the limit.
    [[nodiscard]] store::Result<void> keep_to_limit();
    // Evicts all that no running job holds.
    [[nodiscard]] store::Result<void> clear() { return shrink_to(-1); }

    [[nodiscard]] store::Result<CacheCounts> counts();
    [[nodiscard]] std::int64_t max_bytes() const { return max_bytes_; }

  private:
    void take_in(Connection& connection,
                 const Checked<ResultRow>& found,
                 const CacheQuery& query,
                 CacheEntry& entry,
                 Pin& pin);
    [[nodiscard]] store::Result<void> shrink_to(std::int64_t max_bytes);
    [[nodiscard]] std::vector<ResultRow> remove_idle(Connection& connection, std::int64_t max_bytes);
    [[nodiscard]] store::Result<void> remove_blobs(const std::vector<ResultRow>& rows);
    [[nodiscard]] bool is_pinned(const Digest& file);

    Database& database_;
    store::BlobStore& blobs_;
    const std::int64_t max_bytes_;
    std::atomic<std::int64_t> bytes_{0};
    std::mutex files_mutex_;  // held while blobs are removed, and while what needs them is recorded
    std::mutex pins_mutex_;
    std::map<Digest, int> pins_;  // guarded by pins_mutex_: files, and how many pins name each
};

// What one plan goes by.
class ResultCache::Pin {
  public:
    explicit Pin(ResultCache& cache) : cache_(cache) {}
    ~Pin();
    Pin(const Pin&) = delete;
    Pin& operator=(const Pin&) = delete;
    void add(const Digest& file);

  private:
    ResultCache& cache_;
    std::vector<Digest> files_;
};

}  // namespace drtv::farm
