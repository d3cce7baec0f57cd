// Worlds on paper for placement: floors and boxes whose columns and rays have closed forms.
#pragma once

#include "placement/placement.h"

#include <algorithm>
#include <functional>
#include <span>
#include <tuple>
#include <vector>

namespace drtv::test {

using placement::Box;
using placement::ColumnHit;
using placement::Kind;
using placement::PlacedProbe;
using placement::Position;

struct AnalyticScene {
    // Surfaces by height over (x, y), any order; the scene sorts them.
    std::function<void(glm::vec2, std::vector<ColumnHit>&)> floors = [](glm::vec2, std::vector<ColumnHit>&) {
    };
    std::vector<Box> boxes;   // closed solids, met by columns and rays
    std::vector<Box> solids;  // met by rays only: what a column cannot know about
    std::vector<Box> vegetation;
    std::vector<placement::HandPlacedProbe> manual;
    std::vector<placement::ClosedVolume> no_probes;
    std::vector<placement::SpacingVolume> spacings;

    [[nodiscard]] placement::SceneQueries queries() const;
    // REQUIRES: placement succeeds.
    [[nodiscard]] placement::Placement place(std::int32_t i, std::int32_t j, float min_distance_m = 6) const;

    void column(glm::vec2 at, std::vector<ColumnHit>& hits) const;
    [[nodiscard]] bool is_in_box(const glm::vec3& point) const;
    // Where the way enters and leaves boxes.
    [[nodiscard]] std::vector<placement::Side> sides(const glm::vec3& from, const glm::vec3& to) const;
    [[nodiscard]] bool sees(const glm::vec3& from, const glm::vec3& to) const {
        return sides(from, to).empty();
    }
};

// Ground whose front is up.
[[nodiscard]] AnalyticScene flat_ground(float z_m = 0);

[[nodiscard]] std::vector<placement::HandPlacedProbe> manual_at(const std::vector<glm::dvec3>& places);
[[nodiscard]] placement::ClosedVolume box_volume(const glm::dvec3& low, const glm::dvec3& high);

[[nodiscard]] std::int64_t squared_distance(const Position& a, const Position& b);
[[nodiscard]] std::int64_t squared_units(double distance_m);
// Over all pairs of automatic probes, and of an automatic and a manual one; the largest number when there is
// none.
[[nodiscard]] std::int64_t min_squared_distance(std::span<const PlacedProbe> probes);
[[nodiscard]] std::size_t count_of(const placement::Placement& placement, Kind kind);

// Comparable content.
using ProbeKey = std::tuple<int, int, int, int>;
[[nodiscard]] std::vector<ProbeKey> sorted_keys(std::span<const PlacedProbe> probes);
[[nodiscard]] std::vector<ProbeKey> keys(std::span<const PlacedProbe> probes);

}  // namespace drtv::test
