#include "border_step.h"

#include <algorithm>
#include <cmath>

namespace drtv {
namespace {

using Light = std::array<float, basis_count * channel_count>;

double step_between(const Light& a, const Light& b) {
    double squares = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const double step = a[k] - b[k];
        squares += step * step;
    }
    return std::sqrt(squares / static_cast<double>(a.size()));
}

struct Mean {
    double sum = 0;
    std::size_t count = 0;

    void add(double value) {
        sum += value;
        ++count;
    }
    [[nodiscard]] double value() const { return count == 0 ? 0 : sum / static_cast<double>(count); }
};

constexpr std::size_t cells_of_level = grid_size * grid_size;

// How much of the sky is hidden in a horizontal direction, from the sky visibility around it.
double hidden_sky(const std::array<float, basis_count>& sky, std::size_t axis, float sign) {
    double hidden = 0;
    double weights = 0;
    for (std::size_t b = 0; b < basis_count; ++b) {
        const float along = std::max(0.0f, sign * transfer_basis[b][axis]);
        const double weight = static_cast<double>(along) * static_cast<double>(along);
        hidden += weight * (1 - static_cast<double>(sky[b]));
        weights += weight;
    }
    return weights > 0 ? hidden / weights : 0;
}

// A probe that a cell names, and where it is.
struct Named {
    const RegionSector& sector;
    std::uint8_t probe;

    [[nodiscard]] bool is_there() const { return probe < sector.light.size(); }
    [[nodiscard]] const Light& light() const { return sector.light[probe]; }
    [[nodiscard]] double hidden(std::size_t axis, float sign) const {
        return hidden_sky(sector.sky_visibility[probe], axis, sign);
    }
    [[nodiscard]] const std::array<std::int32_t, 3>& position() const { return sector.positions[probe]; }
};

// Of the step between two probes, what an edge between them may bring: a ridge or wall hides sky from both,
// on the side where it stands; a cliff from the lower one, no more than its height does.
double explained_step(const Named& west, const Named& east, std::size_t axis) {
    const double west_hidden = west.hidden(axis, 1);
    const double east_hidden = east.hidden(axis, -1);
    const std::array<std::int32_t, 3>& a = west.position();
    const std::array<std::int32_t, 3>& b = east.position();
    const auto difference = [&](std::size_t k) {
        return static_cast<double>(a[k]) - static_cast<double>(b[k]);
    };
    const double height = std::abs(difference(2));
    const double away = std::hypot(difference(0), difference(1));
    const double of_lower = a[2] < b[2] ? west_hidden : east_hidden;
    const double by_cliff = height > 0 ? std::min(of_lower, height / std::hypot(height, away)) : 0;
    return std::max(std::min(west_hidden, east_hidden), by_cliff);
}

struct Steps {
    Mean light;
    Mean explained;

    void add(const Named& west, const Named& east, std::size_t axis) {
        if (!west.is_there() || !east.is_there())
            return;
        light.add(step_between(west.light(), east.light()));
        explained.add(explained_step(west, east, axis));
    }
};

// From a cell to the next one to the east (axis 0) or north (axis 1).
std::size_t stride_of(std::size_t axis) {
    return axis == 0 ? 1 : grid_size;
}

void add_steps_inside(const RegionSector& sector, std::size_t axis, Steps& steps) {
    const std::size_t stride = stride_of(axis);
    for (std::size_t cell = 0; cell < grid_cell_count; ++cell) {
        const bool last = cell / stride % grid_size == grid_size - 1;
        if (last)
            continue;
        const Named here{sector, sector.grid.cells[cell]};
        const Named next{sector, sector.grid.cells[cell + stride]};
        if (here.probe != next.probe)
            steps.add(here, next, axis);
    }
}

// The level of cells at a height; the lowest or highest where it is below or above the grid.
std::size_t level_of(const Grid& grid, std::int64_t height_units) {
    const std::int64_t above = height_units - grid.z_origin_units;
    const std::int64_t level = above / std::int64_t{grid.cell_height_units};
    return static_cast<std::size_t>(std::clamp<std::int64_t>(level, 0, grid_size - 1));
}

// From the last cells of `west` (or south) to the first of `east` (or north) at the same height.
Steps steps_across(const RegionSector& west, const RegionSector& east, std::size_t axis) {
    const std::size_t to_last = stride_of(axis) * (grid_size - 1);
    const std::size_t along = stride_of(1 - axis);
    Steps steps;
    for (std::size_t z = 0; z < grid_size; ++z) {
        const std::int64_t cell_height = west.grid.cell_height_units;
        const std::int64_t bottom = west.grid.z_origin_units + static_cast<std::int64_t>(z) * cell_height;
        const std::size_t east_z = level_of(east.grid, bottom + cell_height / 2);
        for (std::size_t k = 0; k < grid_size; ++k) {
            const std::size_t here = cells_of_level * z + along * k + to_last;
            const std::size_t next = cells_of_level * east_z + along * k;
            steps.add({west, west.grid.cells[here]}, {east, east.grid.cells[next]}, axis);
        }
    }
    return steps;
}

}  // namespace

Light light_under_white_sky(const Probe& probe) {
    Light light{};
    for (std::size_t b = 0; b < basis_count; ++b) {
        const float sky = decode_fixed(probe.sky_visibility[b], sky_visibility_scale) * open_sky_share(b);
        for (std::size_t c = 0; c < channel_count; ++c) {
            const float bounced = decode_fixed(probe.transfer[c][b][0], transfer_scale) / sh_y0;
            light[b * channel_count + c] = bounced + sky;
        }
    }
    return light;
}

BorderStep border_step(const RegionSector& west, const RegionSector& east, std::size_t axis) {
    Steps inside;
    add_steps_inside(west, axis, inside);
    add_steps_inside(east, axis, inside);
    const Steps across = steps_across(west, east, axis);
    const double explained = std::max(0.0, across.explained.value() - inside.explained.value());
    return {std::max(0.0, across.light.value() - explained), inside.light.value(), inside.light.count};
}

}  // namespace drtv
