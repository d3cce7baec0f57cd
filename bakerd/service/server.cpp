#include "bakerd/service/server.h"

#include "bakerd/service/services.h"

#include <fmt/format.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>

namespace drtv::service {
namespace {

constexpr int max_message_bytes = 4 << 20;

tl::expected<std::string, std::string> read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    // Of a folder, too, nothing comes.
    if (!file || !(text << file.rdbuf()))
        return tl::unexpected(fmt::format("cannot read {}: {}", path, std::strerror(errno)));
    return text.str();
}

tl::expected<std::shared_ptr<grpc::ServerCredentials>, std::string> credentials(const TlsFiles& tls) {
    if (tls.certificate.empty() && tls.key.empty() && tls.client_ca.empty())
        return grpc::InsecureServerCredentials();
    if (tls.certificate.empty() || tls.key.empty() || tls.client_ca.empty())
        return tl::unexpected(
            std::string("TLS needs all three of --tls-cert, --tls-key and --tls-client-ca"));
    std::array<std::string, 3> texts;
    const std::array<std::string, 3> paths = {tls.certificate, tls.key, tls.client_ca};
    for (std::size_t n = 0; n < paths.size(); ++n) {
        auto text = read_text(paths[n]);
        if (!text)
            return tl::unexpected(text.error());
        texts[n] = std::move(*text);
    }
    grpc::SslServerCredentialsOptions options(GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
    options.pem_key_cert_pairs.push_back({texts[1], texts[0]});
    options.pem_root_certs = texts[2];
    return grpc::SslServerCredentials(options);
}

// gRPC takes a port modulo 65536.
tl::expected<void, std::string> check_address(const std::string& address) {
    const std::size_t colon = address.rfind(':');
    const std::string port = colon == std::string::npos ? "" : address.substr(colon + 1);
    int number = -1;
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
    if (error == std::errc() && end == port.data() + port.size() && number >= 0 && number <= 65535 &&
        colon > 0)
        return {};
    return tl::unexpected(
        fmt::format("the address '{}' is not HOST:PORT with a port from 0 to 65535", address));
}

}  // namespace

struct Server::State {
    State(farm::Farm& farm, const BuildInfo& build)
        : info(build), blobs(farm), maps(farm), jobs(farm, stopping), sectors(farm), cache(farm) {}
    std::atomic<bool> stopping{false};
    InfoService info;
    BlobsService blobs;
    MapsService maps;
    JobsService jobs;
    SectorsService sectors;
    CacheService cache;
    std::string host;
    int port = 0;
    std::unique_ptr<grpc::Server> server;
};

Server::Server(std::unique_ptr<State> state) : state_(std::move(state)) {}

tl::expected<std::unique_ptr<Server>, std::string> Server::start(farm::Farm& farm,
                                                                 const std::string& address,
                                                                 const TlsFiles& tls,
                                                                 const BuildInfo& build) {
    if (auto checked = check_address(address); !checked)
        return tl::unexpected(checked.error());
    const auto secured = credentials(tls);
    if (!secured)
        return tl::unexpected(secured.error());
    grpc::EnableDefaultHealthCheckService(true);
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
    auto state = std::make_unique<State>(farm, build);
    state->host = address.substr(0, address.rfind(':'));
    grpc::ServerBuilder builder;
    // Two daemons on one port would share its calls by chance.
    builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
    builder.SetMaxReceiveMessageSize(max_message_bytes);
    // Clients ping a connection that is silent (client/connection.cpp); one that is dead frees its handlers.
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 5'000);
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 30'000);
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
    builder.AddListeningPort(address, *secured, &state->port);
    builder.RegisterService(&state->info);
    builder.RegisterService(&state->blobs);
    builder.RegisterService(&state->maps);
    builder.RegisterService(&state->jobs);
    builder.RegisterService(&state->sectors);
    builder.RegisterService(&state->cache);
    state->server = builder.BuildAndStart();
    if (!state->server || state->port == 0)
        return tl::unexpected(fmt::format(
            "cannot listen on {}: the port is in use, or the host is not an address of this machine",
            address));
    return std::unique_ptr<Server>(new Server(std::move(state)));
}

Server::~Server() {
    stop();
}

std::string Server::address() const {
    return fmt::format("{}:{}", state_->host, state_->port);
}

void Server::stop() {
    if (state_->stopping.exchange(true))
        return;
    if (auto* health = state_->server->GetHealthCheckService())
        health->SetServingStatus(false);
    state_->server->Shutdown(std::chrono::system_clock::now() + std::chrono::seconds(2));
    state_->server->Wait();
}

}  // namespace drtv::service
