// How `drtv validate` tells what it found: in sentences, or as one JSON object (report.schema.json).
#pragma once

#include "check_files.h"
#include "kit/json_writer.h"

#include <cstddef>

namespace drtv::tool {

class ValidateReport {
  public:
    explicit ValidateReport(bool as_json);

    // A file that could be read. Sentences go to stdout at once.
    void add(const CheckedFile& file, bool valid);

    // The end of the sentences, or all of the JSON, to stdout. `regions`: how many folders were checked each
    // by its borders. REQUIRES: nothing was finished before.
    void finish(std::size_t regions, const std::vector<CheckedFolder>& folders);

  private:
    const bool as_json_;
    kit::JsonWriter json_;
    std::size_t checked_ = 0;
    std::size_t invalid_ = 0;
    std::size_t warnings_ = 0;
};

}  // namespace drtv::tool
