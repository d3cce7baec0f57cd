// Between the contract's text and the farm's values: resource names, digests, statuses.
#pragma once

#include "bakerd/map/digest.h"
#include "bakerd/store/error.h"

#include <grpcpp/support/status.h>

#include <cstdint>
#include <string>

namespace drtv::service {

// With the details that say that bakerd made it (error.proto).
[[nodiscard]] grpc::Status failed(grpc::StatusCode code, const std::string& sentence);
[[nodiscard]] grpc::Status to_status(const store::Error& error);

[[nodiscard]] std::string job_name(std::int64_t id);            // "jobs/12"
[[nodiscard]] std::string map_name(const map::Digest& digest);  // "maps/<hex>"

// invalid_argument with a sentence for anything else.
[[nodiscard]] store::Result<std::int64_t> job_from_name(const std::string& name);
[[nodiscard]] store::Result<map::Digest> map_from_name(const std::string& name);
[[nodiscard]] store::Result<map::Digest> digest_from_text(const std::string& hex);

// A list request's page: where it starts (the number in its token, `start` without one) and how many it
// holds.
struct Page {
    std::int64_t from = 0;
    std::int64_t size = 0;
};
[[nodiscard]] store::Result<Page> page_of(const std::string& token,
                                          std::int32_t size,
                                          std::int64_t start,
                                          std::int64_t default_size,
                                          std::int64_t max_size);

}  // namespace drtv::service
