#include "placement/spaces.h"

#include "placement/solid_test.h"

#include <algorithm>
#include <limits>

namespace drtv::placement {
namespace {

constexpr std::int32_t step_units = sector_size_m * units_per_m / Spaces::lines_along;

// How far a ray goes inside the sector.
float distance_to_border(const glm::vec3& from, const glm::vec3& direction, const glm::vec2& corner) {
    float distance_m = std::numeric_limits<float>::infinity();
    for (glm::length_t k = 0; k < 2; ++k) {
        if (direction[k] == 0)
            continue;
        const float wall = direction[k] > 0 ? corner[k] + sector_size_m : corner[k];
        distance_m = std::min(distance_m, std::max((wall - from[k]) / direction[k], 0.0f));
    }
    return distance_m;
}

}  // namespace

Spaces::Spaces(const Position& corner, float bottom_m, float top_m, const Surroundings& surroundings)
    : corner_(corner), surroundings_(surroundings) {
    lines_.resize(static_cast<std::size_t>(lines_along) * lines_along);
    for (std::int32_t y = 0; y < lines_along; ++y) {
        for (std::int32_t x = 0; x < lines_along; ++x)
            add_line(x, y, bottom_m, top_m);
    }
    closed_.resize(intervals_.size());
    join_neighbours();
    test_spaces();
}

glm::vec2 Spaces::line_at(std::int32_t x, std::int32_t y) const {
    return metres(corner_ + Position(x * step_units + step_units / 2, y * step_units + step_units / 2, 0));
}

void Spaces::add_line(std::int32_t x, std::int32_t y, float bottom_m, float top_m) {
    Line& line = lines_[static_cast<std::size_t>(y * lines_along + x)];
    surroundings_.column_of_spaces(line_at(x, y), line.hits);
    std::ranges::reverse(line.hits);
    for (std::size_t below = 0; below <= line.hits.size(); ++below) {
        const auto number = static_cast<std::uint32_t>(intervals_.size());
        Interval interval{bottom_m, top_m, false, number};
        if (below > 0)
            interval.low_m = std::max(bottom_m, line.hits[below - 1].z_m);
        if (below < line.hits.size()) {
            interval.high_m = std::min(top_m, line.hits[below].z_m);
            interval.under_back = line.hits[below].wound_up;
        }
        line.intervals.push_back(number);
        intervals_.push_back(interval);
    }
}

std::uint32_t Spaces::space_of(std::uint32_t interval) {
    while (intervals_[interval].space != interval)
        interval = intervals_[interval].space = intervals_[intervals_[interval].space].space;
    return interval;
}

// Those under backs alone: of the others nothing is asked.
void Spaces::join_neighbours() {
    for (std::int32_t y = 0; y < lines_along; ++y) {
        for (std::int32_t x = 0; x < lines_along; ++x) {
            if (x + 1 < lines_along)
                join(x, y, x + 1, y);
            if (y + 1 < lines_along)
                join(x, y, x, y + 1);
        }
    }
}

void Spaces::join(std::int32_t x, std::int32_t y, std::int32_t other_x, std::int32_t other_y) {
    for (const std::uint32_t a : line(x, y).intervals) {
        for (const std::uint32_t b : line(other_x, other_y).intervals) {
            const float low_m = std::max(intervals_[a].low_m, intervals_[b].low_m);
            const float high_m = std::min(intervals_[a].high_m, intervals_[b].high_m);
            const bool both = intervals_[a].under_back && intervals_[b].under_back;
            if (!both || low_m >= high_m || space_of(a) == space_of(b))
                continue;
            const float z_m = (low_m + high_m) / 2;
            const glm::vec3 from(line_at(x, y), z_m);
            const glm::vec3 to(line_at(other_x, other_y), z_m);
            if (!surroundings_.separated(from, to))
                intervals_[std::max(space_of(a), space_of(b))].space = std::min(space_of(a), space_of(b));
        }
    }
}

// A space is behind surfaces when it is so on one of its lines: seen from others, rays may leave the sector
// before they meet anything. What has no surface below either is under the ground.
void Spaces::test_spaces() {
    behind_.resize(intervals_.size());
    for (std::int32_t y = 0; y < lines_along; ++y) {
        for (std::int32_t x = 0; x < lines_along; ++x) {
            const std::vector<std::uint32_t>& numbers = line(x, y).intervals;
            for (std::size_t below = 0; below < numbers.size(); ++below) {
                const Interval& interval = intervals_[numbers[below]];
                const std::uint32_t space = space_of(numbers[below]);
                if (!interval.under_back || interval.low_m >= interval.high_m || behind_[space])
                    continue;
                const float z_m = (interval.low_m + interval.high_m) / 2;
                behind_[space] = below == 0 || is_behind(glm::vec3(line_at(x, y), z_m));
            }
        }
    }
}

bool Spaces::is_behind(const glm::vec3& point) const {
    std::vector<Look> looks(solid_test_looks().begin(), solid_test_looks().end());
    for (Look& look : looks)
        look.far_m = distance_to_border(point, look.direction, glm::vec2(metres(corner_)));
    return stands_by(surroundings_.first_met(point, looks, 1)).stand != Stand::free;
}

std::optional<float> Spaces::free_height(std::int32_t x, std::int32_t y, float z_m, float top_m) {
    const Line& line = this->line(x, y);
    while (z_m < top_m) {
        const auto below = static_cast<std::size_t>(
            std::ranges::upper_bound(line.hits, z_m, {}, &ColumnHit::z_m) - line.hits.begin());
        if (!is_in_solid(line, line_at(x, y), below, z_m))
            return z_m;
        if (below == line.hits.size())
            break;
        z_m = line.hits[below].z_m + wall_clearance_m;
    }
    return std::nullopt;
}

bool Spaces::is_in_solid(const Line& line, const glm::vec2& at, std::size_t below, float z_m) {
    const std::uint32_t interval = line.intervals[below];
    std::optional<bool>& closed = closed_[interval];
    if (!closed) {
        const bool any_above = std::any_of(line.hits.begin() + static_cast<std::ptrdiff_t>(below),
                                           line.hits.end(),
                                           [](const ColumnHit& hit) { return hit.closed; });
        closed = any_above && surroundings_.closed_around(glm::vec3(at, z_m)).has_value();
    }
    return *closed || behind_[space_of(interval)];
}

}  // namespace drtv::placement
