// A day's gradients as JSON (format/light.schema.json), for the tools. Games fill drtv/day.h themselves.
#pragma once

#include <drtv/day.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace drtv {

// A day with what its spans point to.
class DayFile {
  public:
    // Without a file: the built-in day.
    DayFile();
    // An error in a sentence: where, what, value. Empty where the text could be read.
    [[nodiscard]] static std::string read(std::string_view json, DayFile& file);

    [[nodiscard]] const Day& day() const { return *day_; }

    struct Storage;

  private:
    std::shared_ptr<const Storage> storage_;
    std::shared_ptr<const Day> day_;
};

// "14:00" as hours, also "14:30:15"; from 00:00 to 24:00. False for anything else.
[[nodiscard]] bool parse_time(std::string_view text, double& hours);

}  // namespace drtv
