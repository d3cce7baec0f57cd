#include "client/connection.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

namespace drtv::client {
namespace {

using Credentials = std::shared_ptr<grpc::ChannelCredentials>;

tl::expected<void, std::string> read_pem(const std::string& path, std::string& text) {
    if (path.empty())
        return tl::unexpected(std::string("TLS needs all three of --tls-ca, --tls-cert and --tls-key"));
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return tl::unexpected(fmt::format("cannot read {}: {}", path, std::strerror(errno)));
    text.assign(std::istreambuf_iterator<char>(file), {});
    return {};
}

tl::expected<Credentials, std::string> credentials(const ConnectionOptions& options) {
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

std::string Connection::sentence(const grpc::Status& status) const {
    const std::string message = status.error_message();
    const bool is_away = status.error_code() == grpc::StatusCode::UNAVAILABLE;
    const bool says_it_stops = message.find("stopping") != std::string::npos;
    if (is_away && !says_it_stops)
        return fmt::format("cannot reach bakerd at {}: is it running?", options.server);
    if (message.empty())
        return fmt::format("bakerd answered with status {}", static_cast<int>(status.error_code()));
    return message;
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

void warn(const std::string& sentence) {
    std::fprintf(stderr, "bake: warning: %s\n", sentence.c_str());
}

std::string job_resource(const std::string& argument) {
    return argument.starts_with("jobs/") ? argument : "jobs/" + argument;
}

}  // namespace drtv::client
