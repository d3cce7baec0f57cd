// The whole validator on any bytes, alone and beside itself: a report, whose offsets lie in the file.
#include "tests/fuzz/sealed_mutator.h"

#include <drtv/validate.h>
#include <drtv/validate_region.h>

#include <cstdlib>

namespace {

void require(bool holds) {
    if (!holds)
        std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::uint8_t> bytes(data, size);
    const drtv::Report report = drtv::validate_sector(bytes, {.max_findings = 10});
    require(report.findings.size() <= 10 &&
            report.truncated == (report.errors + report.warnings > report.findings.size()));
    for (const drtv::Finding& finding : report.findings)
        require(finding.offset <= size && !finding.message.empty());

    drtv::RegionSector sector;
    if (!drtv::read_region_sector(bytes, sector).ok())
        return 0;
    // With copies as neighbours all around, as far as coordinates go.
    std::vector<drtv::RegionSector> region(4, sector);
    for (std::int32_t n = 0; n < 3; ++n) {
        region[static_cast<std::size_t>(n)].i += n % 2;
        region[static_cast<std::size_t>(n)].j += n / 2;
    }
    for (const drtv::RegionFinding& found : drtv::validate_region(region))
        require(found.finding.offset <= size && found.sector < region.size());
    return 0;
}
