#include "bakerd/farm/database.h"

#include "bakerd/farm/row_sum.h"
#include "bakerd/farm/schema.h"
#include "bakerd/map/warning.h"

#include <fmt/format.h>
#include <sqlite3.h>

namespace drtv::farm {
namespace {

bool is_damage(int sqlite_code) {
    return sqlite_code == SQLITE_CORRUPT || sqlite_code == SQLITE_NOTADB;
}

tl::unexpected<store::Error> damaged(const std::string& path, const std::string& how) {
    return store::fail(
        store::ErrorCode::data_loss,
        fmt::format("the database {} is damaged ({}): move it away, and start again without its jobs",
                    path,
                    map::as_sentence(how)));
}

}  // namespace

Connection::Connection(const std::string& path, std::chrono::milliseconds patience)
    : database_(path,
                SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE | SQLite::OPEN_NOMUTEX,
                static_cast<int>(patience.count())) {
    add_row_sum(database_);
}

SQLite::Statement& Connection::statement(const std::string& sql) {
    auto known = statements_.find(sql);
    if (known == statements_.end())
        known = statements_.emplace(sql, std::make_unique<SQLite::Statement>(database_, sql)).first;
    known->second->tryReset();
    known->second->clearBindings();
    return *known->second;
}

void Connection::end_statements() {
    for (const auto& [sql, statement] : statements_)
        statement->tryReset();
}

store::Result<std::unique_ptr<Database>> Database::open(const std::string& path,
                                                        std::chrono::milliseconds patience) {
    try {
        std::unique_ptr<Database> database(new Database(path, patience));
        Connection& connection = database->connection_;
        connection.execute("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON;");
        const std::string damage = connection.raw().execAndGet("PRAGMA quick_check(1)").getString();
        if (damage != "ok")
            return damaged(path, damage);
        if (auto done = bring_up_to_date(connection, path); !done)
            return tl::unexpected(done.error());
        return database;
    } catch (const SQLite::Exception& exception) {
        if (is_damage(exception.getErrorCode()))
            return damaged(path, exception.what());
        return store::fail(store::ErrorCode::internal,
                           fmt::format("cannot open the farm's database {}: {}", path, exception.what()));
    }
}

store::Result<void> Database::write(const std::function<void(Connection&)>& work) {
    const std::lock_guard lock(mutex_);
    const StatementsEnd end(connection_);
    try {
        SQLite::Transaction transaction(connection_.raw(), SQLite::TransactionBehavior::IMMEDIATE);
        work(connection_);
        connection_.end_statements();
        transaction.commit();
        return {};
    } catch (const SQLite::Exception& exception) {
        return error_of(exception);
    }
}

tl::unexpected<store::Error> Database::error_of(const SQLite::Exception& exception) {
    const auto code_of = [](int sqlite) {
        if (sqlite == SQLITE_FULL)
            return store::ErrorCode::resource_exhausted;
        if (is_damage(sqlite))
            return store::ErrorCode::data_loss;
        return store::ErrorCode::internal;
    };
    return store::fail(code_of(exception.getErrorCode()),
                       fmt::format("cannot use the farm's database: {}", exception.what()));
}

}  // namespace drtv::farm
