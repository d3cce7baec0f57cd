// How `drtv diff` tells what changed: in sentences, or as one JSON object.
#pragma once

#include "kit/json_writer.h"
#include "sector_diff.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace drtv::tool {

using SectorPlace = std::array<std::int32_t, 2>;  // (i, j)

// "(2, -1)"
[[nodiscard]] std::string text(const SectorPlace& place);

// Over all sectors of both sides.
struct DiffTotals {
    std::size_t compared = 0;  // sectors that both sides have
    std::size_t different = 0;
    std::vector<SectorPlace> only_first;
    std::vector<SectorPlace> only_second;
    std::array<QuantityChange, quantity_count> changes;

    [[nodiscard]] bool equal() const;
};

class DiffReport {
  public:
    explicit DiffReport(bool as_json);

    // A sector that differs. `probes`: how many the second side's has. Sentences go to stdout at once.
    void add(const SectorPlace& place, const SectorDiff& diff, std::size_t probes);

    // The end of the sentences, or all of the JSON, to stdout. REQUIRES: nothing was finished before.
    void finish(const DiffTotals& totals);

  private:
    const bool as_json_;
    kit::JsonWriter json_;
};

}  // namespace drtv::tool
