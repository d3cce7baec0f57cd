// Checks every rule of a sector file, not only those that a reader checks. The daemon publishes no file that
// has an error. Pure and thread-safe: files may be checked on all cores. Costs some 0.1 ms for a file of 70
// probes.
//
//     const drtv::Report report = drtv::validate_sector(bytes);
//     for (const drtv::Finding& finding : report.findings) puts(finding.message.c_str());
#pragma once

#include <drtv/issues.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drtv {

struct Finding {
    const Issue* issue = nullptr;
    std::uint64_t offset = 0;     // byte in the file; inside a compressed section, that section's first byte
    std::string path;             // "probe[12].transfer.g[3][1]"; empty where the structure is broken
    std::optional<double> value;  // the number that breaks the rule, where one does
    std::string message;          // one sentence: what, where, value
};

struct Report {
    std::vector<Finding> findings;         // in the order of the section kinds
    std::size_t errors = 0, warnings = 0;  // all findings, also those beyond max_findings
    bool truncated = false;                // there are more than `findings` shows

    [[nodiscard]] bool valid() const { return errors == 0; }
};

struct ValidateOptions {
    bool quick = false;              // structure and checksums only: what a reader checks
    std::size_t max_findings = 100;  // shown; REQUIRES: > 0
    std::span<const Issue* const> ignored =
        {};  // neither shown nor counted, except for errors of the group `structure`
};

// Counts a finding of this issue, unless it is ignored. Returns true where the caller should append it to
// report.findings: while they are fewer than max_findings.
[[nodiscard]] bool admit(Report& report, const Issue& issue, const ValidateOptions& options);

// Any bytes give a report. Thread-safe.
[[nodiscard]] Report validate_sector(std::span<const std::uint8_t> bytes,
                                     const ValidateOptions& options = {});

}  // namespace drtv
