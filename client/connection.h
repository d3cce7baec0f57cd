// The way to the daemon: one channel, the services, statuses told as sentences.
#pragma once

#include "client/interrupt.h"
#include "drtv/v1/blob.grpc.pb.h"
#include "drtv/v1/cache.grpc.pb.h"
#include "drtv/v1/info.grpc.pb.h"
#include "drtv/v1/job.grpc.pb.h"
#include "drtv/v1/map.grpc.pb.h"
#include "drtv/v1/sector.grpc.pb.h"
#include "format/cli/failure.h"

#include <grpcpp/client_context.h>

#include <memory>
#include <string>

namespace drtv::client {

struct ConnectionOptions {
    std::string server;  // an address, or a name in the client's file
    // PEM files; all or none.
    std::string tls_ca;
    std::string tls_certificate;
    std::string tls_key;
    bool json = false;  // one object per line on standard output
};

struct ServerConnection {
    ConnectionOptions options;  // `server` is the address
    v1::ServerInfo server;
    std::unique_ptr<v1::Info::Stub> info;
    std::unique_ptr<v1::Blobs::Stub> blobs;
    std::unique_ptr<v1::Maps::Stub> maps;
    std::unique_ptr<v1::Jobs::Stub> jobs;
    std::unique_ptr<v1::Sectors::Stub> sectors;
    std::unique_ptr<v1::Cache::Stub> cache;

    // What a status that is not OK means for the program: the server's own sentence, that it cannot be
    // reached, or ctrl-C. `invalid`: the exit code where the server found what it was sent invalid.
    [[nodiscard]] cli::Failure failure(const grpc::Status& status,
                                       cli::ExitCode invalid = cli::exit_usage) const;
};

// One call that ctrl-C ends.
template <class Stub, class Request, class Response>
[[nodiscard]] grpc::Status call(Stub& stub,
                                grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                                const Request& request,
                                Response& response) {
    grpc::ClientContext context;
    const InterruptGuard guard(context);
    return (stub.*method)(&context, request, &response);
}

// Calls nobody yet.
[[nodiscard]] cli::Result<ServerConnection> connect(const ConnectionOptions& options);

// To be asked before all other calls. From here on ctrl-C is caught (interrupt.h). Fails where the server
// cannot be reached, or is of a version that this client does not work with.
[[nodiscard]] cli::Result<void> check_server(ServerConnection& connection);

// "12" or "jobs/12" -> "jobs/12".
[[nodiscard]] std::string job_resource(const std::string& argument);

}  // namespace drtv::client
