// Rules for interiors: closed, turned outwards, around their probe.
#include "sentence.h"
#include "validate_rules.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace drtv {
namespace {

using Rooms = layout::InteriorsLayout;
using Vertex = std::array<std::uint16_t, 3>;
using Double3 = std::array<double, 3>;

constexpr std::uint32_t directed_edge(std::uint16_t from, std::uint16_t to) {
    return std::uint32_t{from} << 16 | to;
}

// The first vertex of an edge that has not as many triangles on one side as on the other; nothing where the
// mesh is closed.
std::optional<std::uint16_t> open_edge(const Interior& interior) {
    std::vector<std::uint32_t> edges;
    std::vector<std::uint32_t> reversed;
    const auto add = [&](std::uint16_t from, std::uint16_t to) {
        edges.push_back(directed_edge(from, to));
        reversed.push_back(directed_edge(to, from));
    };
    for (const auto& [a, b, c] : interior.triangles) {
        add(a, b);
        add(b, c);
        add(c, a);
    }
    std::ranges::sort(edges);
    std::ranges::sort(reversed);
    const auto differs = std::ranges::mismatch(edges, reversed).in1;
    if (differs == edges.end())
        return std::nullopt;
    return static_cast<std::uint16_t>(*differs >> 16);
}

Double3 point_of(const Vertex& vertex) {
    Double3 point;
    std::ranges::copy(vertex, point.begin());
    return point;
}

double determinant(const Double3& a, const Double3& b, const Double3& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// Six times the volume, in steps; positive where fronts look outwards.
double six_volumes(const Interior& interior) {
    const std::vector<Vertex>& vertices = interior.vertices;
    double sum = 0;
    for (const auto& [a, b, c] : interior.triangles)
        sum += determinant(point_of(vertices[a]), point_of(vertices[b]), point_of(vertices[c]));
    return sum;
}

// Whether the probe lies within the bounds of the vertices.
bool holds_probe(const Sector& sector, const Interior& interior) {
    if (interior.vertices.empty())
        return false;
    const auto position = position_units(sector, sector.probes[interior.probe]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto on_axis = [&](const Vertex& vertex) { return vertex[axis]; };
        const auto [low, high] = std::ranges::minmax(interior.vertices, {}, on_axis);
        const std::int64_t offset = std::int64_t{position[axis]} - interior.origin_units[axis];
        const std::int64_t low_units = std::int64_t{low[axis]} << interior.shift;
        const std::int64_t high_units = std::int64_t{high[axis]} << interior.shift;
        if (offset < low_units || offset > high_units)
            return false;
    }
    return true;
}

void check_mesh(const Interior& interior, std::size_t n, const SectionCheck& check) {
    const std::uint64_t offset = check.place.at(Rooms::entry_at(n));
    const auto path = [&] { return "interior" + index(n); };
    if (const auto vertex = open_edge(interior)) {
        check.findings.add(issue::interior_open, offset, *vertex, path, [&] {
            return sentence(
                "has more triangles on one side of an edge at vertex ", *vertex, " than on the other");
        });
        return;
    }
    const double volumes = six_volumes(interior);
    if (volumes > 0)
        return;
    check.findings.add(issue::interior_inside_out, offset, volumes / 6, path, [] {
        return "its triangles enclose no volume, or face inwards";
    });
}

void check_probe(const Interior& interior, std::size_t n, const SectionCheck& check) {
    if (holds_probe(check.sector, interior))
        return;
    const std::uint64_t offset = check.place.at(Rooms::entry_at(n) + Rooms::probe);
    const auto path = [&] { return "interior" + index(n); };
    check.findings.add(issue::interior_probe, offset, interior.probe, path, [&] {
        return sentence("its probe ", interior.probe, " stands outside of its bounds");
    });
}

}  // namespace

void check_interiors(const SectionCheck& check) {
    const std::vector<Interior>& interiors = check.sector.interiors;
    for (std::size_t n = 0; n < interiors.size(); ++n) {
        check_mesh(interiors[n], n, check);
        check_probe(interiors[n], n, check);
    }
}

}  // namespace drtv
