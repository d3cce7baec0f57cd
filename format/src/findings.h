// What the validator finds, in the order in which it looks.
#pragma once

#include <drtv/conventions.h>
#include <drtv/validate.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace drtv {

// Indices into all_issues().
enum IssueIndex : std::size_t {
    unreadable,
    checksum,
    unsupported_version,
    reserved_code,
    sky_visibility_range,
    sky_visibility_down,
    transfer_range,
    grid_reference,
    grid_no_probe,
    settings_range,
    duplicate_position,
    static_irradiance_range,
    static_exponent,
    local_source_count,
    local_source_duplicate,
    local_exponent,
    local_transfer_range,
    convergence_range,
    issue_count,
};

class Findings {
  public:
    explicit Findings(std::size_t max) : max_(max) {}

    void add(IssueIndex issue, std::uint64_t offset, std::string path, std::string message) {
        if (found_.size() < max_) found_.push_back({&all_issues()[issue], offset, std::move(path), std::move(message)});
    }
    [[nodiscard]] std::vector<Finding> take() { return std::move(found_); }

  private:
    std::size_t max_;
    std::vector<Finding> found_;
};

[[nodiscard]] inline std::string index(std::size_t n) { return "[" + std::to_string(n) + "]"; }
[[nodiscard]] inline std::string probe_path(std::size_t p) { return "probe" + index(p); }

inline constexpr std::array<char, channel_count> channel_name = {'r', 'g', 'b'};

}  // namespace drtv
