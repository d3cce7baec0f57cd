// What the validator finds, in the order in which it looks.
#pragma once

#include <drtv/conventions.h>
#include <drtv/validate.h>

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

    // `path` and `message` are functions that give a string: most files have nothing to tell, and what is
    // behind the cap is not shown.
    template <class Path, class Message>
    void add(
        const Issue& issue, std::uint64_t offset, std::optional<double> value, Path path, Message message) {
        if (admit(report_, issue, options_))
            report_.findings.push_back({&issue, offset, path(), value, message()});
    }
    [[nodiscard]] Report take() { return std::move(report_); }

  private:
    const ValidateOptions& options_;
    Report report_;
};

[[nodiscard]] inline std::string index(std::size_t n) {
    return "[" + std::to_string(n) + "]";
}
[[nodiscard]] inline std::string probe_path(std::size_t p) {
    return "probe" + index(p);
}

inline constexpr std::array<char, channel_count> channel_name = {'r', 'g', 'b'};

}  // namespace drtv
