#include "bakerd/farm/schema.h"

#include "bakerd/farm/schema_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace drtv::farm {
namespace {

std::vector<const char*> all_steps() {
    std::vector<const char*> steps;
    std::ranges::copy(schema_steps_0_to_4(), std::back_inserter(steps));
    std::ranges::copy(schema_steps_5_to_8(), std::back_inserter(steps));
    std::ranges::copy(schema_steps_from_9(), std::back_inserter(steps));
    return steps;
}

}  // namespace

store::Result<void> bring_up_to_date(Connection& connection, const std::string& path) {
    const std::vector<const char*> steps = all_steps();
    const auto newest = static_cast<std::int64_t>(steps.size());
    std::int64_t version = connection.raw().execAndGet("PRAGMA user_version").getInt64();
    if (version > newest) {
        return store::fail(
            store::ErrorCode::failed_precondition,
            fmt::format(
                "{} was written by a newer bakerd (schema {}, this one knows {})", path, version, newest));
    }
    for (; version < newest; ++version) {
        SQLite::Transaction transaction(connection.raw(), SQLite::TransactionBehavior::IMMEDIATE);
        connection.execute(steps[static_cast<std::size_t>(version)]);
        connection.execute(fmt::format("PRAGMA user_version={}", version + 1));
        transaction.commit();
    }
    return {};
}

}  // namespace drtv::farm
