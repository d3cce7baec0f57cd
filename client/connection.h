// The way to the daemon: one channel, the five services, statuses told as sentences.
#pragma once

#include "drtv/v1/blob.grpc.pb.h"
#include "drtv/v1/cache.grpc.pb.h"
#include "drtv/v1/job.grpc.pb.h"
#include "drtv/v1/map.grpc.pb.h"
#include "drtv/v1/sector.grpc.pb.h"
#include "format/cli/failure.h"

#include <memory>
#include <string>

namespace drtv::client {

struct ConnectionOptions {
    std::string server = "127.0.0.1:7447";
    // PEM files; all or none.
    std::string tls_ca;
    std::string tls_certificate;
    std::string tls_key;
    bool json = false;  // one object per line on standard output
};

struct ServerConnection {
    ConnectionOptions options;
    std::unique_ptr<v1::Blobs::Stub> blobs;
    std::unique_ptr<v1::Maps::Stub> maps;
    std::unique_ptr<v1::Jobs::Stub> jobs;
    std::unique_ptr<v1::Sectors::Stub> sectors;
    std::unique_ptr<v1::Cache::Stub> cache;

    // What a status that is not OK means for the program: the server's own sentence, or that it cannot be
    // reached. `invalid`: the exit code where the server found what it was sent invalid.
    [[nodiscard]] cli::Failure failure(const grpc::Status& status,
                                       cli::ExitCode invalid = cli::exit_usage) const;
};

[[nodiscard]] cli::Result<ServerConnection> connect(const ConnectionOptions& options);

// "12" or "jobs/12" -> "jobs/12".
[[nodiscard]] std::string job_resource(const std::string& argument);

}  // namespace drtv::client
