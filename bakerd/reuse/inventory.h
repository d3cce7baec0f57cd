// All that a bake of a map can depend on, without the geometry itself: what stands where, by digest. Two
// inventories tell what changed between two maps.
#pragma once

#include "bakerd/bake/world.h"
#include "bakerd/map/map.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drtv::reuse {

enum class ItemKind : std::uint8_t {
    fixed,
    vegetation,
    lamp,
    sun,
    manual_probe,
    no_probes,
    interior,
    spacing,
};

// The first half of a SHA-256.
using ItemDigest = std::array<std::uint8_t, 16>;

struct Item {
    ItemKind kind = ItemKind::fixed;
    bool emissive = false;       // an object that shines
    bool bounds_volume = false;  // vegetation of which a part is closed
    ItemDigest digest{};         // of all that can change a bake
    ItemDigest shape{};  // of a mesh or a light, with its light group, but without its place: tells a move
                         // from another change
    map::Bounds
        bounds;  // world; of lamps and manual probes a point; of an interior its probe's place; of a sun none
    std::string name;

    bool operator==(const Item& other) const { return kind == other.kind && digest == other.digest; }
};

struct Inventory {
    std::vector<Item> items;  // by kind and digest
};

[[nodiscard]] Inventory take_inventory(bake::World& world);

[[nodiscard]] std::vector<std::uint8_t> encode_inventory(const Inventory& inventory);
// Nothing when the bytes are not such.
[[nodiscard]] std::optional<Inventory> decode_inventory(std::span<const std::uint8_t> bytes);

enum class ChangeKind : std::uint8_t { added, removed, moved, changed };

// One thing that is not the same in both maps; what has the same kind and name on both sides is one.
struct Change {
    ChangeKind kind = ChangeKind::changed;
    std::optional<Item> before;
    std::optional<Item> after;

    [[nodiscard]] const Item& item() const { return after ? *after : *before; }
};

// In the order of kind and name.
[[nodiscard]] std::vector<Change> changes_between(const Inventory& before, const Inventory& after);

}  // namespace drtv::reuse
