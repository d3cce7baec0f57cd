// The farm's state in one SQLite file (WAL, synchronous FULL), and the one connection to it. Losing the file
// loses jobs, never correctness: it can be rebuilt by submitting again. Tables stand in job_table, map_table,
// result_table.
#pragma once

#include "bakerd/store/error.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <unordered_map>

namespace drtv::farm {

// What runs statements; throws SQLite::Exception.
class Connection {
  public:
    Connection(const std::string& path, std::chrono::milliseconds patience);

    // Prepared once, ready to bind.
    [[nodiscard]] SQLite::Statement& statement(const std::string& sql);
    // None of the statements reads any more.
    void end_statements();
    void execute(const std::string& sql) { database_.exec(sql); }
    [[nodiscard]] std::int64_t last_id() const { return database_.getLastInsertRowid(); }
    [[nodiscard]] SQLite::Database& raw() { return database_; }

  private:
    SQLite::Database database_;
    std::unordered_map<std::string, std::unique_ptr<SQLite::Statement>> statements_;
};

// Thread-safe: one caller at a time is at work.
class Database {
  public:
    // Brings older files up to date. Fails with a sentence when the file cannot be opened, is damaged, or is
    // of a newer version. Another program may look into the file; `patience` is how long it may hold it.
    [[nodiscard]] static store::Result<std::unique_ptr<Database>> open(
        const std::string& path, std::chrono::milliseconds patience = std::chrono::seconds(5));

    // Gives what `work` gives.
    template <class Work>
    [[nodiscard]] auto read(Work work) -> store::Result<std::invoke_result_t<Work, Connection&>> {
        const std::lock_guard lock(mutex_);
        const StatementsEnd end(connection_);
        try {
            // Without it every statement locks the file anew. It rolls back nothing.
            const SQLite::Transaction one_lock(connection_.raw());
            return work(connection_);
        } catch (const SQLite::Exception& exception) {
            return error_of(exception);
        }
    }

    // All of `work` or none of it is kept, and is durable on return.
    [[nodiscard]] store::Result<void> write(const std::function<void(Connection&)>& work);

  private:
    struct StatementsEnd {
        explicit StatementsEnd(Connection& of) : connection(of) {}
        ~StatementsEnd() { connection.end_statements(); }
        Connection& connection;
    };

    Database(const std::string& path, std::chrono::milliseconds patience) : connection_(path, patience) {}
    [[nodiscard]] static tl::unexpected<store::Error> error_of(const SQLite::Exception& exception);

    std::mutex mutex_;
    Connection connection_;  // guarded by mutex_
};

}  // namespace drtv::farm
