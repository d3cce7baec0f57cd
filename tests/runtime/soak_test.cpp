// Ten thousand steps of games that load, drop, relight, fade, move and place lamps in any order: nothing that
// was never written is read, nothing is black, no number is none.
#include "tests/format/sectors.h"
#include "tests/runtime/sets.h"

#include <drtv/ambient.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace drtv {
namespace {

constexpr SectorSetLimits limits{.sectors = 24, .probes = 24 * 64, .interiors = 64, .tiles = 20};
constexpr std::array<int, 2> poisons = {0xA5, 0xFF};  // as halves 0xFFFF is not a number

std::vector<std::byte> poisoned(std::size_t bytes, int poison) {
    return std::vector<std::byte>(bytes, static_cast<std::byte>(poison));
}

// Sixteen probes with some sky, transfer and local transfer each, a room that names one and holds others, and
// holes in the grid: over the heights at which the game moves.
std::vector<std::uint8_t> random_file(SectorId id) {
    std::mt19937 random(static_cast<std::uint32_t>(id.i * 131 + id.j * 17 + 900));
    const auto code = [&](int least, int most) {
        return static_cast<std::int16_t>(least +
                                         static_cast<int>(random() % static_cast<unsigned>(most - least)));
    };
    Sector sector = test::lattice_sector(id, 4, 2);
    sector.grid.z_origin_units = -20 * position_units_per_m;
    sector.grid.cell_height_units = 2560;
    for (std::size_t n = 0; n < grid_cell_count; ++n) {
        const bool in_hole = n % grid_size < 5 && n / grid_size % grid_size < 5;
        const bool named = !in_hole && random() % 7 != 0;
        sector.grid.cells[n] = named ? static_cast<std::uint8_t>(random() % 16) : no_probe;
    }
    for (Probe& probe : sector.probes) {
        const std::int16_t seen = code(4000, 32767);
        probe.sky_visibility = {seen, seen, seen, 0};
        for (auto& channel : probe.transfer) {
            for (auto& direction : channel)
                direction = {code(300, 3000), 0, code(-100, 100), code(-100, 100)};
        }
    }
    const auto corner = static_cast<std::int32_t>(random() % 30) * position_units_per_m;
    sector.interiors.push_back(test::box_interior({65536 * id.i + corner, 65536 * id.j + corner, -4096},
                                                  {0, 0, 0}, {20480, 20480, 12288}));
    sector.interiors.back().probe = static_cast<std::uint8_t>(random() % 16);
    LocalTransfer& local = sector.local_transfer.emplace();
    std::vector<std::size_t> all;
    for (std::uint8_t p = 0; p < 16; ++p) {
        local.sources.push_back({0, 0, p, 0});
        all.push_back(p);
    }
    local.receivers.resize(16);
    for (std::size_t p = 0; p < 16; ++p)
        test::add_pairs(local, p, all, {{{2000, 0, 0, 0}, {2000, 0, 0, 0}, {2000, 0, 0, 0}}});
    return write_sector(sector);
}

class Game {
  public:
    Game(const VolumeSettings& settings, int poison)
        : set_memory_(poisoned(SectorSet::memory_bytes(limits), poison)),
          relit_memory_(poisoned(RelitProbes::memory_bytes(limits, true), poison)),
          set_(set_memory_, limits),
          relit_(relit_memory_, limits, true),
          volume_(settings, limits, poison) {
        for (int j = -3; j < 3; ++j) {
            for (int i = -3; i < 3; ++i)
                files_[{i, j}] = random_file({i, j});
        }
        lights_[0].sky = constant_sky({1, 1, 1});
        lights_[1].sky = constant_sky({2, 1, 0.5f});
        for (SceneLight& light : lights_)
            light.sun = {{1, 1, 1}, {0.3f, 0.2f, 1}};
        relit_.set_light(Shown::now, lights_[0]);
        relit_.set_light(Shown::next, lights_[1]);
        volume_->set_scale(16);
    }

