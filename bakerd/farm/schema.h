// The tables of the farm's database, and how files of earlier versions become those of today.
#pragma once

#include "bakerd/farm/database.h"
#include "bakerd/store/error.h"

#include <string>

namespace drtv::farm {

// Takes a file of any earlier version, or an empty one, to today's, step by step. Each step is one
// transaction, so that a file is always of one version. failed_precondition: it is of a newer one.
[[nodiscard]] store::Result<void> bring_up_to_date(Connection& connection, const std::string& path);

}  // namespace drtv::farm
