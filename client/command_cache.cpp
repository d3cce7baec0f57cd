#include "client/command_cache.h"

#include "client/number_text.h"

#include <grpcpp/grpcpp.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <optional>

namespace drtv::client {
namespace {

// `removed` is the number of results, where some were to be.
void print_json(const v1::CacheState& state, std::optional<std::int64_t> removed) {
    nlohmann::ordered_json json;
    json["kind"] = "cache";
    json["results"] = state.results();
    json["size"] = state.size_bytes();
    json["limit"] = state.limit_bytes();
    json["hits"] = state.hits();
    json["near_hits"] = state.near_hits();
    json["baked"] = state.baked();
    if (removed)
        json["removed"] = *removed;
    std::puts(json.dump().c_str());
}

void print_hit_rate(const v1::CacheState& state) {
    const std::int64_t reused = state.hits() + state.near_hits();
    const std::int64_t asked = reused + state.baked();
    if (asked <= 0)
        return;
    const double percent = 100 * static_cast<double>(reused) / static_cast<double>(asked);
    std::printf("%s sectors so far: %s hits, %s near hits, %s baked (hit rate %.1f %%)\n",
                with_thousands(asked).c_str(),
                with_thousands(state.hits()).c_str(),
                with_thousands(state.near_hits()).c_str(),
                with_thousands(state.baked()).c_str(),
                percent);
}

void print_text(const v1::CacheState& state, std::optional<std::int64_t> removed) {
    if (removed)
        std::printf("%s results removed\n", with_thousands(*removed).c_str());
    std::printf("%s results, %.1f of %.1f MB\n",
                with_thousands(state.results()).c_str(),
                in_megabytes(state.size_bytes()),
                in_megabytes(state.limit_bytes()));
    print_hit_rate(state);
}

}  // namespace

cli::Result<cli::ExitCode> run_cache(ServerConnection& connection, bool clear) {
    v1::CacheState state;
    if (const grpc::Status status =
            call(*connection.cache, &v1::Cache::Stub::GetCache, v1::GetCacheRequest(), state);
        !status.ok())
        return tl::unexpected(connection.failure(status));
    std::optional<std::int64_t> removed;
    if (clear) {
        const std::int64_t results_before = state.results();
        if (const grpc::Status status =
                call(*connection.cache, &v1::Cache::Stub::ClearCache, v1::ClearCacheRequest(), state);
            !status.ok())
            return tl::unexpected(connection.failure(status));
        // Others may bake in the meantime.
        removed = std::max<std::int64_t>(results_before - state.results(), 0);
    }
    if (connection.options.json)
        print_json(state, removed);
    else
        print_text(state, removed);
    return cli::exit_done;
}

}  // namespace drtv::client
