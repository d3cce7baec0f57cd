// The manifest of a folder, as map, job and server make it.
#pragma once

#include "client/connection.h"
#include "format/cli/failure.h"
#include "format/folder/manifest.h"

#include <optional>
#include <string>

namespace drtv::client {

// Without files.
[[nodiscard]] folder::FolderManifest manifest_of(const v1::Map& map,
                                                 const v1::Job& job,
                                                 const v1::ServerInfo& server);

// The manifest that a pull of the map finds in the folder. Fails where it is of another map and does not say
// `replace`; then nothing is to be written there.
[[nodiscard]] cli::Result<std::optional<folder::FolderManifest>> earlier_manifest(const std::string& folder,
                                                                                  const v1::Map& map,
                                                                                  bool replace);

}  // namespace drtv::client
