// Results and the maps for which each holds, in the database. For the cache, and for the transactions that
// write jobs.
#pragma once

#include "bakerd/farm/database.h"
#include "bakerd/farm/records.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace drtv::farm {

// A new result, and that it holds for the map of which it was baked. It counts as the one used last.
void insert_result(Connection& connection, const ResultRow& row);
// That a job uses a result, which holds for its map.
void use_result(Connection& connection, const HoldRow& hold);
void count_sectors(Connection& connection, std::int64_t hits, std::int64_t near_hits, std::int64_t baked);

// The results of a sector that are known to hold for the map.
[[nodiscard]] std::vector<Checked<ResultRow>> results_that_hold(Connection& connection,
                                                                map::SectorCoordinate sector,
                                                                const Digest& results_key,
                                                                const Digest& inventory);

// Visits the results of a sector, the one used last first, as long as `visit` gives true.
void for_each_result(Connection& connection,
                     map::SectorCoordinate sector,
                     const Digest& results_key,
                     std::size_t max,
                     const std::function<bool(const Checked<ResultRow>&)>& visit);
// Whether the result is known to hold for the map.
[[nodiscard]] std::optional<HoldRow> find_hold(Connection& connection,
                                               std::int64_t result,
                                               const Digest& inventory);

// Those used longest ago, without any that a running job holds; behind the first `skipped`.
[[nodiscard]] std::vector<Checked<ResultRow>> idle_results(Connection& connection,
                                                           std::size_t skipped,
                                                           std::size_t max);
void remove_result(Connection& connection, std::int64_t id);
// Whether a result or a running job has the blob as its file, footprint or inventory.
[[nodiscard]] bool is_needed(Connection& connection, const Digest& blob);

// Mean of what sectors took with these settings, or with any when there are none; 0 without results.
[[nodiscard]] double mean_seconds(Connection& connection, const Digest& results_key);
[[nodiscard]] CacheCounts count_results(Connection& connection);

}  // namespace drtv::farm
