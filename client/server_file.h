// Servers by name, in a file of the user.
#pragma once

#include "client/connection.h"

#include <string>

namespace drtv::client {

// $DRTV_CONFIG, else drtv/bake.toml below $XDG_CONFIG_HOME or ~/.config. Empty where none of them says a
// place.
[[nodiscard]] std::string server_file_path();

// Takes the place of a name given as `server` by what the file says of it, and fills in what is empty;
// without a server, that of the file's `server`, or the default address. Options that are given stay.
//
//     server = "farm"
//     [farm]
//     address = "farm.studio:7447"
//     tls-ca = "/etc/drtv/ca.pem"
[[nodiscard]] cli::Result<ConnectionOptions> with_server_file(ConnectionOptions options,
                                                              const std::string& path);

}  // namespace drtv::client
