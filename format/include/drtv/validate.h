// What a sector file must keep beyond being readable. The daemon publishes nothing that has an error here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace drtv {

enum class Severity : std::uint8_t { error, warning };

// One kind of finding. Codes never change their meaning.
struct Issue {
    std::string_view code;
    Severity severity = Severity::error;
    std::string_view meaning;
};

struct Finding {
    const Issue* issue = nullptr;
    std::uint64_t offset = 0;  // byte in the file; inside a compressed section, that section's first byte
    std::string path;          // "probe[12].transfer.g[3][1]"
    std::string message;       // what, where, value
};

// The table of all issues, for documentation and tests.
[[nodiscard]] std::span<const Issue> all_issues();

// Findings by section in the order of their kinds, at most `max_findings`. Empty: valid. REQUIRES: max_findings > 0.
[[nodiscard]] std::vector<Finding> validate_sector(std::span<const std::uint8_t> bytes, std::size_t max_findings = 100);

}  // namespace drtv
