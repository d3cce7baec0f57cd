#include "client/connection.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

namespace drtv::client {
namespace {

tl::expected<std::string, std::string> read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return tl::unexpected(fmt::format("cannot read {}: {}", path, std::strerror(errno)));
    return std::string(std::istreambuf_iterator<char>(file), {});
}

tl::expected<std::shared_ptr<grpc::ChannelCredentials>, std::string> credentials(
    const ConnectionOptions& options) {
    const std::array<std::string, 3> paths = {options.tls_ca, options.tls_key, options.tls_certificate};
    if (paths[0].empty() && paths[1].empty() && paths[2].empty())
        return grpc::InsecureChannelCredentials();
    std::array<std::string, 3> texts;
    for (std::size_t n = 0; n < paths.size(); ++n) {
        if (paths[n].empty())
            return tl::unexpected(std::string("TLS needs all three of --tls-ca, --tls-cert and --tls-key"));
        auto text = read_text(paths[n]);
        if (!text)
            return tl::unexpected(text.error());
        texts[n] = std::move(*text);
    }
    return grpc::SslCredentials({texts[0], texts[1], texts[2]});
}

}  // namespace

std::string Connection::sentence(const grpc::Status& status) const {
    const bool unreached = status.error_code() == grpc::StatusCode::UNAVAILABLE &&
                           status.error_message().find("stopping") == std::string::npos;
    if (unreached)
        return fmt::format("cannot reach bakerd at {}: is it running?", options.server);
    return status.error_message().empty()
               ? fmt::format("bakerd answered with status {}", static_cast<int>(status.error_code()))
               : status.error_message();
}

tl::expected<Connection, std::string> connect(const ConnectionOptions& options) {
    const auto secured = credentials(options);
    if (!secured)
        return tl::unexpected(secured.error());
    grpc::ChannelArguments arguments;
    // A restarted daemon is found again within a second.
    arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
    arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1000);
    const auto channel = grpc::CreateCustomChannel(options.server, *secured, arguments);
    Connection connection;
    connection.options = options;
    connection.blobs = v1::Blobs::NewStub(channel);
    connection.maps = v1::Maps::NewStub(channel);
    connection.jobs = v1::Jobs::NewStub(channel);
    connection.sectors = v1::Sectors::NewStub(channel);
    connection.cache = v1::Cache::NewStub(channel);
    return connection;
}

int complain(const std::string& sentence) {
    std::fprintf(stderr, "bake: %s\n", sentence.c_str());
    return 1;
}

std::string job_resource(const std::string& argument) {
    return argument.starts_with("jobs/") ? argument : "jobs/" + argument;
}

}  // namespace drtv::client