    void step() {
        switch (one_of(14)) {
            case 0: {
                const LoadedSector* loaded = nullptr;
                const auto status = set_.load(files_[{one_of(6) - 3, one_of(6) - 3}], &loaded);
                if (status == LoadStatus::loaded && one_of(4) != 0)
                    relight(*loaded);
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
            case 7:
                if (const LoadedSector* sector = set_.find({one_of(6) - 3, one_of(6) - 3}))
                    relight(*sector);
                break;
            case 8:
                relit_.finish_fade();
                std::swap(lights_[0], lights_[1]);
                break;
            case 9:
                volume_->set_scale(one_of(2) == 0 ? 16.0f : 32.0f);
                break;
            default:
                for (double& axis : camera_)
                    axis += one_of(9) - 4;
        }
        volume_->update(set_, relit_, camera_);
    }

    void look() {
        for (int n = 0; n < 2; ++n) {
            AmbientPlace asked;
            asked.at = place();
            asked.normal = {0.6f, 0, one_of(2) == 0 ? 0.8f : -0.8f};
            asked.offset_m = one_of(2) == 0 ? 0.0f : 1.0f;
            asked.interiors = volume_->settings().outdoors;
            expect_light(ambient_at(set_, lights_[0], lamps_, asked), asked.at);
            expect_light(ambient_in(*volume_, set_, lights_[0], lamps_, asked), asked.at);
            const Volume::Sample sample = volume_->sample(asked.at);
            for (const Float3& colour : sample.colours) {
                for (const float channel : colour)
                    ASSERT_TRUE(channel >= 0 && channel < 33) << channel;
            }
        }
    }

    // Written as a whole anew, it stays the same.
    void expect_written() {
        std::array<std::vector<std::byte>, 3> before;
        for (std::size_t k = 0; k < 3; ++k)
            before[k].assign(volume_->texels(k).begin(), volume_->texels(k).end());
        volume_->update_all(set_, relit_, camera_);
        for (std::size_t k = 0; k < 3; ++k)
            ASSERT_TRUE(std::ranges::equal(before[k], volume_->texels(k)));
    }

    // That the game came everywhere.
    void expect_all_seen() const {
        for (const int count : statuses_)
            EXPECT_GT(count, 20);
        EXPECT_GT(interiors_, 20);
        EXPECT_GT(lit_by_lamps_, 10);
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

    void relight(const LoadedSector& sector) {
        relit_.relight(Shown::now, sector, lights_[0], lamps_);
        relit_.relight(Shown::next, sector, lights_[1], lamps_);
    }

    void expect_light(const Ambient& ambient, const Double3& at) {
        ++statuses_[static_cast<std::size_t>(ambient.status)];
        interiors_ += ambient.interior.share > 0 ? 1 : 0;
        lit_by_lamps_ += ambient.parts.local[0] > 0 ? 1 : 0;
        for (const float channel : ambient.colour)
            ASSERT_TRUE(channel > 0 && channel < 33)
                << channel << " at " << at[0] << ", " << at[1] << ", " << at[2];
    }

    std::map<std::pair<int, int>, std::vector<std::uint8_t>> files_;
    std::vector<std::byte> set_memory_;
    std::vector<std::byte> relit_memory_;
    SectorSet set_;
    RelitProbes relit_;
    test::OwnedVolume volume_;
    std::array<SceneLight, 2> lights_;  // now and next
    std::vector<LightShare> lamps_;
    Double3 camera_{};
    std::mt19937 engine_{11};
    std::array<int, 4> statuses_{};
    int interiors_ = 0;
    int lit_by_lamps_ = 0;
};

TEST(Soak, NothingUnwrittenIsReadAndNothingIsBlack) {
    constexpr int steps = 10000;
    constexpr std::array<std::int32_t, 3> small = {20, 24, 8};
    const std::vector<VolumeSettings> volumes = {
        {.size = small, .encoding = TexelEncoding::rgba16f},
        {.size = small, .encoding = TexelEncoding::rgba16f, .outdoors = true},
        {.size = small, .encoding = TexelEncoding::rgba16f, .blur = true},
        {.size = small, .encoding = TexelEncoding::rgba8_sqrt, .atlas = true, .outdoors = true},
        {.size = small, .encoding = TexelEncoding::rgba8, .borders = false}};
    for (const VolumeSettings& settings : volumes) {
        for (const int poison : poisons) {
            Game game(settings, poison);
            for (int step = 0; step < steps / 10; ++step) {
                game.step();
                game.look();
                if (step % 20 == 0)
                    game.expect_written();
                if (HasFatalFailure())
                    FAIL() << "step " << step << ", poison " << poison;
            }
            if (settings.outdoors)
                game.expect_all_seen();
        }
    }
}

}  // namespace
}  // namespace drtv
