// Sets of sectors that tests ask.
#pragma once

#include <drtv/sector.h>
#include <drtv/sector_set.h>
#include <drtv/volume.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace drtv::test {

// A set with its memory, and the bytes of what it holds.
class OwnedSet {
  public:
    explicit OwnedSet(const SectorSetLimits& limits = {});

    SectorSet& operator*() { return *set_; }
    const SectorSet& operator*() const { return *set_; }
    SectorSet* operator->() { return set_.get(); }
    // Written, opened, kept.
    const LoadedSector& add(const Sector& sector);

  private:
    std::vector<std::byte> memory_;
    std::unique_ptr<SectorSet> set_;
    std::vector<std::unique_ptr<std::vector<std::uint8_t>>> files_;
};

class OwnedRelit {
  public:
    explicit OwnedRelit(const SectorSetLimits& limits, bool with_fade = false);

    RelitProbes& operator*() { return *relit_; }
    RelitProbes* operator->() { return relit_.get(); }

  private:
    std::vector<std::byte> memory_;
    std::unique_ptr<RelitProbes> relit_;
};

// A volume whose texels were poisoned before anything was written.
class OwnedVolume {
  public:
    OwnedVolume(const VolumeSettings& settings, const SectorSetLimits& limits, int poison = 0xA5);

    Volume& operator*() { return *volume_; }
    Volume* operator->() { return volume_.get(); }

  private:
    std::vector<std::byte> memory_;
    std::unique_ptr<Volume> volume_;
};

// A sector with one probe in the middle of each of `side` x `side` squares, `height` metres above 0, whose
// cells name the nearest; all transfer black and all sky visible. REQUIRES: side is 1, 2, 4 or 8.
[[nodiscard]] Sector lattice_sector(SectorId id, std::size_t side, double height_m);

// Transfer of an endless plane of this albedo, to all probes.
void put_on_plane(Sector& sector, const Float3& albedo);

}  // namespace drtv::test
