#include "border_step.h"

#include <algorithm>
#include <cmath>

namespace drtv {
namespace {

using Light = std::array<float, basis_count * channel_count>;

double step_between(const Light& a, const Light& b) {
    double squares = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        squares += static_cast<double>(a[k] - b[k]) * static_cast<double>(a[k] - b[k]);
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

std::size_t cell_index(std::size_t x, std::size_t y, std::size_t z) {
    return x + grid_size * y + grid_size * grid_size * z;
}

const Light* light_at(const RegionSector& sector, std::size_t cell) {
    const std::uint8_t probe = sector.grid.cells[cell];
    return probe < sector.light.size() ? &sector.light[probe] : nullptr;
}

// Steps to the next cell to the east (axis 0) or north (axis 1).
void add_steps_inside(const RegionSector& sector, std::size_t axis, Mean& steps) {
    const std::size_t stride = axis == 0 ? 1 : grid_size;
    for (std::size_t cell = 0; cell < grid_cell_count; ++cell) {
        if (cell / stride % grid_size == grid_size - 1)
            continue;
        if (sector.grid.cells[cell] == sector.grid.cells[cell + stride])
            continue;
        const Light *here = light_at(sector, cell), *next = light_at(sector, cell + stride);
        if (here != nullptr && next != nullptr)
            steps.add(step_between(*here, *next));
    }
}

// From the last cells of `west` (or south) to the first of `east` (or north) at the same height.
Mean steps_across(const RegionSector& west, const RegionSector& east, std::size_t axis) {
    Mean steps;
    for (std::size_t z = 0; z < grid_size; ++z) {
        const std::int64_t height = west.grid.z_origin_units +
                                    static_cast<std::int64_t>(z) * west.grid.cell_height_units +
                                    west.grid.cell_height_units / 2;
        const std::int64_t east_z = std::clamp<std::int64_t>(
            (height - east.grid.z_origin_units) / std::int64_t{east.grid.cell_height_units},
            0,
            grid_size - 1);
        for (std::size_t k = 0; k < grid_size; ++k) {
            const Light* here =
                light_at(west, axis == 0 ? cell_index(grid_size - 1, k, z) : cell_index(k, grid_size - 1, z));
            const auto other_z = static_cast<std::size_t>(east_z);
            const Light* next =
                light_at(east, axis == 0 ? cell_index(0, k, other_z) : cell_index(k, 0, other_z));
            if (here != nullptr && next != nullptr)
                steps.add(step_between(*here, *next));
        }
    }
    return steps;
}

}  // namespace

Light light_under_white_sky(const Probe& probe) {
    Light light{};
    for (std::size_t b = 0; b < basis_count; ++b) {
        const float sky = decode_fixed(probe.sky_visibility[b], sky_visibility_scale) * open_sky_share(b);
        for (std::size_t c = 0; c < channel_count; ++c)
            light[b * channel_count + c] =
                decode_fixed(probe.transfer[c][b][0], transfer_scale) / sh_y0 + sky;
    }
    return light;
}

BorderStep border_step(const RegionSector& west, const RegionSector& east, std::size_t axis) {
    Mean inside;
    add_steps_inside(west, axis, inside);
    add_steps_inside(east, axis, inside);
    return {steps_across(west, east, axis).value(), inside.value(), inside.count};
}

}  // namespace drtv
