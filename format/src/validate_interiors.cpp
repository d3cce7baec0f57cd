// Rules for interiors: closed, turned outwards, around their probe.
#include "validate_rules.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace drtv {
namespace {

using Rooms = layout::InteriorsLayout;

constexpr std::uint32_t directed_edge(std::uint16_t from, std::uint16_t to) {
    return std::uint32_t{from} << 16 | to;
}

// The first vertex of an edge that has not as many triangles on one side as on the other; nothing where the
// mesh is closed.
std::optional<std::uint16_t> open_edge(const Interior& interior) {
    std::vector<std::uint32_t> edges, reversed;
    for (const auto& t : interior.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            edges.push_back(directed_edge(t[k], t[(k + 1) % 3]));
            reversed.push_back(directed_edge(t[(k + 1) % 3], t[k]));
        }
    }
    std::ranges::sort(edges);
    std::ranges::sort(reversed);
    const auto differs = std::ranges::mismatch(edges, reversed).in1;
    if (differs == edges.end())
        return std::nullopt;
    return static_cast<std::uint16_t>(*differs >> 16);
}

// Six times the volume, in steps; positive where fronts look outwards.
double six_volumes(const Interior& interior) {
    double sum = 0;
    for (const auto& t : interior.triangles) {
        std::array<std::array<double, 3>, 3> v{};
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                v[k][axis] = interior.vertices[t[k]][axis];
        }
        sum += v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
               v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
               v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
    }
    return sum;
}

bool holds_probe(const Sector& sector, const Interior& interior) {
    const auto position = position_units(sector, sector.probes[interior.probe]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto by_axis = [&](const auto& a, const auto& b) { return a[axis] < b[axis]; };
        const auto [low, high] =
            std::minmax_element(interior.vertices.begin(), interior.vertices.end(), by_axis);
        if (low == interior.vertices.end())
            return false;
        const std::int64_t offset = std::int64_t{position[axis]} - interior.origin_units[axis];
        if (offset < std::int64_t{(*low)[axis]} << interior.shift || offset > std::int64_t{(*high)[axis]}
                                                                                  << interior.shift)
            return false;
    }
    return true;
}

}  // namespace

void check_interiors(const Sector& sector, const layout::Place& place, Findings& findings) {
    for (std::size_t n = 0; n < sector.interiors.size(); ++n) {
        const Interior& interior = sector.interiors[n];
        const auto path = [&] { return "interior" + index(n); };
        const std::uint64_t offset = place.at(Rooms::entry_at(n));
        if (const auto vertex = open_edge(interior)) {
            findings.add(issue::interior_open, offset, *vertex, path, [&] {
                return "has more triangles on one side of an edge at vertex " + std::to_string(*vertex) +
                       " than on the other";
            });
        } else if (!(six_volumes(interior) > 0)) {
            findings.add(issue::interior_inside_out, offset, six_volumes(interior) / 6, path, [] {
                return std::string("its triangles enclose no volume, or face inwards");
            });
        }
        if (!holds_probe(sector, interior)) {
            findings.add(
                issue::interior_probe, offset + (place.raw ? Rooms::probe : 0), interior.probe, path, [&] {
                    return "its probe " + std::to_string(interior.probe) + " stands outside of its bounds";
                });
        }
    }
}

}  // namespace drtv
