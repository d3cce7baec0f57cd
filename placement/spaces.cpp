#include "placement/spaces.h"

#include "placement/solid_test.h"

#include <algorithm>
#include <cmath>

namespace drtv::placement {
namespace {

// Less than that, and the way from line to line would run along a surface.
constexpr float min_overlap_m = 2 * wall_clearance_m;

constexpr std::int32_t step_units = sector_size_m * units_per_m / Spaces::lines_along;

}  // namespace

Spaces::Spaces(const Position& corner,
               float bottom_m,
               float top_m,
               std::span<const glm::vec3> probes,
               const SceneQueries& queries)
    : corner_(corner), queries_(queries) {
    lines_.resize(static_cast<std::size_t>(lines_along) * lines_along);
    for (std::int32_t y = 0; y < lines_along; ++y) {
        for (std::int32_t x = 0; x < lines_along; ++x)
            add_line(x, y, bottom_m, top_m);
    }
    closed_.resize(intervals_.size());
    spaces_ = DisjointSets(intervals_.size());
    join_neighbours();
    for (const glm::vec3& probe : probes)
        open_at(probe);
}

glm::vec2 Spaces::line_at(std::int32_t x, std::int32_t y) const {
    return metres(corner_ + Position(x * step_units + step_units / 2, y * step_units + step_units / 2, 0));
}

void Spaces::add_line(std::int32_t x, std::int32_t y, float bottom_m, float top_m) {
    Line& line = lines_[static_cast<std::size_t>(y * lines_along + x)];
    queries_.column_of_spaces(line_at(x, y), line.hits);
    std::ranges::reverse(line.hits);
    for (std::size_t below = 0; below <= line.hits.size(); ++below) {
        const auto number = static_cast<std::uint32_t>(intervals_.size());
        Interval interval{bottom_m, top_m};
        if (below > 0)
            interval.low_m = std::max(bottom_m, line.hits[below - 1].z_m);
        if (below < line.hits.size())
            interval.high_m = std::min(top_m, line.hits[below].z_m);
        line.intervals.push_back(number);
        intervals_.push_back(interval);
    }
    // Past bodies: the ground goes on over the bottom of a rock that is sunk into it.
    bool under_back = false;
    bool under_body = false;
    for (std::size_t below = line.hits.size(); below-- > 0;) {
        const ColumnHit& above = line.hits[below];
        under_back = above.body ? under_back : above.wound_up;
        under_body = under_body || above.body;
        intervals_[line.intervals[below]].under_back = under_back;
        intervals_[line.intervals[below]].under_body = under_body;
    }
}

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

// Of intervals that are under no back nothing is asked but whether they lead under one.
void Spaces::join(std::int32_t x, std::int32_t y, std::int32_t other_x, std::int32_t other_y) {
    const std::vector<std::uint32_t>& here = line(x, y).intervals;
    const std::vector<std::uint32_t>& there = line(other_x, other_y).intervals;
    // Both from the bottom up: which ends first makes way.
    for (std::size_t n = 0, m = 0; n < here.size() && m < there.size();) {
        const std::uint32_t a = here[n];
        const std::uint32_t b = there[m];
        const float low_m = std::max(intervals_[a].low_m, intervals_[b].low_m);
        const float high_m = std::min(intervals_[a].high_m, intervals_[b].high_m);
        if (high_m - low_m >= min_overlap_m) {
            const float z_m = (low_m + high_m) / 2;
            join(a, glm::vec3(line_at(x, y), z_m), b, glm::vec3(line_at(other_x, other_y), z_m));
        }
        if (intervals_[a].high_m < intervals_[b].high_m)
            ++n;
        else
            ++m;
    }
}

void Spaces::join(std::uint32_t a, const glm::vec3& in_a, std::uint32_t b, const glm::vec3& in_b) {
    const bool both = intervals_[a].under_back && intervals_[b].under_back;
    const bool one = intervals_[a].under_back || intervals_[b].under_back;
    if (!one || spaces_.root_of(a) == spaces_.root_of(b))
        return;
    const std::uint32_t under = spaces_.root_of(intervals_[a].under_back ? a : b);
    if ((!both && intervals_[under].open) || queries_.separated(in_a, in_b))
        return;
    if (!both) {
        intervals_[under].open = true;
        return;
    }
    const bool open = intervals_[spaces_.root_of(a)].open || intervals_[spaces_.root_of(b)].open;
    spaces_.join(a, b);
    intervals_[spaces_.root_of(a)].open = open;
}

// Whatever of the four lines around a place it sees at its height.
void Spaces::open_at(const glm::vec3& place) {
    const glm::vec2 at =
        (glm::vec2(place) - glm::vec2(metres(corner_))) / (sector_size_m / float{lines_along});
    for (const float dx : {-0.5f, 0.5f}) {
        for (const float dy : {-0.5f, 0.5f}) {
            const auto along = [](float n) {
                return std::clamp(static_cast<std::int32_t>(std::floor(n)), 0, lines_along - 1);
            };
            const std::int32_t x = along(at.x + dx);
            const std::int32_t y = along(at.y + dy);
            const std::uint32_t interval = line(x, y).intervals[surfaces_below(line(x, y), place.z)];
            if (intervals_[interval].under_back &&
                !queries_.separated(place, glm::vec3(line_at(x, y), place.z)))
                intervals_[spaces_.root_of(interval)].open = true;
        }
    }
}

std::size_t Spaces::surfaces_below(const Line& line, float z_m) {
    return static_cast<std::size_t>(std::ranges::upper_bound(line.hits, z_m, {}, &ColumnHit::z_m) -
                                    line.hits.begin());
}

std::optional<float> Spaces::free_height(std::int32_t x, std::int32_t y, float z_m, float top_m) {
    const Line& line = this->line(x, y);
    while (z_m < top_m) {
        const std::size_t below = surfaces_below(line, z_m);
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
        closed = intervals_[interval].under_body && queries_.closed_around(glm::vec3(at, z_m)).has_value();
    }
    return *closed || (intervals_[interval].under_back && !intervals_[spaces_.root_of(interval)].open);
}

}  // namespace drtv::placement
