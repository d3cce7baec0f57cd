#include "bakerd/farm/result_table.h"

#include "bakerd/farm/row_codec.h"

#include <fmt/format.h>

namespace drtv::farm {

// Found by the rows' namespace.
static void columns(auto& codec, Is<ResultRow> auto& row) {
    codec("i", row.sector.i);
    codec("j", row.sector.j);
    codec("results_key", row.results_key);
    codec("file", row.result.blobs.file);
    codec("footprint", row.result.blobs.footprint);
    codec("inventory", row.result.blobs.inventory);
    codec("file_bytes", row.result.file_bytes);
    codec("footprint_bytes", row.result.footprint_bytes);
    codec("probes", row.result.probes);
    codec("rays", row.result.rays);
    codec("warnings", row.result.warnings);
    codec("seconds", row.result.seconds);
    codec("bound", row.result.bound);
    worker::visit_values(codec, row.result.numbers);
}

static void columns(auto& codec, Is<HoldRow> auto& hold) {
    codec("result", hold.result);
    codec("inventory", hold.inventory);
    codec("bound", hold.bound);
}

namespace {

Checked<ResultRow> read_row(SQLite::Statement& statement) {
    Checked<ResultRow> found;
    RowReader reader(statement);
    columns(reader, found.row);
    found.sound = reader.sound();
    reader("id", found.row.id);
    return found;
}

// The next number in the order of use.
void advance_uses(Connection& connection) {
    connection.statement("UPDATE counter SET value = value + 1 WHERE name = 'uses'").exec();
}

constexpr const char* last_use = "(SELECT value FROM counter WHERE name = 'uses')";

void insert_hold(Connection& connection, const HoldRow& hold) {
    SQLite::Statement& statement =
        connection.statement(insert_into<HoldRow>("hold") +
                             " ON CONFLICT DO UPDATE SET bound = excluded.bound, sum = excluded.sum");
    RowBinder binder(statement);
    columns(binder, hold);
    statement.exec();
}

}  // namespace

void insert_result(Connection& connection, const ResultRow& row) {
    advance_uses(connection);
    const ColumnNames names = names_of<ResultRow>();
    const std::string values = names.list(":");
    SQLite::Statement& statement =
        connection.statement(fmt::format("INSERT INTO result ({}, sum, used) VALUES ({}, row_sum({}), {})",
                                         names.list(),
                                         values,
                                         values,
                                         last_use));
    RowBinder binder(statement);
    columns(binder, row);
    statement.exec();
    insert_hold(connection, {connection.last_id(), row.result.blobs.inventory, row.result.bound});
}

void use_result(Connection& connection, const HoldRow& hold) {
    advance_uses(connection);
    SQLite::Statement& statement =
        connection.statement(fmt::format("UPDATE result SET used = {} WHERE id = ?", last_use));
    statement.bind(1, hold.result);
    statement.exec();
    insert_hold(connection, hold);
}

void count_sectors(Connection& connection, std::int64_t hits, std::int64_t near_hits, std::int64_t baked) {
    SQLite::Statement& statement = connection.statement(
        "UPDATE counter SET value = value + CASE name WHEN 'hits' THEN ? WHEN 'near_hits' THEN ? WHEN "
        "'baked' THEN ? ELSE 0 END");
    statement.bind(1, hits);
    statement.bind(2, near_hits);
    statement.bind(3, baked);
    statement.exec();
}

std::vector<Checked<ResultRow>> results_that_hold(Connection& connection,
                                                  map::SectorCoordinate sector,
                                                  const Digest& results_key,
                                                  const Digest& inventory) {
    SQLite::Statement& statement = connection.statement(select_from<ResultRow>(
        "result",
        "JOIN hold ON hold.result = result.id WHERE i = ? AND j = ? AND results_key = ? AND "
        "hold.inventory = ? ORDER BY used DESC",
        ", id"));
    statement.bind(1, sector.i);
    statement.bind(2, sector.j);
    statement.bind(3, to_hex(results_key));
    statement.bind(4, to_hex(inventory));
    std::vector<Checked<ResultRow>> rows;
    while (statement.executeStep())
        rows.push_back(read_row(statement));
    return rows;
}

void for_each_result(Connection& connection,
                     map::SectorCoordinate sector,
                     const Digest& results_key,
                     std::size_t max,
                     const std::function<bool(const Checked<ResultRow>&)>& visit) {
    SQLite::Statement& statement = connection.statement(select_from<ResultRow>(
        "result", "WHERE i = ? AND j = ? AND results_key = ? ORDER BY used DESC LIMIT ?", ", id"));
    statement.bind(1, sector.i);
    statement.bind(2, sector.j);
    statement.bind(3, to_hex(results_key));
    statement.bind(4, static_cast<std::int64_t>(max));
    while (statement.executeStep()) {
        if (!visit(read_row(statement)))
            return;
    }
}

std::optional<HoldRow> find_hold(Connection& connection, std::int64_t result, const Digest& inventory) {
    SQLite::Statement& statement =
        connection.statement(select_from<HoldRow>("hold", "WHERE result = ? AND inventory = ?"));
    statement.bind(1, result);
    statement.bind(2, to_hex(inventory));
    if (!statement.executeStep())
        return std::nullopt;
    HoldRow hold;
    RowReader reader(statement);
    columns(reader, hold);
    return reader.sound() ? std::optional(hold) : std::nullopt;
}

std::vector<Checked<ResultRow>> idle_results(Connection& connection, std::size_t skipped, std::size_t max) {
    SQLite::Statement& statement = connection.statement(
        select_from<ResultRow>("result",
                               "WHERE NOT EXISTS (SELECT 1 FROM job_sector JOIN job ON job.id = "
                               "job_sector.job WHERE job_sector.file "
                               "= result.file AND job.state IN (?, ?)) ORDER BY used LIMIT ? OFFSET ?",
                               ", id"));
    statement.bind(1, static_cast<std::int64_t>(JobState::running));
    statement.bind(2, static_cast<std::int64_t>(JobState::creating));
    statement.bind(3, static_cast<std::int64_t>(max));
    statement.bind(4, static_cast<std::int64_t>(skipped));
    std::vector<Checked<ResultRow>> rows;
    while (statement.executeStep())
        rows.push_back(read_row(statement));
    return rows;
}

void remove_result(Connection& connection, std::int64_t id) {
    for (const char* sql : {"DELETE FROM result WHERE id = ?", "DELETE FROM hold WHERE result = ?"}) {
        SQLite::Statement& remove = connection.statement(sql);
        remove.bind(1, id);
        remove.exec();
    }
}

bool is_needed(Connection& connection, const Digest& blob) {
    SQLite::Statement& statement = connection.statement(
        "SELECT EXISTS (SELECT 1 FROM result WHERE file = ?1) OR EXISTS (SELECT 1 FROM result WHERE "
        "footprint = ?1) OR EXISTS (SELECT 1 FROM result WHERE inventory = ?1) OR EXISTS (SELECT 1 FROM "
        "job_sector JOIN job ON job.id = job_sector.job WHERE job_sector.file = ?1 AND job.state IN (?2, "
        "?3))");
    statement.bind(1, to_hex(blob));
    statement.bind(2, static_cast<std::int64_t>(JobState::running));
    statement.bind(3, static_cast<std::int64_t>(JobState::creating));
    return statement.executeStep() && statement.getColumn(0).getInt() != 0;
}

double mean_seconds(Connection& connection, const Digest& results_key) {
    SQLite::Statement& statement = connection.statement(
        "SELECT coalesce((SELECT avg(seconds) FROM result WHERE results_key = ?), (SELECT avg(seconds) FROM "
        "result), 0)");
    statement.bind(1, to_hex(results_key));
    return statement.executeStep() ? statement.getColumn(0).getDouble() : 0.0;
}

CacheCounts count_results(Connection& connection) {
    SQLite::Statement& statement = connection.statement(
        "SELECT count(*), coalesce(sum(file_bytes + footprint_bytes), 0), (SELECT value FROM counter WHERE "
        "name = 'hits'), (SELECT value FROM counter WHERE name = 'near_hits'), (SELECT value FROM counter "
        "WHERE name = 'baked') FROM result");
    CacheCounts counts;
    if (!statement.executeStep())
        return counts;
    RowReader reader(statement);
    reader("results", counts.results);
    reader("bytes", counts.bytes);
    reader("hits", counts.hits);
    reader("near_hits", counts.near_hits);
    reader("baked", counts.baked);
    return counts;
}

}  // namespace drtv::farm
