#include "bakerd/farm/map_table.h"

#include "bakerd/farm/row_codec.h"

#include <spdlog/spdlog.h>

namespace drtv::farm {
namespace {

struct Columns {
    Digest manifest;
    Digest content;
    Digest inventory;
    std::int64_t sector_count = 0;
    map::Survey survey;
    std::vector<std::string> warnings;
};

void columns(auto& codec, Is<Columns> auto& map) {
    codec("manifest", map.manifest);
    codec("content", map.content);
    codec("inventory", map.inventory);
    codec("sector_count", map.sector_count);
    map::visit_values(codec, map.survey);
    codec("warnings", map.warnings);
}

struct SectorColumns {
    Digest manifest;
    std::int64_t position = 0;
    map::SectorCoordinate sector;
};

void columns(auto& codec, Is<SectorColumns> auto& sector) {
    codec("manifest", sector.manifest);
    codec("position", sector.position);
    codec("i", sector.sector.i);
    codec("j", sector.sector.j);
}

template <class Row>
void insert_row(Connection& connection, const std::string& table, const Row& row) {
    SQLite::Statement& statement = connection.statement(insert_into<Row>(table));
    RowBinder binder(statement);
    columns(binder, row);
    statement.exec();
}

std::nullopt_t damaged(const Digest& manifest) {
    spdlog::warn("what the database says of the map {} is damaged: submit it again", to_hex(manifest));
    return std::nullopt;
}

}  // namespace

void put_map(Connection& connection, const MapRow& map) {
    for (const char* sql :
         {"DELETE FROM map WHERE manifest = ?", "DELETE FROM map_sector WHERE manifest = ?"}) {
        SQLite::Statement& remove = connection.statement(sql);
        remove.bind(1, to_hex(map.manifest));
        remove.exec();
    }
    const worker::MapSummary& summary = map.summary;
    const Columns row{map.manifest,
                      summary.content,
                      summary.inventory,
                      static_cast<std::int64_t>(summary.sectors.size()),
                      summary.survey,
                      summary.warnings};
    insert_row(connection, "map", row);
    for (std::size_t n = 0; n < summary.sectors.size(); ++n) {
        const SectorColumns sector{map.manifest, static_cast<std::int64_t>(n), summary.sectors[n]};
        insert_row(connection, "map_sector", sector);
    }
}

std::optional<worker::MapSummary> find_map(Connection& connection, const Digest& manifest) {
    SQLite::Statement& statement = connection.statement(select_from<Columns>("map", "WHERE manifest = ?"));
    statement.bind(1, to_hex(manifest));
    if (!statement.executeStep())
        return std::nullopt;
    Columns row;
    RowReader reader(statement);
    columns(reader, row);
    if (!reader.sound())
        return damaged(manifest);
    worker::MapSummary summary{row.content, row.inventory, {}, row.survey, row.warnings};
    SQLite::Statement& sectors = connection.statement(
        select_from<SectorColumns>("map_sector", "WHERE manifest = ? ORDER BY position"));
    sectors.bind(1, to_hex(manifest));
    while (sectors.executeStep()) {
        SectorColumns sector;
        RowReader sector_reader(sectors);
        columns(sector_reader, sector);
        if (!sector_reader.sound())
            return damaged(manifest);
        summary.sectors.push_back(sector.sector);
    }
    if (static_cast<std::int64_t>(summary.sectors.size()) != row.sector_count)
        return damaged(manifest);
    return summary;
}

}  // namespace drtv::farm
