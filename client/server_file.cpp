#include "client/server_file.h"

#include "format/spelling/suggestion.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace drtv::client {
namespace {

constexpr const char* default_address = "127.0.0.1:7447";

using Entry = std::map<std::string, std::string>;

struct ServerFile {
    std::string server;  // the one that counts where none is named
    std::map<std::string, Entry> entries;
};

cli::Result<ServerFile> read_server_file(const std::string& path) {
    std::ifstream file(path);
    if (!file)
        return cli::fail(cli::exit_unreadable, fmt::format("cannot read {}: {}", path, std::strerror(errno)));
    ServerFile found;
    try {
        for (const CLI::ConfigItem& item : CLI::ConfigTOML().from_config(file)) {
            if (item.name == "++" || item.name == "--")
                continue;  // a section begins or ends
            const bool is_known = item.parents.empty()
                                      ? item.name == "server"
                                      : item.name == "address" || item.name == "tls-ca" ||
                                            item.name == "tls-cert" || item.name == "tls-key";
            if (item.parents.empty() && item.name == "address")
                return cli::fail(
                    cli::exit_usage,
                    fmt::format("{}: a server cannot be called 'default': give it another name", path));
            if (!is_known || item.inputs.size() != 1 || item.parents.size() > 1)
                return cli::fail(
                    cli::exit_usage,
                    fmt::format("{}: '{}' is not known there: a [NAME] has address, tls-ca, tls-cert and "
                                "tls-key, and server = NAME stands above all",
                                path,
                                item.fullname()));
            if (item.parents.empty())
                found.server = item.inputs[0];
            else
                found.entries[item.parents[0]][item.name] = item.inputs[0];
        }
    } catch (const CLI::Error& error) {
        return cli::fail(cli::exit_usage, fmt::format("{}: {}", path, error.what()));
    }
    return found;
}

bool is_address(const std::string& server) {
    return server.find(':') != std::string::npos;
}

// HOST:PORT, or what gRPC knows besides: unix:PATH.
bool is_well_formed(const std::string& address) {
    if (address.starts_with("unix:"))
        return true;
    const std::size_t colon = address.rfind(':');
    int port = 0;
    const char* const end = address.data() + address.size();
    const auto [stopped, error] = std::from_chars(address.data() + colon + 1, end, port);
    return colon > 0 && error == std::errc() && stopped == end && port > 0 && port <= 65535 &&
           address.find('/') == std::string::npos;
}

cli::Result<ConnectionOptions> checked(ConnectionOptions options) {
    if (is_well_formed(options.server))
        return options;
    return cli::fail(
        cli::exit_usage,
        fmt::format("the server '{}' is not HOST:PORT, with a port from 1 to 65535", options.server));
}

void fill_in(std::string& value, const Entry& entry, const std::string& key) {
    if (const auto found = entry.find(key); value.empty() && found != entry.end())
        value = found->second;
}

}  // namespace

std::string server_file_path() {
    if (const char* path = std::getenv("DRTV_CONFIG"))
        return path;
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config != '\0')
        return std::string(config) + "/drtv/bake.toml";
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
        return std::string(home) + "/.config/drtv/bake.toml";
    return "";
}

cli::Result<ConnectionOptions> with_server_file(ConnectionOptions options, const std::string& path) {
    ServerFile file;
    std::error_code code;
    if (!path.empty() && std::filesystem::exists(path, code)) {
        auto read = read_server_file(path);
        if (!read)
            return tl::unexpected(read.error());
        file = std::move(*read);
    }
    if (options.server.empty())
        options.server = file.server.empty() ? default_address : file.server;
    const auto entry = file.entries.find(options.server);
    if (entry != file.entries.end()) {
        options.server.clear();
        fill_in(options.server, entry->second, "address");
        fill_in(options.tls_ca, entry->second, "tls-ca");
        fill_in(options.tls_certificate, entry->second, "tls-cert");
        fill_in(options.tls_key, entry->second, "tls-key");
        if (options.server.empty())
            return cli::fail(cli::exit_usage, fmt::format("{}: [{}] has no address", path, entry->first));
        return checked(std::move(options));
    }
    if (is_address(options.server))
        return checked(std::move(options));
    std::vector<std::string> names;
    for (const auto& [name, unused] : file.entries)
        names.push_back(name);
    return cli::fail(
        cli::exit_usage,
        spelling::with_hint(fmt::format("the server '{}' is neither HOST:PORT nor a name", options.server),
                            spelling::suggestion(options.server, names),
                            fmt::format("names stand in {}", path)));
}

}  // namespace drtv::client
