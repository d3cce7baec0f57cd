#include "bakerd/service/names.h"

#include "drtv/v1/error.pb.h"

#include <drtv/version.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace drtv::service {
namespace {

constexpr std::string_view job_prefix = "jobs/", map_prefix = "maps/";

std::string shortened(const std::string& text) {
    return text.size() > 100 ? text.substr(0, 97) + "..." : text;
}

}  // namespace

grpc::Status failed(grpc::StatusCode code, const std::string& sentence) {
    v1::ErrorDetails details;
    details.set_server_version(DRTV_VERSION);
    return {code, sentence, details.SerializeAsString()};
}

grpc::Status to_status(const store::Error& error) {
    using store::ErrorCode;
    grpc::StatusCode code = grpc::StatusCode::INTERNAL;
    switch (error.code) {
        case ErrorCode::invalid_argument:
            code = grpc::StatusCode::INVALID_ARGUMENT;
            break;
        case ErrorCode::not_found:
            code = grpc::StatusCode::NOT_FOUND;
            break;
        case ErrorCode::failed_precondition:
            code = grpc::StatusCode::FAILED_PRECONDITION;
            break;
        case ErrorCode::aborted:
            code = grpc::StatusCode::ABORTED;
            break;
        case ErrorCode::resource_exhausted:
            code = grpc::StatusCode::RESOURCE_EXHAUSTED;
            break;
        case ErrorCode::data_loss:
            code = grpc::StatusCode::DATA_LOSS;
            break;
        case ErrorCode::unavailable:
            code = grpc::StatusCode::UNAVAILABLE;
            break;
        case ErrorCode::internal:
            break;
    }
    return failed(code, error.message);
}

std::string job_name(std::int64_t id) {
    return fmt::format("{}{}", job_prefix, id);
}
std::string map_name(const map::Digest& digest) {
    return fmt::format("{}{}", map_prefix, to_hex(digest));
}

store::Result<std::int64_t> job_from_name(const std::string& name) {
    std::int64_t id = 0;
    if (name.starts_with(job_prefix)) {
        const char* end = name.data() + name.size();
        const auto [stopped, error] = std::from_chars(name.data() + job_prefix.size(), end, id);
        if (error == std::errc() && stopped == end && id > 0)
            return id;
    }
    return store::fail(store::ErrorCode::invalid_argument,
                       fmt::format("'{}' is not the name of a job (jobs/<number>)", shortened(name)));
}

store::Result<map::Digest> map_from_name(const std::string& name) {
    if (name.starts_with(map_prefix)) {
        if (const auto digest = map::digest_from_hex(name.substr(map_prefix.size())))
            return *digest;
    }
    return store::fail(store::ErrorCode::invalid_argument,
                       fmt::format("'{}' is not the name of a map (maps/<digest>)", shortened(name)));
}

store::Result<map::Digest> digest_from_text(const std::string& hex) {
    if (const auto digest = map::digest_from_hex(hex))
        return *digest;
    return store::fail(
        store::ErrorCode::invalid_argument,
        fmt::format("'{}' is not a SHA-256 digest of 64 lower-case hexadecimal digits", shortened(hex)));
}

store::Result<Page> page_of(const std::string& token,
                            std::int32_t size,
                            std::int64_t start,
                            std::int64_t default_size,
                            std::int64_t max_size) {
    Page page{start, size == 0 ? default_size : std::min<std::int64_t>(size, max_size)};
    if (!token.empty()) {
        const char* end = token.data() + token.size();
        const auto [stopped, error] = std::from_chars(token.data(), end, page.from);
        if (error != std::errc() || stopped != end || page.from < 0)
            return store::fail(store::ErrorCode::invalid_argument,
                               fmt::format("'{}' is not a page token of this server", shortened(token)));
    }
    if (size < 0)
        return store::fail(store::ErrorCode::invalid_argument,
                           fmt::format("the page size {} is negative", size));
    return page;
}

}  // namespace drtv::service
