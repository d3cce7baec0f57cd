// Maps in the database: what is known of each manifest that was imported.
#pragma once

#include "bakerd/farm/database.h"
#include "bakerd/farm/records.h"

#include <optional>

namespace drtv::farm {

void put_map(Connection& connection, const MapRow& map);

// Nothing where there is none, or where it is not as it was written: then it must be imported again.
[[nodiscard]] std::optional<worker::MapSummary> find_map(Connection& connection, const Digest& manifest);

}  // namespace drtv::farm
