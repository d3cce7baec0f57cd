#include "bakerd/farm/database.h"

#include <fmt/format.h>
#include <sqlite3.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace drtv::farm {
namespace {

constexpr int schema_version = 4;

constexpr const char* schema = R"sql(
CREATE TABLE map (manifest TEXT PRIMARY KEY, summary TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE job (
  id INTEGER PRIMARY KEY AUTOINCREMENT, request_id TEXT UNIQUE, manifest TEXT NOT NULL, preset TEXT NOT NULL,
  settings TEXT NOT NULL, overrides TEXT NOT NULL, region TEXT NOT NULL, state INTEGER NOT NULL, error TEXT NOT NULL,
  sectors_cached INTEGER NOT NULL, created INTEGER NOT NULL, ended INTEGER NOT NULL, sectors_near INTEGER NOT NULL DEFAULT 0,
  largest_bound REAL NOT NULL DEFAULT 0);
CREATE TABLE task (
  id INTEGER PRIMARY KEY, key TEXT UNIQUE NOT NULL, manifest TEXT NOT NULL, i INTEGER NOT NULL, j INTEGER NOT NULL,
  settings TEXT NOT NULL, state INTEGER NOT NULL, failed_attempts INTEGER NOT NULL, result TEXT NOT NULL,
  size INTEGER NOT NULL, probes INTEGER NOT NULL, rays INTEGER NOT NULL, error TEXT NOT NULL, warnings TEXT NOT NULL DEFAULT '',
  bound REAL NOT NULL DEFAULT 0);
CREATE TABLE job_task (job INTEGER NOT NULL, task INTEGER NOT NULL, PRIMARY KEY (job, task)) WITHOUT ROWID;
)sql";

// settings_key is reuse::results_key.
constexpr const char* result_schema = R"sql(
CREATE TABLE result (
  id INTEGER PRIMARY KEY, i INTEGER NOT NULL, j INTEGER NOT NULL, settings_key TEXT NOT NULL, file TEXT NOT NULL, size INTEGER NOT NULL,
  probes INTEGER NOT NULL, rays INTEGER NOT NULL, warnings TEXT NOT NULL, footprint TEXT NOT NULL, inventory TEXT NOT NULL,
  footprint_size INTEGER NOT NULL, seconds REAL NOT NULL, bound REAL NOT NULL DEFAULT 0, used INTEGER NOT NULL);
CREATE INDEX result_of_sector ON result (i, j, settings_key, used);
CREATE INDEX result_by_use ON result (used);
CREATE INDEX result_of_file ON result (file);
CREATE INDEX result_of_footprint ON result (footprint);
CREATE INDEX result_of_inventory ON result (inventory);
CREATE TABLE counter (name TEXT PRIMARY KEY, value INTEGER NOT NULL) WITHOUT ROWID;
INSERT INTO counter VALUES ('hits', 0), ('near_hits', 0), ('baked', 0), ('uses', 0);
)sql";

constexpr const char* schema_2_from_1 = "ALTER TABLE task ADD COLUMN warnings TEXT NOT NULL DEFAULT '';";
constexpr const char* schema_3_from_2 =
    "ALTER TABLE task ADD COLUMN bound REAL NOT NULL DEFAULT 0; ALTER TABLE job ADD COLUMN sectors_near "
    "INTEGER NOT NULL DEFAULT 0; ALTER TABLE job ADD COLUMN largest_bound REAL NOT NULL DEFAULT 0;";

// Records of results are of another kind since: none of before can be assessed. They are found no more, and
// leave the cache in their time.
constexpr const char* schema_4_from_3 =
    "UPDATE result SET settings_key = ''; ALTER TABLE result ADD COLUMN bound REAL NOT NULL DEFAULT 0;";

constexpr const char* task_columns =
    "id, key, manifest, i, j, settings, state, failed_attempts, result, size, probes, rays, error, warnings, "
    "bound";
constexpr const char* job_columns =
    "id, request_id, manifest, preset, settings, overrides, region, state, error, sectors_cached, created, "
    "ended, sectors_near, largest_bound";
constexpr const char* result_columns =
    "id, i, j, settings_key, file, size, probes, rays, warnings, footprint, inventory, footprint_size, "
    "seconds, bound";

// A list of sentences in one column: a line each, for no sentence has a line's end.
std::string joined(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& sentence : sentences)
        text += (text.empty() ? "" : "\n") + sentence;
    return text;
}

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> sentences;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        sentences.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return sentences;
}

