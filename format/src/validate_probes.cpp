// Rules for what every sector has: settings, positions, sky visibility, transfer, grid.
#include "validate_rules.h"

#include <array>
#include <cmath>
#include <vector>

namespace drtv {
namespace {

// Under a sky of radiance 1. Both sums come from the same rays; what is over 1 is rounding of codes and
// weights.
constexpr float most_energy = 1.01f;
// Radiance that is nowhere negative has |L_i| <= sqrt(3) L_0; two codes for the rounding of both.
constexpr double sqrt3 = 1.7320508;
constexpr double band_slack_codes = 2;

constexpr std::size_t considered_probes = 4;  // of a grid cell (SPEC.md, section 5.5)

struct TransferCode {
    const Sector& sector;
    const layout::Place& place;
    std::size_t p, c, b, i;

    [[nodiscard]] std::int16_t code() const { return sector.probes[p].transfer[c][b][i]; }
    [[nodiscard]] std::uint64_t offset() const {
        return place.at(p * layout::transfer_bytes + 2 * ((c * basis_count + b) * sh_count + i));
    }
    [[nodiscard]] std::string path() const {
        return probe_path(p) + ".transfer." + channel_name[c] + index(b) + index(i);
    }
};

void check_transfer_code(const TransferCode& at, Findings& findings) {
    const std::int16_t q = at.code();
    const auto path = [&] { return at.path(); };
    if (q == INT16_MIN) {
        findings.add(issue::fixed_point_reserved, at.offset(), static_cast<double>(q), path, [] {
            return std::string("code -32768 is reserved");
        });
        return;
    }
    const float value = decode_fixed(q, transfer_scale);
    const float bound = at.i == 0 ? transfer_bound_y0 : transfer_bound_y1;
    if (std::abs(value) > bound) {
        findings.add(issue::transfer_range, at.offset(), value, path, [&] {
            return std::to_string(value) + " is beyond " + std::to_string(bound);
        });
        return;
    }
    // Y0 and Y2 are positive over the whole sky.
    if ((at.i == 0 || at.i == 2) && q < 0) {
        findings.add(issue::transfer_sign, at.offset(), value, path, [&] {
            return std::to_string(value) + " is negative";
        });
        return;
    }
    const std::int16_t q0 = at.sector.probes[at.p].transfer[at.c][at.b][0];
    if (at.i > 0 && q0 >= 0 && std::abs(static_cast<double>(q)) > sqrt3 * q0 + band_slack_codes) {
        findings.add(issue::transfer_band, at.offset(), value, path, [&] {
            return std::to_string(value) + " is more than sqrt(3) times " +
                   std::to_string(decode_fixed(q0, transfer_scale)) + " of Y0";
        });
    }
}

void check_energy(const Sector& sector, const layout::Place& place, std::size_t p, Findings& findings) {
    const Probe& probe = sector.probes[p];
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            const float bounced = decode_fixed(probe.transfer[c][b][0], transfer_scale) / sh_y0;
            const float seen =
                decode_fixed(probe.sky_visibility[b], sky_visibility_scale) * open_sky_share(b);
            // What is too large by itself is told already.
            if (!(bounced + seen > most_energy) || bounced * sh_y0 > transfer_bound_y0)
                continue;
            const TransferCode at{sector, place, p, c, b, 0};
            findings.add(
                issue::energy,
                at.offset(),
                bounced + seen,
                [&] { return at.path(); },
                [&] {
                    return "bounce " + std::to_string(bounced) + " and sky " + std::to_string(seen) +
                           " under a sky of radiance 1 add up to more than 1";
                });
        }
    }
}

// Whether fewer than `considered_probes` probes come before `named` by (distance, index).
bool is_among_nearest(const std::vector<double>& squared, std::size_t named) {
    const double its = squared[named];
    std::size_t before = 0;
    for (std::size_t p = 0; p < named; ++p)
        before += squared[p] <= its ? 1u : 0u;
    for (std::size_t p = named + 1; p < squared.size(); ++p)
        before += squared[p] < its ? 1u : 0u;
    return before < considered_probes;
}

