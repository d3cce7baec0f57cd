#include "tests/format/golden_files.h"

#include "tests/format/sectors.h"

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
    one.*section = sector.*section;
    return one;
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
            {"format_1_2_zstd", golden_sector_1_2(), Codec::zstd}};
}

}  // namespace drtv::test
