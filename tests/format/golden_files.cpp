#include "tests/format/golden_files.h"

#include "tests/format/sectors.h"

#include <random>

namespace drtv::test {
namespace {

// The sector with one of its optional sections.
template <class Section>
Sector only(Sector sector, Section Sector::*section) {
    Sector one = sector;
    one.static_irradiance.clear();
    one.local_transfer.reset();
    one.convergence.reset();
    one.interiors.clear();
    one.light_groups.clear();
    one.quality.reset();
    one.*section = sector.*section;
    return one;
}

// Local transfer of all that codes can be, valid or not, so that every rule of the filter shows in its bytes.
Sector sector_of_any_codes() {
    std::mt19937 random(12);
    Sector sector = golden_sector_1_2();
    sector.probes.resize(10, sector.probes[0]);
    sector.static_irradiance.clear();
    LocalTransfer& local = sector.local_transfer.emplace();
    local.sources = neighbouring_sources(12);
    local.receivers.resize(sector.probes.size());
    constexpr std::array<std::int16_t, 6> telling = {0, 1, -1, 32767, -32767, INT16_MIN};
    for (std::size_t p = 0; p < sector.probes.size(); ++p) {
        sector.probes[p].position[0] = static_cast<std::uint16_t>(6000 * p);
        for (std::size_t s = 0; s < local.sources.size(); ++s) {
            LightCodes codes{};
            const std::uint32_t mask = (2u << random() % 15) - 1,
                                shift = random() % 4 == 0 ? static_cast<std::uint32_t>(random() % 8) : 0;
            for (auto& channel : codes) {
                for (std::int16_t& q : channel) {
                    const auto number =
                        static_cast<std::int16_t>((static_cast<std::uint32_t>(random()) & mask) << shift);
                    q = random() % 16 == 0  ? telling[random() % telling.size()]
                        : random() % 3 == 0 ? static_cast<std::int16_t>(-number)
                                            : number;
                }
            }
            add_pairs(local, p, {s}, codes);
        }
    }
    return sector;
}

}  // namespace

std::vector<GoldenFile> golden_files() {
    return {{"format_1_0", golden_sector()},
            {"format_1_0_zstd", golden_sector(), Codec::zstd},
            {"format_1_1", golden_sector_1_1()},
            {"format_1_1_static_irradiance", only(golden_sector_1_1(), &Sector::static_irradiance)},
            {"format_1_1_local_transfer", only(golden_sector_1_1(), &Sector::local_transfer)},
            {"format_1_1_convergence", only(golden_sector_1_1(), &Sector::convergence)},
            {"format_1_2", golden_sector_1_2()},
            {"format_1_2_interiors", only(golden_sector_1_2(), &Sector::interiors)},
            {"format_1_2_zstd", golden_sector_1_2(), Codec::zstd},
            {"format_1_2_filtered", sector_of_any_codes(), Codec::zstd, false},
            {"format_1_3", golden_sector_1_3()},
            {"format_1_3_light_groups", only(golden_sector_1_3(), &Sector::light_groups)},
            {"format_1_3_local_transfer", only(golden_sector_1_3(), &Sector::local_transfer)},
            {"format_1_3_quality", only(golden_sector_1_3(), &Sector::quality)},
            {"format_1_3_zstd", golden_sector_1_3(), Codec::zstd}};
}

}  // namespace drtv::test