Digest stored_digest(const std::string& hex) {
    return map::digest_from_hex(hex).value_or(Digest{});
}

}  // namespace

// A prepared statement: bind in order, step, read in order.
class Database::Statement {
  public:
    Statement(Database& database, const std::string& sql) : database_(database) {
        sqlite3_prepare_v2(database.handle_, sql.c_str(), -1, &statement_, nullptr);
    }
    ~Statement() { sqlite3_finalize(statement_); }
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;

    Statement& bind(std::int64_t value) {
        sqlite3_bind_int64(statement_, ++bound_, value);
        return *this;
    }
    Statement& bind_real(double value) {
        sqlite3_bind_double(statement_, ++bound_, value);
        return *this;
    }
    Statement& bind(const std::string& value) {
        sqlite3_bind_text(
            statement_, ++bound_, value.c_str(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
        return *this;
    }
    Statement& bind_null() {
        ++bound_;
        return *this;
    }

    // True: a row is there to read.
    Result<bool> step() {
        read_ = 0;
        const int code = statement_ == nullptr ? SQLITE_ERROR : sqlite3_step(statement_);
        if (code == SQLITE_ROW)
            return true;
        if (code == SQLITE_DONE)
            return false;
        return database_.error("use");
    }
    Result<void> run() {
        const auto row = step();
        if (!row)
            return tl::unexpected(row.error());
        return {};
    }
    std::int64_t integer() { return sqlite3_column_int64(statement_, read_++); }
    double real() { return sqlite3_column_double(statement_, read_++); }
    std::string text() {
        const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, read_));
        const int size = sqlite3_column_bytes(statement_, read_++);
        return bytes == nullptr ? std::string() : std::string(bytes, static_cast<std::size_t>(size));
    }

    TaskRow task() {
        TaskRow row;
        row.id = integer();
        row.key = stored_digest(text());
        row.manifest = stored_digest(text());
        row.sector.i = static_cast<std::int32_t>(integer());
        row.sector.j = static_cast<std::int32_t>(integer());
        row.settings = decode_settings(text()).value_or(bake::Settings{});
        row.state = static_cast<TaskState>(integer());
        row.failed_attempts = static_cast<int>(integer());
        row.result.result = stored_digest(text());
        row.result.size_bytes = integer();
        row.result.probes = integer();
        row.result.rays = integer();
        row.error = text();
        row.result.warnings = split(text());
        row.bound = static_cast<float>(real());
        return row;
    }
    ResultRow result() {
        ResultRow row;
        row.id = integer();
        row.sector.i = static_cast<std::int32_t>(integer());
        row.sector.j = static_cast<std::int32_t>(integer());
        row.results_key = stored_digest(text());
        row.result.result = stored_digest(text());
        row.result.size_bytes = integer();
        row.result.probes = integer();
        row.result.rays = integer();
        row.result.warnings = split(text());
        row.result.footprint = stored_digest(text());
        row.result.inventory = stored_digest(text());
        row.result.footprint_bytes = integer();
        row.result.seconds = real();
        row.result.bound = static_cast<float>(real());
        return row;
    }
    Result<std::vector<ResultRow>> all_results() {
        std::vector<ResultRow> rows;
        for (;;) {
            const auto row = step();
            if (!row)
                return tl::unexpected(row.error());
            if (!*row)
                return rows;
            rows.push_back(result());
        }
    }
    Result<std::optional<TaskRow>> one_task() {
        const auto row = step();
        if (!row)
            return tl::unexpected(row.error());
        if (!*row)
            return std::nullopt;
        return task();
    }
    void bind_task(const TaskRow& row) {
        bind(to_hex(row.key))
            .bind(to_hex(row.manifest))
            .bind(row.sector.i)
            .bind(row.sector.j)
            .bind(encode_settings(row.settings));
        bind(static_cast<std::int64_t>(row.state)).bind(row.failed_attempts).bind(to_hex(row.result.result));
        bind(row.result.size_bytes)
            .bind(row.result.probes)
            .bind(row.result.rays)
            .bind(row.error)
            .bind(joined(row.result.warnings))
            .bind_real(row.bound);
    }

  private:
    Database& database_;
    sqlite3_stmt* statement_ = nullptr;
    int bound_ = 0, read_ = 0;
};

tl::unexpected<Error> Database::error(const char* doing) const {
    const int code = sqlite3_errcode(handle_);
    const ErrorCode kind = code == SQLITE_FULL ? ErrorCode::resource_exhausted : ErrorCode::internal;
    return fail(kind, fmt::format("cannot {} the farm's database: {}", doing, sqlite3_errmsg(handle_)));
}

