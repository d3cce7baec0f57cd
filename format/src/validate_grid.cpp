// Rules for the grid: a cell names a probe that is there (SPEC.md, section 5.5).
#include "sentence.h"
#include "validate_rules.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace drtv {
namespace {

// Those that no interior names: cells outside of these may name them.
std::size_t probes_of_the_open(const Sector& sector) {
    std::vector<bool> named(sector.probes.size(), false);
    for (const Interior& interior : sector.interiors) {
        if (interior.probe < named.size())
            named[interior.probe] = true;
    }
    return static_cast<std::size_t>(std::ranges::count(named, false));
}

}  // namespace

void check_grid(const SectionCheck& check) {
    const Sector& sector = check.sector;
    const std::size_t count = sector.probes.size();
    const std::size_t in_the_open = probes_of_the_open(sector);
    for (std::size_t cell = 0; cell < grid_cell_count; ++cell) {
        const std::uint8_t named = sector.grid.cells[cell];
        const auto add = [&](const Issue& issue, const auto& message) {
            const std::uint64_t offset = check.place.at(layout::grid::cells + cell);
            const auto path = [&] { return "grid.cells" + index(cell); };
            check.findings.add(issue, offset, named, path, message);
        };
        if (named == no_probe) {
            if (in_the_open > 0)
                add(issue::grid_no_probe, [&] {
                    return sentence(
                        "names no probe, the sector has ", in_the_open, " that no interior names");
                });
        } else if (named >= count) {
            add(issue::grid_reference,
                [&] { return sentence("names probe ", named, ", the sector has ", count); });
        }
    }
}

}  // namespace drtv
