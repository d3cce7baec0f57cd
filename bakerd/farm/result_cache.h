// The results of sectors that are kept, and the maps for which each holds: the only cache, and the only place
// that is asked which results there are. Evicts those used longest ago. Thread-safe.
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

class ResultCache;

// What one plan goes by.
class CachePin {
  public:
    explicit CachePin(ResultCache& cache) : cache_(cache) {}
    ~CachePin();
    CachePin(const CachePin&) = delete;
    CachePin& operator=(const CachePin&) = delete;
    void add(const Digest& file);

  private:
    ResultCache& cache_;
    std::vector<Digest> files_;
};

class ResultCache {
  public:
    // REQUIRES: both outlive it.
    ResultCache(Database& database, store::BlobStore& blobs, std::int64_t max_bytes);

    [[nodiscard]] store::Result<void> open();

    // One entry per sector. What an entry names is not evicted while `pin` lives.
    [[nodiscard]] store::Result<std::vector<CacheEntry>> find(std::span<const map::SectorCoordinate> sectors,
                                                              const CacheQuery& query,
                                                              CachePin& pin);

    // Mean of what sectors took with these settings, or with any when there are none; 0 without results.
    [[nodiscard]] store::Result<double> mean_seconds(const Digest& results_key);

    // Whether the results' blobs are there. They stay until `commit` has been called, which may insert the
    // results.
    template <class Commit>
    [[nodiscard]] store::Result<void> commit_if_there(std::span<const worker::SectorResult* const> results,
                                                      Commit commit) {
        const std::lock_guard lock(files_mutex_);
        for (const worker::SectorResult* result : results) {
            const worker::ResultBlobs& blobs = result->blobs;
            if (!blobs_.has(blobs.file) || !blobs_.has(blobs.footprint) || !blobs_.has(blobs.inventory))
                return store::fail(store::ErrorCode::not_found,
                                   "its file left the store before it was recorded");
        }
        return commit();
    }
    void added(const worker::SectorResult& result) { bytes_ += result.file_bytes + result.footprint_bytes; }

    // A job has ended: what it held may go.
    void job_ended() { needed_bytes_ = 0; }
    // Evicts what is over the limit.
    [[nodiscard]] store::Result<void> keep_to_limit();
    // Evicts all that no running job holds.
    [[nodiscard]] store::Result<void> clear() { return shrink_to(-1); }

    [[nodiscard]] store::Result<CacheCounts> counts();
    [[nodiscard]] std::int64_t max_bytes() const { return max_bytes_; }

  private:
    friend class CachePin;
    void hold_or_candidate(Connection& connection,
                           const Checked<ResultRow>& found,
                           const CacheQuery& query,
                           CacheEntry& entry,
                           CachePin& pin);
    [[nodiscard]] store::Result<void> shrink_to(std::int64_t max_bytes);
    struct Removed {
        std::vector<ResultRow> rows;
        std::size_t pinned = 0;  // that were passed over
    };
    [[nodiscard]] Removed remove_idle(Connection& connection, std::size_t skipped, std::int64_t max_bytes);
    [[nodiscard]] store::Result<void> remove_blobs(const std::vector<ResultRow>& rows);
    [[nodiscard]] bool is_pinned(const Digest& file);

    Database& database_;
    store::BlobStore& blobs_;
    const std::int64_t max_bytes_;
    std::atomic<std::int64_t> bytes_{0};
    std::atomic<std::int64_t> needed_bytes_{0};  // that could not be evicted the last time; 0: it was enough
    std::mutex files_mutex_;  // held while blobs are removed, and while what needs them is recorded
    std::mutex pins_mutex_;
    std::map<Digest, int> pins_;  // guarded by pins_mutex_: files, and how many pins name each
};

}  // namespace drtv::farm
