#include "region_holes.h"

#include <algorithm>
#include <cstdint>

namespace drtv {
namespace {

using Component = std::vector<Coordinate>;

constexpr std::size_t max_walked = std::size_t{1} << 22;

// Sectors that touch, corners included: what goes round a hole is one component.
std::vector<Component> components_of(const std::set<Coordinate>& sectors) {
    std::set<Coordinate> left = sectors;
    std::vector<Component> components;
    while (!left.empty()) {
        Component& component = components.emplace_back(1, *left.begin());
        left.erase(left.begin());
        for (std::size_t k = 0; k < component.size(); ++k) {
            const auto [i, j] = component[k];
            for (std::int32_t dj = -1; dj <= 1; ++dj) {
                for (std::int32_t di = -1; di <= 1; ++di) {
                    const Coordinate next{i + di, j + dj};
                    if (left.erase(next) > 0)
                        component.push_back(next);
                }
            }
        }
    }
    return components;
}

struct Rectangle {
    Coordinate low;
    std::size_t width;
    std::size_t height;

    [[nodiscard]] std::size_t size() const { return width * height; }
    [[nodiscard]] Coordinate place_of(std::size_t n) const {
        const auto x = static_cast<std::int32_t>(n % width);
        const auto y = static_cast<std::int32_t>(n / width);
        return {low.first + x, low.second + y};
    }
};

// Around the component and a frame of one place, from which all that is open can be reached.
Rectangle frame_of(const Component& component) {
    Coordinate low = component.front();
    Coordinate high = low;
    for (const auto& [i, j] : component) {
        low = {std::min(low.first, i), std::min(low.second, j)};
        high = {std::max(high.first, i), std::max(high.second, j)};
    }
    const std::int32_t width = high.first - low.first + 3;
    const std::int32_t height = high.second - low.second + 3;
    return {
        {low.first - 1, low.second - 1}, static_cast<std::size_t>(width), static_cast<std::size_t>(height)};
}

// The empty places of a rectangle, and which of them were not reached yet.
class EmptyPlaces {
  public:
    EmptyPlaces(const Rectangle& rectangle, const std::set<Coordinate>& sectors)
        : rectangle_(rectangle), unreached_(rectangle.size()) {
        for (std::size_t n = 0; n < rectangle.size(); ++n)
            unreached_[n] = !sectors.contains(rectangle.place_of(n));
    }

    [[nodiscard]] bool is_unreached(std::size_t n) const { return unreached_[n]; }

    // All that can be reached from `start`, side by side.
    std::vector<std::size_t> walk(std::size_t start) {
        const auto [low, width, height] = rectangle_;
        std::vector<std::size_t> reached = {start};
        unreached_[start] = false;
        const auto go = [&](bool inside, std::size_t next) {
            if (!inside || !unreached_[next])
                return;
            unreached_[next] = false;
            reached.push_back(next);
        };
        for (std::size_t k = 0; k < reached.size(); ++k) {
            const std::size_t n = reached[k];
            const std::size_t x = n % width;
            const std::size_t y = n / width;
            go(x > 0, n - 1);
            go(x + 1 < width, n + 1);
            go(y > 0, n - width);
            go(y + 1 < height, n + width);
        }
        return reached;
    }

  private:
    Rectangle rectangle_;
    std::vector<bool> unreached_;
};

}  // namespace

std::vector<Hole> find_holes(const std::set<Coordinate>& sectors) {
    std::vector<Hole> holes;
    std::set<Coordinate> known;
    for (const Component& component : components_of(sectors)) {
        const Rectangle rectangle = frame_of(component);
        if (rectangle.size() > max_walked)
            continue;
        EmptyPlaces places(rectangle, sectors);
        places.walk(0);
        for (std::size_t n = 0; n < rectangle.size(); ++n) {
            const Coordinate first = rectangle.place_of(n);
            if (!places.is_unreached(n) || known.contains(first))
                continue;
            const std::vector<std::size_t> hole = places.walk(n);
            for (const std::size_t part : hole)
                known.insert(rectangle.place_of(part));
            holes.push_back({first, hole.size()});
        }
    }
    return holes;
}

}  // namespace drtv
