// A day's gradients as JSON (format/light.schema.json), for the tools. Games fill the structs of drtv/day.h
// themselves.
#pragma once

#include <drtv/day.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace drtv {

// A day, and the memory that its spans point to.
class DayFile {
  public:
    // The built-in day.
    DayFile();
    // Reads a day from JSON. An error is one sentence: where, what, value.
    [[nodiscard]] static tl::expected<DayFile, std::string> read(std::string_view json);

    [[nodiscard]] const Day& day() const { return *day_; }

    struct Storage;

  private:
    std::shared_ptr<const Storage> storage_;
    std::shared_ptr<const Day> day_;
};

// Reads "14:00" or "14:30:15" as hours, from 00:00 to 24:00. False for anything else.
[[nodiscard]] bool parse_time(std::string_view text, double& hours);

}  // namespace drtv
