// The daemon's listening side: services, health, reflection.
#pragma once

#include "bakerd/farm/farm.h"

#include <cstdint>
#include <memory>
#include <string>

#include <tl/expected.hpp>

namespace drtv::service {

struct TlsFiles {
    std::string certificate, key, client_ca;  // all or none; with them, clients must show a certificate
};

// What clients are told of this program.
struct BuildInfo {
    std::string instruction_set;
    std::uint32_t baker_version = 0;
};

class Server {
  public:
    // Listens at once. A sentence when the address is wrong or taken, or a TLS file cannot be read.
    [[nodiscard]] static tl::expected<std::unique_ptr<Server>, std::string> start(farm::Farm& farm,
                                                                                  const std::string& address,
                                                                                  const TlsFiles& tls,
                                                                                  const BuildInfo& build);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    // The address with the port in use, for ":0".
    [[nodiscard]] std::string address() const;

    // Refuses new calls, lets running ones finish for a moment, then ends them.
    void stop();

  private:
    struct State;
    explicit Server(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace drtv::service