// For each cell whether it names one of the probes nearest to its centre; false where it names none.
std::array<bool, grid_cell_count> cells_of_near_probes(const Sector& sector) {
    // In units from the grid's corner; whole numbers, whose squared distances a double holds exactly as far
    // as probes can lie apart.
    const std::size_t count = sector.probes.size();
    std::vector<std::array<double, 3>> positions(count);
    for (std::size_t p = 0; p < count; ++p) {
        const auto& position = sector.probes[p].position;
        const std::int64_t z = std::int64_t{sector.z_origin_units} +
                               (std::int64_t{position[2]} << sector.z_shift) - sector.grid.z_origin_units;
        positions[p] = {
            static_cast<double>(position[0]), static_cast<double>(position[1]), static_cast<double>(z)};
    }
    constexpr double width = sector_size_m * position_units_per_m / double{grid_size};
    const auto height = static_cast<double>(sector.grid.cell_height_units);
    const double middle = std::floor(height / 2);
    std::array<bool, grid_cell_count> near{};
    std::vector<double> level(count), squared(count);
    for (std::size_t column = 0; column < grid_size * grid_size; ++column) {
        const double x = width * static_cast<double>(column % grid_size) + width / 2,
                     y = width * static_cast<double>(column / grid_size) + width / 2;
        for (std::size_t p = 0; p < count; ++p)
            level[p] =
                (positions[p][0] - x) * (positions[p][0] - x) + (positions[p][1] - y) * (positions[p][1] - y);
        for (std::size_t cz = 0; cz < grid_size; ++cz) {
            const std::size_t cell = column + grid_size * grid_size * cz, named = sector.grid.cells[cell];
            if (named >= count)
                continue;
            const double z = height * static_cast<double>(cz) + middle;
            for (std::size_t p = 0; p < count; ++p)
                squared[p] = level[p] + (positions[p][2] - z) * (positions[p][2] - z);
            near[cell] = is_among_nearest(squared, named);
        }
    }
    return near;
}

}  // namespace

void check_settings(const Sector& sector, const layout::Place& place, Findings& findings) {
    const BakeRecord& bake = sector.bake;
    const auto check_positive = [&](const char* name, std::uint64_t offset, double value) {
        if (value > 0)
            return;
        findings.add(
            issue::settings_range,
            place.at(offset),
            value,
            [&] { return std::string("settings.") + name; },
            [] { return std::string("is not above 0"); });
    };
    check_positive("rays", 0, bake.rays);
    check_positive("reach", 8, static_cast<double>(bake.reach_m));
    check_positive("min_distance", 12, static_cast<double>(bake.min_distance_m));
}

void check_probe_positions(const Sector& sector, const layout::Place& place, Findings& findings) {
    for (std::size_t p = 1; p < sector.probes.size(); ++p) {
        for (std::size_t q = 0; q < p; ++q) {
            if (sector.probes[p].position != sector.probes[q].position)
                continue;
            findings.add(
                issue::duplicate_position,
                place.at(p * layout::position_bytes),
                static_cast<double>(q),
                [&] { return probe_path(p) + ".position"; },
                [&] { return "is that of probe " + std::to_string(q); });
            break;
        }
    }
}

void check_sky_visibility(const Sector& sector, const layout::Place& place, Findings& findings) {
    for (std::size_t p = 0; p < sector.probes.size(); ++p) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            const std::int16_t q = sector.probes[p].sky_visibility[b];
            if (q == 0 || (q > 0 && b + 1 < basis_count))
                continue;
            const bool reserved = q == INT16_MIN, down = b + 1 == basis_count;
            findings.add(
                reserved ? issue::fixed_point_reserved
                : down   ? issue::sky_visibility_down
                         : issue::sky_visibility_range,
                place.at(p * layout::sky_visibility_bytes + 2 * b),
                static_cast<double>(q),
                [&] { return probe_path(p) + ".sky_visibility" + index(b); },
                [&] {
                    return "code " + std::to_string(q) +
                           (reserved ? " is reserved"
                            : down   ? ", must be 0"
                                     : " is negative");
                });
        }
    }
}

void check_transfer(const Sector& sector, const layout::Place& place, Findings& findings) {
    for (std::size_t p = 0; p < sector.probes.size(); ++p) {
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t b = 0; b < basis_count; ++b) {
                for (std::size_t i = 0; i < sh_count; ++i)
                    check_transfer_code({sector, place, p, c, b, i}, findings);
            }
        }
        check_energy(sector, place, p, findings);
    }
}

void check_grid(const Sector& sector, const layout::Place& place, Findings& findings) {
    const std::size_t count = sector.probes.size();
    const std::array<bool, grid_cell_count> near = cells_of_near_probes(sector);
    for (std::size_t cell = 0; cell < grid_cell_count; ++cell) {
        const std::size_t named = sector.grid.cells[cell];
        const auto add = [&](const Issue& issue, const auto& message) {
            findings.add(
                issue,
                place.at(layout::grid_header_bytes + cell),
                static_cast<double>(named),
                [&] { return "grid.cells" + index(cell); },
                message);
        };
        if (named == no_probe) {
            if (count > 0)
                add(issue::grid_no_probe,
                    [&] { return "names no probe, the sector has " + std::to_string(count); });
        } else if (named >= count) {
            add(issue::grid_reference, [&] {
                return "names probe " + std::to_string(named) + ", the sector has " + std::to_string(count);
            });
        } else if (!near[cell]) {
            add(issue::grid_not_nearest, [&] {
                return "names probe " + std::to_string(named) + ", and four others are nearer to its centre";
            });
        }
    }
}

}  // namespace drtv
