#include "bakerd/farm/row_sum.h"

#include "bakerd/map/digest.h"

#include <sqlite3.h>

#include <cstdint>
#include <cstring>
#include <string_view>

namespace drtv::farm {
namespace {

void add_value(map::Hasher& hasher, sqlite3_value* value) {
    const int type = sqlite3_value_type(value);
    hasher.add(static_cast<std::int32_t>(type));
    if (type == SQLITE_INTEGER)
        hasher.add(static_cast<std::int64_t>(sqlite3_value_int64(value)));
    // The database keeps no negative zero.
    if (type == SQLITE_FLOAT)
        hasher.add(sqlite3_value_double(value) + 0.0);
    if (type == SQLITE_TEXT || type == SQLITE_BLOB) {
        const auto* bytes = static_cast<const char*>(sqlite3_value_blob(value));
        const auto size = static_cast<std::size_t>(sqlite3_value_bytes(value));
        hasher.add_sized(bytes == nullptr ? std::string_view() : std::string_view(bytes, size));
    }
}

void row_sum(sqlite3_context* context, int count, sqlite3_value** values) {
    map::Hasher hasher;
    for (int n = 0; n < count; ++n)
        add_value(hasher, values[n]);
    const map::Digest digest = hasher.finish();
    std::int64_t sum = 0;
    std::memcpy(&sum, digest.bytes.data(), sizeof sum);
    sqlite3_result_int64(context, sum & INT64_MAX);
}

}  // namespace

void add_row_sum(SQLite::Database& database) {
    database.createFunction("row_sum", -1, true, nullptr, row_sum, nullptr, nullptr, nullptr);
}

}  // namespace drtv::farm
