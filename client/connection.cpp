#include "client/connection.h"

#include "client/server_file.h"
#include "drtv/v1/error.pb.h"
#include "format/folder/whole_file.h"

#include <drtv/version.h>

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <optional>
#include <utility>

namespace drtv::client {
namespace {

using Credentials = std::shared_ptr<grpc::ChannelCredentials>;

cli::Result<std::string> read_pem(const std::string& path) {
    if (path.empty())
        return cli::fail(cli::exit_usage, "TLS needs all three of --tls-ca, --tls-cert and --tls-key");
    auto text = folder::read_whole(path);
    if (text && text->find("-----BEGIN ") == std::string::npos)
        return cli::fail(cli::exit_invalid, path + " is no PEM file");
    return text;
}

cli::Result<Credentials> credentials(const ConnectionOptions& options) {
    if (options.tls_ca.empty() && options.tls_key.empty() && options.tls_certificate.empty())
        return grpc::InsecureChannelCredentials();
    grpc::SslCredentialsOptions tls;
    const std::initializer_list<std::pair<const std::string*, std::string*>> files = {
        {&options.tls_ca, &tls.pem_root_certs},
        {&options.tls_key, &tls.pem_private_key},
        {&options.tls_certificate, &tls.pem_cert_chain}};
    for (const auto& [path, text] : files) {
        auto read = read_pem(*path);
        if (!read)
            return tl::unexpected(read.error());
        *text = std::move(*read);
    }
    return grpc::SslCredentials(tls);
}

bool is_loopback(const std::string& address) {
    return address.starts_with("127.") || address.starts_with("localhost:") || address.starts_with("[::1]") ||
           address.starts_with("unix:");
}

grpc::ChannelArguments channel_arguments(const std::string& address) {
    grpc::ChannelArguments arguments;
    // A restarted daemon is found again within a second.
    arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
    arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1000);
    // A page of sectors may have many warnings.
    arguments.SetMaxReceiveMessageSize(-1);
    // A connection that is dead without a word is noticed (the server allows as many pings: server.cpp).
    arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 10'000);
    arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
    arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
    // http_proxy in the environment is not meant for this machine itself.
    if (is_loopback(address))
        arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
    return arguments;
}

// "0.1.0" -> 0, 1; nothing where it is no version.
std::optional<std::pair<int, int>> major_and_minor(const std::string& version) {
    int major = 0;
    int minor = 0;
    char rest = 0;
    if (std::sscanf(version.c_str(), "%d.%d%c", &major, &minor, &rest) < 2)
        return std::nullopt;
    return std::pair(major, minor);
}

// What gRPC says of a way that leads nowhere, in our words.
std::string unreachable(const std::string& server, const std::string& message) {
    const auto says = [&](const char* text) { return message.find(text) != std::string::npos; };
    if (says("andshake failed"))
        return fmt::format(
            "cannot reach bakerd at {}: the TLS handshake failed; does it use TLS, and do the "
            "certificates fit?",
            server);
    if (says("DNS resolution failed"))
        return fmt::format("cannot reach bakerd at {}: there is no such host", server);
    if (says("Connection refused"))
        return fmt::format("cannot reach bakerd at {}: is it running?", server);
    if (says("Socket closed") || says("Connection reset"))
        return fmt::format(
            "cannot reach bakerd at {}: it closed the connection; does it use TLS, or is it stopping?",
            server);
    return fmt::format("cannot reach bakerd at {}: it does not answer; is it running?", server);
}

}  // namespace

cli::Failure ServerConnection::failure(const grpc::Status& status, cli::ExitCode invalid) const {
    if (interrupted())
        return {cli::exit_interrupted, "interrupted"};
    // What bakerd says itself has details; all else comes from the way to it.
    v1::ErrorDetails details;
    const bool from_server =
        details.ParseFromString(status.error_details()) && !details.server_version().empty();
    if (!from_server && time_is_over())
        return {cli::exit_timeout,
                fmt::format("the time is over, and bakerd at {} had not answered", options.server)};
    if (!from_server && status.error_code() == grpc::StatusCode::UNAVAILABLE)
        return {cli::exit_server, unreachable(options.server, status.error_message()), true};
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
        case grpc::StatusCode::FAILED_PRECONDITION:
            return {cli::exit_usage, status.error_message()};
        case grpc::StatusCode::DATA_LOSS:
            return {cli::exit_unreadable, status.error_message()};
        default:
            return {cli::exit_server, status.error_message()};
    }
}

cli::Result<ServerConnection> connect(const ConnectionOptions& given) {
    const auto options = with_server_file(given, server_file_path());
    if (!options)
        return tl::unexpected(options.error());
    const auto secured = credentials(*options);
    if (!secured)
        return tl::unexpected(secured.error());
    const auto channel =
        grpc::CreateCustomChannel(options->server, *secured, channel_arguments(options->server));
    ServerConnection connection;
    connection.options = *options;
    connection.info = v1::Info::NewStub(channel);
    connection.blobs = v1::Blobs::NewStub(channel);
    connection.maps = v1::Maps::NewStub(channel);
    connection.jobs = v1::Jobs::NewStub(channel);
    connection.sectors = v1::Sectors::NewStub(channel);
    connection.cache = v1::Cache::NewStub(channel);
    return connection;
}

cli::Result<void> check_server(ServerConnection& connection) {
    catch_interrupt();
    const grpc::Status status =
        call(*connection.info, &v1::Info::Stub::GetServerInfo, v1::GetServerInfoRequest(), connection.server);
    const bool is_older = status.error_code() == grpc::StatusCode::UNIMPLEMENTED;
    if (!status.ok() && !is_older)
        return tl::unexpected(connection.failure(status));
    const std::string& theirs = connection.server.version();
    const auto server = major_and_minor(theirs);
    const auto client = std::pair(DRTV_VERSION_MAJOR, DRTV_VERSION_MINOR);
    if (server && server->first == client.first && std::abs(server->second - client.second) <= 1)
        return {};
    return cli::fail(
        cli::exit_server,
        fmt::format(
            "bakerd at {} is version {}, and this bake is {}: they are more than one minor version apart",
            connection.options.server,
            is_older ? "0.1.0 or older" : theirs,
            DRTV_VERSION));
}

std::string job_resource(const std::string& argument) {
    return argument.starts_with("jobs/") ? argument : "jobs/" + argument;
}

}  // namespace drtv::client
