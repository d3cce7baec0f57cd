// The SQL function row_sum(...): 63 bits of SHA-256 over the values it is given, and over their types.
#pragma once

#include <SQLiteCpp/Database.h>

namespace drtv::farm {

void add_row_sum(SQLite::Database& database);

}  // namespace drtv::farm
