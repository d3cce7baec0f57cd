#include "client/connection.h"

#include "drtv/v1/error.pb.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

namespace drtv::client {
namespace {

using Credentials = std::shared_ptr<grpc::ChannelCredentials>;

cli::Result<void> read_pem(const std::string& path, std::string& text) {
    if (path.empty())
        return cli::fail(cli::exit_usage, "TLS needs all three of --tls-ca, --tls-cert and --tls-key");
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return cli::fail(cli::exit_unreadable, fmt::format("cannot read {}: {}", path, std::strerror(errno)));
    text.assign(std::istreambuf_iterator<char>(file), {});
    return {};
}

cli::Result<Credentials> credentials(const ConnectionOptions& options) {
    if (options.tls_ca.empty() && options.tls_key.empty() && options.tls_certificate.empty())
        return grpc::InsecureChannelCredentials();
    grpc::SslCredentialsOptions tls;
    if (auto read = read_pem(options.tls_ca, tls.pem_root_certs); !read)
        return tl::unexpected(read.error());
    if (auto read = read_pem(options.tls_key, tls.pem_private_key); !read)
        return tl::unexpected(read.error());
    if (auto read = read_pem(options.tls_certificate, tls.pem_cert_chain); !read)
        return tl::unexpected(read.error());
    return grpc::SslCredentials(tls);
}

}  // namespace

cli::Failure ServerConnection::failure(const grpc::Status& status, cli::ExitCode invalid) const {
    // What bakerd says itself has details; all else comes from the way to it.
    v1::ErrorDetails details;
    const bool from_server =
        details.ParseFromString(status.error_details()) && !details.server_version().empty();
    if (!from_server && status.error_code() == grpc::StatusCode::UNAVAILABLE)
        return {cli::exit_server, fmt::format("cannot reach bakerd at {}: is it running?", options.server)};
    if (!from_server) {
        const int code = static_cast<int>(status.error_code());
        return {
            cli::exit_server,
            fmt::format(
                "a call to {} failed: {} (gRPC status {})", options.server, status.error_message(), code)};
    }
    switch (status.error_code()) {
        case grpc::StatusCode::INVALID_ARGUMENT:
            return {invalid, status.error_message()};
        case grpc::StatusCode::NOT_FOUND:
            return {cli::exit_usage, status.error_message()};
        case grpc::StatusCode::DATA_LOSS:
            return {cli::exit_unreadable, status.error_message()};
        default:
            return {cli::exit_server, status.error_message()};
    }
}

cli::Result<ServerConnection> connect(const ConnectionOptions& options) {
    const auto secured = credentials(options);
    if (!secured)
        return tl::unexpected(secured.error());
    grpc::ChannelArguments arguments;
    // A restarted daemon is found again within a second.
    arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
    arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1000);
    const auto channel = grpc::CreateCustomChannel(options.server, *secured, arguments);
    ServerConnection connection;
    connection.options = options;
    connection.blobs = v1::Blobs::NewStub(channel);
    connection.maps = v1::Maps::NewStub(channel);
    connection.jobs = v1::Jobs::NewStub(channel);
    connection.sectors = v1::Sectors::NewStub(channel);
    connection.cache = v1::Cache::NewStub(channel);
    return connection;
}

std::string job_resource(const std::string& argument) {
    return argument.starts_with("jobs/") ? argument : "jobs/" + argument;
}

}  // namespace drtv::client
