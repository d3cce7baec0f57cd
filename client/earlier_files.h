// What lies in a folder beside the files of a pull.
#pragma once

#include "format/folder/manifest.h"

#include <cstdint>
#include <string>

namespace drtv::client {

// Files of an earlier pull that are not of the new one: they stay, and the new manifest lists them with the
// map that they are of, or they are removed. Those that somebody has changed stay, with a warning, and no
// manifest lists them. The number of removed ones.
[[nodiscard]] std::int64_t settle_earlier_files(const std::string& folder,
                                                const folder::FolderManifest& earlier,
                                                bool stay,
                                                folder::FolderManifest& manifest);

// Files that no pull has listed, which a game would load all the same.
void warn_of_strangers(const std::string& folder, const folder::FolderManifest& manifest);

}  // namespace drtv::client
