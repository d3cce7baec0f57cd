#include "bakerd/farm/result_cache.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace drtv::farm {
namespace {

// Of one sector: branches of a map, and steps back.
constexpr std::size_t max_candidates = 8;

// Rows that are handled in one go while others wait.
constexpr std::size_t portion = 256;

}  // namespace

ResultCache::ResultCache(Database& database, store::BlobStore& blobs, std::int64_t max_bytes)
    : database_(database), blobs_(blobs), max_bytes_(max_bytes) {}

store::Result<void> ResultCache::open() {
    const auto kept = counts();
    if (!kept)
        return tl::unexpected(kept.error());
    bytes_ = kept->bytes;
    return {};
}

store::Result<std::vector<CacheEntry>> ResultCache::find(std::span<const map::SectorCoordinate> sectors,
                                                         const CacheQuery& query,
                                                         CachePin& pin) {
    std::vector<CacheEntry> entries;
    const auto find_one = [&](Connection& connection, map::SectorCoordinate sector) {
        CacheEntry& entry = entries.emplace_back();
        for (const Checked<ResultRow>& row :
             results_that_hold(connection, sector, query.results_key, query.inventory)) {
            if (!entry.held)
                hold_or_candidate(connection, row, query, entry, pin);
        }
        if (entry.held)
            return;
        entry.candidates.clear();
        for_each_result(
            connection, sector, query.results_key, max_candidates, [&](const Checked<ResultRow>& row) {
                hold_or_candidate(connection, row, query, entry, pin);
                return !entry.held;
            });
    };
    // In portions, so that others are answered meanwhile.
    while (entries.size() < sectors.size()) {
        const std::size_t end = std::min(entries.size() + portion, sectors.size());
        const auto read = database_.read([&](Connection& connection) {
            while (entries.size() < end)
                find_one(connection, sectors[entries.size()]);
            return true;
        });
        if (!read)
            return tl::unexpected(read.error());
    }
    return entries;
}

void ResultCache::hold_or_candidate(Connection& connection,
                                    const Checked<ResultRow>& found,
                                    const CacheQuery& query,
                                    CacheEntry& entry,
                                    CachePin& pin) {
    const ResultRow& row = found.row;
    if (!found.sound) {
        entry.warning = fmt::format(
            "sector ({}, {}): the row of an earlier result is damaged", row.sector.i, row.sector.j);
        return;
    }
    if (!blobs_.has(row.result.blobs.file)) {
        entry.lost = true;
        return;
    }
    pin.add(row.result.blobs.file);
    const std::optional<HoldRow> hold = find_hold(connection, row.id, query.inventory);
    if (hold && hold->bound <= query.tolerance) {
        entry.held = row;
        entry.bound = hold->bound;
        entry.candidates.clear();
    } else {
        entry.candidates.push_back(row);
    }
}

store::Result<double> ResultCache::mean_seconds(const Digest& results_key) {
    return database_.read(
        [&](Connection& connection) { return farm::mean_seconds(connection, results_key); });
}

store::Result<void> ResultCache::keep_to_limit() {
    // What is needed may be over the limit: then not every sector looks for room again.
    if (bytes_ <= max_bytes_ || bytes_ <= needed_bytes_ + needed_bytes_ / 10)
        return {};
    // Some more than needed, so that not every sector has to wait for this.
    auto done = shrink_to(max_bytes_ / 10 * 9);
    needed_bytes_ = bytes_ > max_bytes_ ? bytes_.load() : 0;
    return done;
}

store::Result<void> ResultCache::shrink_to(std::int64_t max_bytes) {
    const std::lock_guard lock(files_mutex_);
    std::size_t removed = 0;
    std::size_t pinned = 0;
    while (bytes_ > max_bytes) {
        Removed portion_removed;
        const auto done = database_.write(
            [&](Connection& connection) { portion_removed = remove_idle(connection, pinned, max_bytes); });
        if (!done)
            return done;
        if (portion_removed.rows.empty() && portion_removed.pinned == 0)
            break;  // what is left is needed
        pinned += portion_removed.pinned;
        removed += portion_removed.rows.size();
        // The files after the rows: a row without its file would be a result that is lost.
        if (auto gone = remove_blobs(portion_removed.rows); !gone)
            return gone;
        const auto left = counts();
        if (!left)
            return tl::unexpected(left.error());
        bytes_ = left->bytes;
    }
    if (removed > 0)
        spdlog::info("{} results left the cache, {} bytes are in it", removed, bytes_.load());
    return {};
}

// Those used longest ago, without any that a job holds.
ResultCache::Removed ResultCache::remove_idle(Connection& connection,
                                              std::size_t skipped,
                                              std::int64_t max_bytes) {
    Removed removed;
    std::int64_t left = bytes_;
    for (Checked<ResultRow>& found : idle_results(connection, skipped, portion)) {
        const worker::SectorResult& result = found.row.result;
        if (left <= max_bytes)
            break;
        if (is_pinned(result.blobs.file)) {
            ++removed.pinned;
            continue;
        }
        left -= result.file_bytes + result.footprint_bytes;
        remove_result(connection, found.row.id);
        // What a damaged row says of its blobs may be of others.
        if (!found.sound)
            found.row.result.blobs = {};
        removed.rows.push_back(std::move(found.row));
    }
    return removed;
}

store::Result<void> ResultCache::remove_blobs(const std::vector<ResultRow>& rows) {
    std::vector<Digest> blobs;
    for (const ResultRow& row : rows) {
        const worker::ResultBlobs& of_row = row.result.blobs;
        blobs.insert(blobs.end(), {of_row.file, of_row.footprint, of_row.inventory});
    }
    std::ranges::sort(blobs);
    const auto again = std::ranges::unique(blobs);
    blobs.erase(again.begin(), again.end());
    for (const Digest& blob : blobs) {
        const auto needed =
            database_.read([&](Connection& connection) { return is_needed(connection, blob); });
        if (!needed)
            return tl::unexpected(needed.error());
        if (!*needed)
            blobs_.remove(blob);
    }
    return {};
}

store::Result<CacheCounts> ResultCache::counts() {
    return database_.read(count_results);
}

bool ResultCache::is_pinned(const Digest& file) {
    const std::lock_guard lock(pins_mutex_);
    return pins_.contains(file);
}

void CachePin::add(const Digest& file) {
    const std::lock_guard lock(cache_.pins_mutex_);
    ++cache_.pins_[file];
    files_.push_back(file);
}

CachePin::~CachePin() {
    const std::lock_guard lock(cache_.pins_mutex_);
    for (const Digest& file : files_) {
        const auto pin = cache_.pins_.find(file);
        if (--pin->second == 0)
            cache_.pins_.erase(pin);
    }
}

}  // namespace drtv::farm
