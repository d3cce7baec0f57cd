#include "client/commands.h"
#include "client/job_text.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace drtv::client {

int run_cache(Connection& connection, bool clear) {
    v1::CacheState state;
    grpc::ClientContext context, clearing;
    if (const grpc::Status status = connection.cache->GetCache(&context, {}, &state); !status.ok())
        return complain(connection.sentence(status));
    std::int64_t removed = state.results();
    if (clear) {
        if (const grpc::Status status = connection.cache->ClearCache(&clearing, {}, &state); !status.ok())
            return complain(connection.sentence(status));
    }
    // Others may bake in the meantime.
    removed = std::max<std::int64_t>(removed - state.results(), 0);
    const std::int64_t reused = state.hits() + state.near_hits(), asked = reused + state.baked();
    if (connection.options.json) {
        nlohmann::ordered_json json = {{"results", state.results()},
                                       {"size", state.size_bytes()},
                                       {"limit", state.limit_bytes()},
                                       {"hits", state.hits()},
                                       {"near_hits", state.near_hits()},
                                       {"baked", state.baked()}};
        if (clear)
            json["removed"] = removed;
        std::puts(json.dump().c_str());
        return 0;
    }
    if (clear)
        std::printf("%s results removed\n", with_thousands(removed).c_str());
    std::printf("%s results, %.1f of %.1f MB\n",
                with_thousands(state.results()).c_str(),
                static_cast<double>(state.size_bytes()) * 1e-6,
                static_cast<double>(state.limit_bytes()) * 1e-6);
    if (asked > 0) {
        std::printf("%s sectors so far: %s hits, %s near hits, %s baked (hit rate %.1f %%)\n",
                    with_thousands(asked).c_str(),
                    with_thousands(state.hits()).c_str(),
                    with_thousands(state.near_hits()).c_str(),
                    with_thousands(state.baked()).c_str(),
                    100 * static_cast<double>(reused) / static_cast<double>(asked));
    }
    return 0;
}

}  // namespace drtv::client
