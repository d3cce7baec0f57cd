#include "bakerd/bake/sector_file.h"

#include <drtv/read.h>
#include <drtv/validate.h>
#include <drtv/write.h>

#include <fmt/format.h>

#include <algorithm>

namespace drtv::bake {

tl::expected<std::vector<std::uint8_t>, std::string> encode_sector(const Sector& sector,
                                                                   std::vector<std::string>& warnings) {
    std::vector<std::uint8_t> bytes = write_sector(sector);
    const Report report = validate_sector(bytes);
    const auto sentence = [&](const Finding& finding) {
        return fmt::format("{} {} {}", finding.issue->code, finding.path, finding.message);
    };
    if (!report.valid()) {
        const auto error = std::ranges::find_if(report.findings, [](const Finding& finding) {
            return finding.issue->severity == Severity::error;
        });
        return tl::unexpected(fmt::format(
            "sector ({}, {}) does not pass validation: {}",
            sector.i,
            sector.j,
            error == report.findings.end() ? "too many findings to show an error" : sentence(*error)));
    }
    for (const Finding& finding : report.findings)
        warnings.push_back(fmt::format("sector ({}, {}): {}", sector.i, sector.j, sentence(finding)));
    return bytes;
}

std::optional<Sector> decode_sector(std::span<const std::uint8_t> bytes) {
    Sector sector;
    if (!read_sector(bytes, sector).ok())
        return std::nullopt;
    return sector;
}

}  // namespace drtv::bake
