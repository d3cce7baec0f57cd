// The sectors of a folder around some places, in memory as a game has them.
#pragma once

#include "cli/failure.h"

#include <drtv/sector_set.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drtv::kit {

// Calls use(sector) for each that is loaded.
template <class Use>
void for_each_sector(const SectorSet& set, const Use& use) {
    for (std::uint32_t slot = 0; slot < set.limits().sectors; ++slot) {
        if (const LoadedSector* sector = set.at(slot))
            use(*sector);
    }
}

// The sector (i, j) whose middle lies nearest to a place, of those that the files' headers name; nothing
// where there is none. Reads no more of them.
[[nodiscard]] std::optional<std::pair<std::int32_t, std::int32_t>> nearest_sector(const std::string& path,
                                                                                  double x,
                                                                                  double y);

// Half open.
struct WorldSquare {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

class SectorFolder {
  public:
    // Sectors up to this many away from a place's are loaded: all that can bear on it but far interiors.
    static constexpr int reach = 3;

    // Fails where the folder, or a sector that is wanted, cannot be read. Sectors that are not there are
    // none.
    [[nodiscard]] cli::Result<void> load(const std::string& path, const std::vector<Double3>& places);
    // The same of sectors that come within a square of the world, metres.
    [[nodiscard]] cli::Result<void> load(const std::string& path, const WorldSquare& square);

    // REQUIRES: loaded.
    [[nodiscard]] const SectorSet& set() const { return *set_; }

  private:
    template <class IsWanted>
    [[nodiscard]] cli::Result<void> load_if(const std::string& path, const IsWanted& is_wanted);

    std::vector<std::vector<std::uint8_t>> files_;  // raw
    std::vector<std::byte> memory_;
    std::unique_ptr<SectorSet> set_;
};

}  // namespace drtv::kit
