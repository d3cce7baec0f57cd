// Checking sector files for `drtv validate`: each by itself, then those of a folder against each other.
#pragma once

#include "cli/failure.h"

#include <drtv/validate.h>
#include <drtv/validate_region.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace drtv::tool {

struct CheckedFile {
    std::string path;
    std::optional<std::array<std::int32_t, 2>> named;  // the sector that its name tells
    std::optional<cli::Failure> unreadable;            // else the rest holds
    Report report;
    std::optional<RegionSector> region;  // what its neighbours are held against, where it can be read
};

enum class FolderState {
    whole,        // its manifest lists what is there
    no_manifest,  // it was not pulled
    pulling,      // a pull has begun, and not come to its end
    unfinished,   // the job had not ended
    wrong,        // its manifest says something else than is there
};

struct CheckedFolder {
    std::string folder;
    FolderState state = FolderState::whole;
    std::vector<cli::Failure> problems;  // why it is not whole
};

// Not checked yet.
[[nodiscard]] CheckedFile file_to_check(const std::string& path);

// Each file by itself, on all cores. Keeps what `check_regions` needs where `for_regions` says so.
void check_files(std::vector<CheckedFile>& files, const ValidateOptions& options, bool for_regions);

// The files of each folder against each other; adds to their reports. What cannot be read counts as there by
// its name. Gives the number of folders. REQUIRES: check_files looked at all, for regions.
std::size_t check_regions(std::vector<CheckedFile>& files, const ValidateOptions& options);

}  // namespace drtv::tool
