#include "bakerd/farm/maps.h"

#include "bakerd/farm/database.h"
#include "bakerd/farm/map_table.h"
#include "bakerd/store/text_bytes.h"

#include <fmt/format.h>

namespace drtv::farm {

store::Result<MapView> Maps::create(store::Manifest given) {
    auto manifest = store::normalised(std::move(given));
    if (!manifest)
        return tl::unexpected(manifest.error());
    for (const store::ManifestFile& file : manifest->files) {
        if (!blobs_.has(file.digest))
            return store::fail(store::ErrorCode::failed_precondition,
                               fmt::format("the file '{}' has not been uploaded", file.path));
    }
    const std::string bytes = store::encode_manifest(*manifest);
    const auto id = blobs_.put(store::bytes_of_text(bytes));
    if (!id)
        return tl::unexpected(id.error());
    const auto summary = known_or_inspected(*id);
    if (!summary)
        return tl::unexpected(summary.error());
    return MapView{*id, std::move(*manifest), *summary};
}

store::Result<worker::MapSummary> Maps::known_or_inspected(const Digest& id) {
    const auto known = database_.read([&](Connection& connection) { return find_map(connection, id); });
    if (!known)
        return tl::unexpected(known.error());
    if (*known)
        return **known;
    const auto summary = executor_.inspect({id}).get();
    if (!summary) {
        const worker::RequestFailure& failure = summary.error();
        return store::fail(
            failure.may_retry ? store::ErrorCode::unavailable : store::ErrorCode::invalid_argument,
            failure.sentence);
    }
    const auto put = database_.write([&](Connection& connection) { put_map(connection, {id, *summary}); });
    if (!put)
        return tl::unexpected(put.error());
    return *summary;
}

store::Result<worker::MapSummary> Maps::summary_of(const Digest& manifest) {
    // Of a map that only the store remembers, as after the database was lost, it is looked at again.
    if (!blobs_.has(manifest))
        return store::fail(store::ErrorCode::not_found, fmt::format("there is no map {}", to_hex(manifest)));
    return known_or_inspected(manifest);
}

store::Result<MapView> Maps::get(const Digest& id) {
    auto summary = summary_of(id);
    if (!summary)
        return tl::unexpected(summary.error());
    const auto bytes = blobs_.get(id);
    if (!bytes)
        return tl::unexpected(bytes.error());
    auto manifest = store::decode_manifest(store::text_of_bytes(*bytes));
    if (!manifest)
        return tl::unexpected(manifest.error());
    return MapView{id, std::move(*manifest), std::move(*summary)};
}

}  // namespace drtv::farm
