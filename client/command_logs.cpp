#include "client/command_logs.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <string_view>

namespace drtv::client {
namespace {

// "I,J", in whole numbers.
bool parse_sector(std::string_view text, v1::SectorCoordinate& sector) {
    std::int32_t i = 0;
    std::int32_t j = 0;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, i);
    if (first.ec != std::errc() || first.ptr == end || *first.ptr != ',')
        return false;
    const auto second = std::from_chars(first.ptr + 1, end, j);
    if (second.ec != std::errc() || second.ptr != end)
        return false;
    sector.set_i(i);
    sector.set_j(j);
    return true;
}

}  // namespace

cli::Result<cli::ExitCode> run_logs(ServerConnection& connection,
                                    const std::string& job,
                                    const std::string& sector) {
    v1::GetSectorLogRequest request;
    request.set_job(job_resource(job));
    if (!parse_sector(sector, *request.mutable_sector()))
        return cli::fail(cli::exit_usage, fmt::format("the sector '{}' is not I,J", sector));
    v1::SectorLog log;
    if (const grpc::Status status = call(*connection.sectors, &v1::Sectors::Stub::GetSectorLog, request, log);
        !status.ok())
        return tl::unexpected(connection.failure(status));
    if (connection.options.json) {
        const nlohmann::ordered_json json = {{"kind", "log"},
                                             {"sector", {request.sector().i(), request.sector().j()}},
                                             {"node", log.node()},
                                             {"file", log.file()},
                                             {"lines", log.lines()}};
        std::puts(json.dump().c_str());
        return cli::exit_done;
    }
    std::printf("on node %s; the task's whole log is %s in the server's store\n",
                log.node().c_str(),
                log.file().c_str());
    for (const std::string& line : log.lines())
        std::puts(line.c_str());
    return cli::exit_done;
}

}  // namespace drtv::client