Result<void> Database::execute(const char* sql) {
    if (sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) != SQLITE_OK)
        return error("use");
    return {};
}

Result<std::unique_ptr<Database>> Database::open(const std::string& path) {
    sqlite3* handle = nullptr;
    const int code = sqlite3_open_v2(
        path.c_str(), &handle, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
    std::unique_ptr<Database> database(new Database(handle));
    if (code != SQLITE_OK)
        return database->error("open");
    sqlite3_busy_timeout(handle, 5000);
    if (auto done =
            database->execute("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON;");
        !done)
        return tl::unexpected(done.error());
    std::int64_t version = 0;
    {
        Statement query(*database, "PRAGMA user_version");
        const auto row = query.step();
        if (!row)
            return tl::unexpected(row.error());
        version = query.integer();
    }
    if (version > schema_version)
        return fail(ErrorCode::failed_precondition,
                    fmt::format("{} was written by a newer bakerd (schema {}, this one knows {})",
                                path,
                                version,
                                schema_version));
    if (version < schema_version) {
        const auto created = database->transaction([&]() -> Result<void> {
            std::string steps = version == 0 ? schema : "";
            if (version == 1)
                steps += schema_2_from_1;
            if (version == 1 || version == 2)
                steps += schema_3_from_2;
            steps += version == 3 ? schema_4_from_3 : result_schema;
            if (auto done = database->execute(steps.c_str()); !done)
                return done;
            return database->execute(fmt::format("PRAGMA user_version={}", schema_version).c_str());
        });
        if (!created)
            return tl::unexpected(created.error());
    }
    return database;
}

Database::~Database() {
    sqlite3_close(handle_);
}

Result<void> Database::transaction(const std::function<Result<void>()>& work) {
    if (auto begun = execute("BEGIN IMMEDIATE"); !begun)
        return begun;
    Result<void> done = work();
    if (done)
        done = execute("COMMIT");
    if (!done)
        static_cast<void>(execute("ROLLBACK"));
    return done;
}

Result<void> Database::put_map(const Digest& manifest, const InspectAnswer& summary) {
    Statement statement(*this, "INSERT OR REPLACE INTO map VALUES (?, ?)");
    return statement.bind(to_hex(manifest)).bind(encode(WorkerAnswer{0, summary})).run();
}

Result<std::optional<InspectAnswer>> Database::map(const Digest& manifest) {
    Statement statement(*this, "SELECT summary FROM map WHERE manifest = ?");
    const auto row = statement.bind(to_hex(manifest)).step();
    if (!row)
        return tl::unexpected(row.error());
    if (!*row)
        return std::nullopt;
    const auto answer = decode_answer(statement.text());
    if (!answer || !std::holds_alternative<InspectAnswer>(answer->what))
        return std::nullopt;
    return std::get<InspectAnswer>(answer->what);
}

Result<void> Database::insert_job(JobRow& job) {
    Statement statement(
        *this,
        fmt::format("INSERT INTO job ({}) VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                    job_columns));
    if (job.request_id.empty())
        statement.bind_null();
    else
        statement.bind(job.request_id);
    statement.bind(to_hex(job.manifest))
        .bind(job.preset)
        .bind(encode_settings(job.settings))
        .bind(job.overrides)
        .bind(job.region);
    statement.bind(static_cast<std::int64_t>(job.state))
        .bind(job.error)
        .bind(job.sectors_cached)
        .bind(job.created_seconds)
        .bind(job.ended_seconds);
    statement.bind(job.sectors_near).bind_real(job.largest_bound);
    if (auto done = statement.run(); !done)
        return done;
    job.id = sqlite3_last_insert_rowid(handle_);
    return {};
}

Result<void> Database::update_job(const JobRow& job) {
    Statement statement(*this,
                        "UPDATE job SET state = ?, error = ?, ended = ?, largest_bound = ? WHERE id = ?");
    return statement.bind(static_cast<std::int64_t>(job.state))
        .bind(job.error)
        .bind(job.ended_seconds)
        .bind_real(job.largest_bound)
        .bind(job.id)
        .run();
}

Result<std::vector<JobRow>> Database::jobs() {
    Statement statement(*this, fmt::format("SELECT {} FROM job ORDER BY id", job_columns));
    std::vector<JobRow> rows;
    for (;;) {
        const auto row = statement.step();
        if (!row)
            return tl::unexpected(row.error());
        if (!*row)
            return rows;
        JobRow job;
        job.id = statement.integer();
        job.request_id = statement.text();
        job.manifest = stored_digest(statement.text());
        job.preset = statement.text();
        job.settings = decode_settings(statement.text()).value_or(bake::Settings{});
        job.overrides = statement.text();
        job.region = statement.text();
        job.state = static_cast<JobState>(statement.integer());
        job.error = statement.text();
        job.sectors_cached = statement.integer();
        job.created_seconds = statement.integer();
        job.ended_seconds = statement.integer();
        job.sectors_near = statement.integer();
        job.largest_bound = static_cast<float>(statement.real());
        rows.push_back(std::move(job));
    }
}

Result<void> Database::add_job_task(std::int64_t job, std::int64_t task) {
    Statement statement(*this, "INSERT INTO job_task VALUES (?, ?)");
    return statement.bind(job).bind(task).run();
}

Result<std::vector<TaskRow>> Database::job_tasks(std::int64_t job, std::int64_t first, std::int64_t count) {
    Statement statement(*this,
                        fmt::format("SELECT {} FROM task WHERE id IN (SELECT task FROM job_task WHERE job = "
                                    "?) ORDER BY j, i LIMIT ? OFFSET ?",
                                    task_columns));
    statement.bind(job).bind(count).bind(first);
    std::vector<TaskRow> rows;
    for (;;) {
        const auto row = statement.step();
        if (!row)
            return tl::unexpected(row.error());
        if (!*row)
            return rows;
        rows.push_back(statement.task());
    }
}

Result<std::optional<TaskRow>> Database::job_task(std::int64_t job, map::SectorCoordinate sector) {
    Statement statement(
        *this,
        fmt::format(
            "SELECT {} FROM task WHERE i = ? AND j = ? AND id IN (SELECT task FROM job_task WHERE job = ?)",
            task_columns));
    return statement.bind(sector.i).bind(sector.j).bind(job).one_task();
}

Result<JobCounts> Database::job_counts(std::int64_t job) {
    Statement statement(*this,
                        "SELECT count(*), total(state = 1), total(state = 2), total(probes) FROM task WHERE "
                        "id IN (SELECT task FROM job_task WHERE job = ?)");
    const auto row = statement.bind(job).step();
    if (!row)
        return tl::unexpected(row.error());
    JobCounts counts;
    counts.total = statement.integer();
    counts.done = statement.integer();
    counts.failed = statement.integer();
    counts.probes = statement.integer();
    return counts;
}

Result<std::vector<std::string>> Database::job_warnings(std::int64_t job, std::size_t most) {
    Statement statement(*this,
                        "SELECT warnings FROM task WHERE warnings != '' AND id IN (SELECT task FROM job_task "
                        "WHERE job = ?) ORDER BY j, i LIMIT ?");
    statement.bind(job).bind(static_cast<std::int64_t>(most));
    std::vector<std::string> warnings;
    for (;;) {
        const auto row = statement.step();
        if (!row)
            return tl::unexpected(row.error());
        if (!*row)
            return warnings;
        for (std::string& sentence : split(statement.text())) {
            if (warnings.size() < most)
                warnings.push_back(std::move(sentence));
        }
    }
}

Result<void> Database::insert_task(TaskRow& task) {
    Statement statement(
        *this,
        fmt::format("INSERT INTO task ({}) VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                    task_columns));
    statement.bind_task(task);
    if (auto done = statement.run(); !done)
        return done;
    task.id = sqlite3_last_insert_rowid(handle_);
    return {};
}

Result<void> Database::update_task(const TaskRow& task) {
    Statement statement(
        *this,
        "UPDATE task SET key = ?, manifest = ?, i = ?, j = ?, settings = ?, state = ?, failed_attempts = ?, "
        "result = ?, size = ?, probes = ?, rays = ?, error = ?, warnings = ?, bound = ? "
        "WHERE id = ?");
    statement.bind_task(task);
    return statement.bind(task.id).run();
}

Result<std::optional<TaskRow>> Database::task_by_key(const Digest& key) {
    Statement statement(*this, fmt::format("SELECT {} FROM task WHERE key = ?", task_columns));
    return statement.bind(to_hex(key)).one_task();
}

Result<void> Database::insert_result(ResultRow& row) {
    if (auto done = execute("UPDATE counter SET value = value + 1 WHERE name = 'uses'"); !done)
        return done;
    Statement statement(*this,
                        fmt::format("INSERT INTO result ({}, used) VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
                                    "?, ?, ?, ?, (SELECT value FROM counter WHERE name = 'uses'))",
                                    result_columns));
    statement.bind(row.sector.i)
        .bind(row.sector.j)
        .bind(to_hex(row.results_key))
        .bind(to_hex(row.result.result))
        .bind(row.result.size_bytes)
        .bind(row.result.probes)
        .bind(row.result.rays);
    statement.bind(joined(row.result.warnings))
        .bind(to_hex(row.result.footprint))
        .bind(to_hex(row.result.inventory))
        .bind(row.result.footprint_bytes)
        .bind_real(row.result.seconds)
        .bind_real(row.result.bound);
    if (auto done = statement.run(); !done)
        return done;
    row.id = sqlite3_last_insert_rowid(handle_);
    return {};
}

Result<std::vector<ResultRow>> Database::results(map::SectorCoordinate sector,
                                                 const Digest& results_key,
                                                 std::size_t most) {
    Statement statement(
        *this,
        fmt::format(
            "SELECT {} FROM result WHERE i = ? AND j = ? AND settings_key = ? ORDER BY used DESC LIMIT ?",
            result_columns));
    return statement.bind(sector.i)
        .bind(sector.j)
        .bind(to_hex(results_key))
        .bind(static_cast<std::int64_t>(most))
        .all_results();
}

Result<void> Database::mark_used(map::SectorCoordinate sector, const Digest& file) {
    if (auto done = execute("UPDATE counter SET value = value + 1 WHERE name = 'uses'"); !done)
        return done;
    Statement statement(*this,
                        "UPDATE result SET used = (SELECT value FROM counter WHERE name = 'uses') WHERE file "
                        "= ? AND i = ? AND j = ?");
    return statement.bind(to_hex(file)).bind(sector.i).bind(sector.j).run();
}

Result<std::vector<ResultRow>> Database::idle_results(std::size_t most) {
    Statement statement(
        *this,
        fmt::format("SELECT {} FROM result WHERE file NOT IN (SELECT task.result FROM task JOIN job_task ON "
                    "job_task.task = task.id JOIN job ON job.id = job_task.job WHERE job.state = 0) "
                    "ORDER BY used LIMIT ?",
                    result_columns));
    return statement.bind(static_cast<std::int64_t>(most)).all_results();
}

Result<void> Database::remove_result(std::int64_t id) {
    Statement statement(*this, "DELETE FROM result WHERE id = ?");
    return statement.bind(id).run();
}

Result<bool> Database::is_needed(const Digest& blob) {
    Statement statement(
        *this,
        "SELECT EXISTS (SELECT 1 FROM result WHERE file = ?1) OR EXISTS (SELECT 1 FROM result WHERE "
        "footprint = ?1) OR EXISTS (SELECT 1 FROM result WHERE inventory = ?1) OR EXISTS "
        "(SELECT 1 FROM job JOIN job_task ON job.id = job_task.job JOIN task ON job_task.task = task.id "
        "WHERE job.state = 0 AND task.result = ?1)");
    const auto row = statement.bind(to_hex(blob)).step();
    if (!row)
        return tl::unexpected(row.error());
    return statement.integer() != 0;
}

Result<double> Database::mean_seconds(const Digest& results_key) {
    Statement statement(*this,
                        "SELECT coalesce((SELECT avg(seconds) FROM result WHERE settings_key = ?), (SELECT "
                        "avg(seconds) FROM result), 0)");
    const auto row = statement.bind(to_hex(results_key)).step();
    if (!row)
        return tl::unexpected(row.error());
    return statement.real();
}

Result<void> Database::count(std::int64_t hits, std::int64_t near_hits, std::int64_t baked) {
    Statement statement(*this,
                        "UPDATE counter SET value = value + CASE name WHEN 'hits' THEN ? WHEN 'near_hits' "
                        "THEN ? WHEN 'baked' THEN ? ELSE 0 END");
    return statement.bind(hits).bind(near_hits).bind(baked).run();
}

Result<CacheCounts> Database::cache_counts() {
    Statement statement(*this,
                        "SELECT count(*), total(size + footprint_size), (SELECT value FROM counter WHERE "
                        "name = 'hits'), (SELECT value FROM counter WHERE name = 'near_hits'), "
                        "(SELECT value FROM counter WHERE name = 'baked') FROM result");
    const auto row = statement.step();
    if (!row)
        return tl::unexpected(row.error());
    CacheCounts counts;
    counts.results = statement.integer();
    counts.bytes = statement.integer();
    counts.hits = statement.integer();
    counts.near_hits = statement.integer();
    counts.baked = statement.integer();
    return counts;
}

}  // namespace drtv::farm
