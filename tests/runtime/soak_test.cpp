// Ten thousand steps of a game that does everything in any order: nothing that was never written is read,
// nothing is black, no number is none.
#include "tests/format/sectors.h"
#include "tests/runtime/sets.h"

#include <drtv/ambient.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <vector>

namespace drtv {
namespace {

constexpr SectorSetLimits limits{.sectors = 24, .probes = 24 * 64, .interiors = 64, .tiles = 20};
constexpr std::array<int, 2> poisons = {0xA5, 0xFF};  // as halves 0xFFFF is not a number

std::vector<std::byte> poisoned(std::size_t bytes, int poison) {
    return std::vector<std::byte>(bytes, static_cast<std::byte>(poison));
}

// Random probes with a little sky each, so that no place is black.
std::vector<std::uint8_t> random_file(SectorId id) {
    Sector sector = test::random_sector_1_2(static_cast<std::uint32_t>(id.i * 131 + id.j * 17 + 900), 20);
    sector.i = id.i;
    sector.j = id.j;
    // Local transfer of neighbours that are other than these would name probes that are not there.
    sector.local_transfer.reset();
    sector.convergence.reset();
    sector.static_irradiance.clear();  // of any brightness
    for (Probe& probe : sector.probes) {
        probe.sky_visibility = {20000, 20000, 20000, 0};
        for (auto& channel : probe.transfer)
            for (auto& direction : channel)
                direction = {900, 0, 0, 0};
    }
    for (std::size_t n = 0; n < grid_cell_count; n += 7)
        sector.grid.cells[n] = no_probe;
    return write_sector(sector);
}

class Game {
  public:
    Game(const VolumeSettings& settings, int poison)
        : set_memory_(poisoned(SectorSet::memory_bytes(limits), poison)),
          relit_memory_(poisoned(RelitProbes::memory_bytes(limits, true), poison)),
          volume_memory_(poisoned(Volume::memory_bytes(settings, limits), poison)),
          set_(set_memory_, limits),
          relit_(relit_memory_, limits, true),
          volume_(volume_memory_, settings, limits) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto texels = volume_.texels(k);
            std::memset(const_cast<std::byte*>(texels.data()), poison, texels.size());
        }
        for (int j = -3; j < 3; ++j) {
            for (int i = -3; i < 3; ++i)
                files_[{i, j}] = random_file({i, j});
        }
        light_.sky = constant_sky({1, 1, 1});
        light_.sun = {{1, 1, 1}, {0.3f, 0.2f, 1}};
        relit_.set_light(Shown::now, light_);
        relit_.set_light(Shown::next, light_);
    }

    void step() {
        switch (one_of(10)) {
            case 0: {
                const LoadedSector* loaded = nullptr;
                const auto status = set_.load(files_[{one_of(6) - 3, one_of(6) - 3}], &loaded);
                if (status == LoadStatus::loaded && one_of(4) != 0) {
                    relit_.relight(Shown::now, *loaded, light_, lamps_);
                    relit_.relight(Shown::next, *loaded, light_, lamps_);
                }
                break;
            }
            case 1:
                set_.drop({one_of(6) - 3, one_of(6) - 3});
                break;
            case 2:
                set_.retire();
                break;
            case 3:
                camera_ = {one_of(400) - 200.0, one_of(400) - 200.0, one_of(60) - 30.0};
                break;
            case 4: {
                constexpr std::array<double, 4> odd = {1e9, -1e300, std::numeric_limits<double>::quiet_NaN(),
                                                       1e6};
                camera_[static_cast<std::size_t>(one_of(3))] = odd[static_cast<std::size_t>(one_of(4))];
                break;
            }
            case 5: {
                std::array<LightShare, max_shares_per_light> shares;
                const PointLight lamp{place(), {1, 0.5f, 2}};
                const std::size_t count = split_light(set_, lamp, shares);
                lamps_.assign(shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(count));
                break;
            }
            case 6:
                relit_.set_fade(static_cast<float>(one_of(5)) / 4);
                break;
            default:
                for (double& axis : camera_)
                    axis += one_of(9) - 4;
        }
        volume_.update(set_, relit_, camera_);
    }

    void look() {
        for (int n = 0; n < 2; ++n) {
            AmbientPlace asked;
            asked.at = place();
            asked.normal = {0.6f, 0, one_of(2) == 0 ? 0.8f : -0.8f};
            asked.offset_m = one_of(2) == 0 ? 0.0f : 1.0f;
            asked.interiors = volume_.settings().outdoors;
            expect_light(ambient_at(set_, light_, lamps_, asked), asked.at);
            expect_light(ambient_in(volume_, set_, light_, lamps_, asked), asked.at);
            const Volume::Sample sample = volume_.sample(asked.at);
            for (const Float3& colour : sample.colours) {
                for (const float channel : colour)
                    ASSERT_TRUE(channel >= 0 && channel < 20) << channel;
            }
        }
    }

    // Written as a whole anew, it stays the same.
    void expect_written() {
        std::array<std::vector<std::byte>, 3> before;
        for (std::size_t k = 0; k < 3; ++k)
            before[k].assign(volume_.texels(k).begin(), volume_.texels(k).end());
        volume_.update_all(set_, relit_, camera_);
        for (std::size_t k = 0; k < 3; ++k)
            ASSERT_TRUE(std::ranges::equal(before[k], volume_.texels(k)));
    }

  private:
    int one_of(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }
    // In the window or anywhere.
    Double3 place() {
        const bool near = one_of(2) == 0 && std::abs(camera_[0]) < 300 && std::abs(camera_[1]) < 300;
        const int reach = near ? 40 : 210;
        const auto from = [&](double middle) {
            return (near ? middle : 0) + one_of(20 * reach) / 10.0 - reach;
        };
        return {from(camera_[0]), from(camera_[1]), one_of(400) / 10.0 - 20};
    }

    static void expect_light(const Ambient& ambient, const Double3& at) {
        for (const float channel : ambient.colour)
            ASSERT_TRUE(channel > 0 && channel < 20)
                << channel << " at " << at[0] << ", " << at[1] << ", " << at[2];
    }

    std::map<std::pair<int, int>, std::vector<std::uint8_t>> files_;
    std::vector<std::byte> set_memory_;
    std::vector<std::byte> relit_memory_;
    std::vector<std::byte> volume_memory_;
    SectorSet set_;
    RelitProbes relit_;
    Volume volume_;
    SceneLight light_;
    std::vector<LightShare> lamps_;
    Double3 camera_{};
    std::mt19937 engine_{11};
};

TEST(Soak, NothingUnwrittenIsReadAndNothingIsBlack) {
    constexpr int steps = 10000;
    const VolumeSettings small{.size = {20, 24, 8}, .encoding = TexelEncoding::rgba16f};
    VolumeSettings outdoors = small;
    outdoors.outdoors = true;
    VolumeSettings blurred = small;
    blurred.blur = true;
    for (const VolumeSettings& settings : {small, outdoors, blurred}) {
        for (const int poison : poisons) {
            Game game(settings, poison);
            for (int step = 0; step < steps / 6; ++step) {
                game.step();
                game.look();
                if (step % 20 == 0)
                    game.expect_written();
                if (HasFatalFailure())
                    FAIL() << "step " << step << ", poison " << poison;
            }
        }
    }
}

}  // namespace
}  // namespace drtv
