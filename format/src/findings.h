// What the validator finds, in the order in which it looks.
#pragma once

#include <drtv/conventions.h>
#include <drtv/validate.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace drtv {

class Findings {
  public:
    explicit Findings(const ValidateOptions& options) : options_(options) {}

    // `path` and `message` are functions that give a string: most files have nothing to tell, and what is behind the cap is
    // not shown.
    template <class Path, class Message>
    void add(const Issue& issue, std::uint64_t offset, std::optional<double> value, Path path, Message message) {
        // What cannot be read cannot be valid, whoever wants to ignore it.
        const bool unreadable = issue.group == IssueGroup::structure && issue.severity == Severity::error;
        if (!unreadable && std::ranges::find(options_.ignored, &issue) != options_.ignored.end()) return;
        ++(issue.severity == Severity::error ? report_.errors : report_.warnings);
        if (report_.findings.size() < options_.max_findings) report_.findings.push_back({&issue, offset, path(), value, message()});
        else report_.truncated = true;
    }
    [[nodiscard]] Report take() { return std::move(report_); }

  private:
    const ValidateOptions& options_;
    Report report_;
};

[[nodiscard]] inline std::string index(std::size_t n) { return "[" + std::to_string(n) + "]"; }
[[nodiscard]] inline std::string probe_path(std::size_t p) { return "probe" + index(p); }

inline constexpr std::array<char, channel_count> channel_name = {'r', 'g', 'b'};

}  // namespace drtv
