#include "client/read_report.h"

#include "client/job_end.h"
#include "client/reconnection.h"
#include "client/sector_list.h"

#include <grpcpp/grpcpp.h>

namespace drtv::client {
namespace {

cli::Result<JobReport> read_once(const ServerConnection& connection, const v1::Job& job) {
    JobReport report;
    v1::Map map;
    const grpc::Status status = find_map(connection, job, map);
    // One that is not kept any more has no say.
    if (!status.ok() && status.error_code() != grpc::StatusCode::NOT_FOUND)
        return tl::unexpected(connection.failure(status));
    report.map_warnings.assign(map.warnings().begin(), map.warnings().end());
    const auto listed =
        for_each_sector(connection, job.name(), [&](const v1::Sector& sector) { report.add(sector); });
    if (!listed)
        return tl::unexpected(listed.error());
    return report;
}

}  // namespace

cli::Result<JobReport> read_report(const ServerConnection& connection, const v1::Job& job) {
    Reconnection reconnection(connection.options.server);
    for (;;) {
        auto report = read_once(connection, job);
        if (report || !report.error().may_pass || !reconnection.try_again(false))
            return report;
    }
}

}  // namespace drtv::client
