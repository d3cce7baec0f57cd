#include "bakerd/reuse/inventory.h"

#include "bakerd/map/content_digest.h"
#include "bakerd/reuse/record_bytes.h"

#include <algorithm>
#include <iterator>
#include <tuple>

namespace drtv::reuse {
namespace {

constexpr std::uint64_t magic = 0x32'4E'49'56'54'52'44;  // "DRTVIN2"

// Beside the kind.
constexpr unsigned emissive_bit = 128;
constexpr unsigned bounds_volume_bit = 64;

ItemDigest half(const map::Digest& digest) {
    ItemDigest first{};
    std::copy_n(digest.bytes.begin(), first.size(), first.begin());
    return first;
}

map::Bounds point(const glm::vec3& place) {
    map::Bounds bounds;
    bounds.extend(place);
    return bounds;
}

ItemDigest digest_of_probe(const glm::dvec3& position) {
    map::Hasher hasher;
    hasher.add(position);
    return half(hasher.finish());
}

ItemDigest digest_of_interior(const bake::InteriorVolume& interior) {
    map::Hasher hasher;
    hasher.add(*interior.probe);
    hasher.add(interior.stored.origin_units);
    hasher.add(interior.stored.shift);
    hasher.add_sized(interior.stored.vertices);
    hasher.add_sized(interior.stored.triangles);
    // The file's vertices are rounded; placement asks the mesh as it is.
    hasher.add_sized(interior.volume.vertices());
    hasher.add_sized(interior.volume.triangles());
    return half(hasher.finish());
}

// Of a light, all but where it is.
ItemDigest shape_of_light(const map::Light& light, const map::Map& map) {
    map::Hasher hasher;
    hasher.add(light.colour);
    for (const float value :
         {light.intensity, light.range_m, light.inner_cone_radians, light.outer_cone_radians})
        hasher.add(value);
    hasher.add(light.direction);
    map::add_light_group(hasher, light.light_group, map);
    return half(hasher.finish());
}

// Of an object, all but where it is and what its role is.
ItemDigest shape_of_object(const map::Object& object, const map::Map& map) {
    map::Hasher hasher;
    hasher.add(map.meshes[object.mesh].digest);
    map::add_light_group(hasher, object.light_group, map);
    return half(hasher.finish());
}

auto order(const Item& item) {
    return std::tie(item.kind, item.digest);
}

// Those of `a` that are not in `b`, as often as they are there more often.
std::vector<Item> only_in(const std::vector<Item>& a, const std::vector<Item>& b) {
    std::vector<Item> only;
    std::ranges::set_difference(a, b, std::back_inserter(only), {}, order, order);
    return only;
}

// What counts as one thing that may have changed; objects may change their role.
auto identity(const Item& item) {
    const bool object = item.kind == ItemKind::fixed || item.kind == ItemKind::vegetation;
    return std::tuple(object ? ItemKind::fixed : item.kind, std::string_view(item.name));
}

}  // namespace

Inventory take_inventory(bake::World& world) {
    Inventory inventory;
    const map::Map& map = world.map();
    std::size_t next_emissive = 0;
    const std::span<const bake::EmissiveObject> emissive = world.lights().emissive();
    for (std::uint32_t n = 0; n < map.objects.size(); ++n) {
        const map::Object& object = map.objects[n];
        const bool shines = next_emissive < emissive.size() && emissive[next_emissive].object == n;
        if (shines)
            ++next_emissive;
        const bool vegetation = object.role == map::Role::vegetation;
        inventory.items.push_back({vegetation ? ItemKind::vegetation : ItemKind::fixed,
                                   shines,
                                   vegetation && world.bounds_volume(object.mesh),
                                   half(object.digest),
                                   shape_of_object(object, map),
                                   object.bounds,
                                   object.name});
    }
    for (const map::Light& light : map.lights) {
        if (!map::shines(light))
            continue;
        const bool sun = light.kind == map::LightKind::directional;
        inventory.items.push_back({sun ? ItemKind::sun : ItemKind::lamp,
                                   false,
                                   false,
                                   half(light.digest),
                                   shape_of_light(light, map),
                                   sun ? map::Bounds() : point(light.position),
                                   light.name});
    }
    for (const map::ProbeNode& probe : map.probes) {
        inventory.items.push_back({ItemKind::manual_probe,
                                   false,
                                   false,
                                   digest_of_probe(probe.position),
                                   {},
                                   point(glm::vec3(probe.position)),
                                   probe.name});
    }
    for (const map::VolumeNode& volume : map.volumes) {
        if (volume.kind == map::VolumeKind::interior)
            continue;
        map::Bounds bounds;
        for (const glm::dvec3& position : volume.positions)
            bounds.extend(glm::vec3(position));
        const ItemKind kind =
            volume.kind == map::VolumeKind::spacing ? ItemKind::spacing : ItemKind::no_probes;
        inventory.items.push_back({kind, false, false, half(volume.digest), {}, bounds, volume.name});
    }
    for (const bake::InteriorVolume& interior : world.interiors()) {
        if (!interior.probe)
            continue;  // no file holds it
        inventory.items.push_back({ItemKind::interior,
                                   false,
                                   false,
                                   digest_of_interior(interior),
                                   {},
                                   point(placement::metres(*interior.probe)),
                                   interior.name});
    }
    std::ranges::stable_sort(inventory.items, {}, order);
    return inventory;
}

// Column by column: alike stands beside alike, for the compression.
std::vector<std::uint8_t> encode_inventory(const Inventory& inventory) {
    RecordWriter writer;
    writer.add(magic);
    writer.add(static_cast<std::uint64_t>(inventory.items.size()));
    for (const Item& item : inventory.items)
        writer.add(static_cast<std::uint8_t>(static_cast<unsigned>(item.kind) |
                                             (item.emissive ? emissive_bit : 0u) |
                                             (item.bounds_volume ? bounds_volume_bit : 0u)));
    for (const Item& item : inventory.items)
        writer.add(item.digest);
    for (const Item& item : inventory.items)
        writer.add(item.shape);
    for (const Item& item : inventory.items)
        writer.add(item.bounds);
    for (const Item& item : inventory.items)
        writer.add_text(item.name);
    return writer.compressed();
}

std::optional<Inventory> decode_inventory(std::span<const std::uint8_t> bytes) {
    RecordReader reader(bytes);
    if (reader.read<std::uint64_t>() != magic)
        return std::nullopt;
    const auto count = reader.read<std::uint64_t>();
    Inventory inventory;
    for (std::uint64_t n = 0; n < count && reader.sound(); ++n) {
        const auto bits = reader.read<std::uint8_t>();
        const unsigned kind = bits & ~(emissive_bit | bounds_volume_bit);
        if (kind > static_cast<unsigned>(ItemKind::spacing))
            return std::nullopt;
        Item& item = inventory.items.emplace_back();
        item.kind = static_cast<ItemKind>(kind);
        item.emissive = (bits & emissive_bit) != 0;
        item.bounds_volume = (bits & bounds_volume_bit) != 0;
    }
    for (Item& item : inventory.items)
        item.digest = reader.read<ItemDigest>();
    for (Item& item : inventory.items)
        item.shape = reader.read<ItemDigest>();
    for (Item& item : inventory.items)
        item.bounds = reader.read<map::Bounds>();
    for (Item& item : inventory.items)
        item.name = reader.read_text();
    if (!reader.complete())
        return std::nullopt;
    return inventory;
}

std::vector<Change> changes_between(const Inventory& before, const Inventory& after) {
    std::vector<Item> gone = only_in(before.items, after.items);
    std::vector<Item> come = only_in(after.items, before.items);
    std::ranges::stable_sort(gone, {}, identity);
    std::ranges::stable_sort(come, {}, identity);
    std::vector<Change> changes;
    auto old_item = gone.begin();
    auto new_item = come.begin();
    while (old_item != gone.end() || new_item != come.end()) {
        if (new_item == come.end() || (old_item != gone.end() && identity(*old_item) < identity(*new_item))) {
            changes.push_back({ChangeKind::removed, *old_item++, std::nullopt});
        } else if (old_item == gone.end() || identity(*new_item) < identity(*old_item)) {
            changes.push_back({ChangeKind::added, std::nullopt, *new_item++});
        } else {
            const bool moved = old_item->shape == new_item->shape && old_item->kind == new_item->kind;
            changes.push_back({moved ? ChangeKind::moved : ChangeKind::changed, *old_item++, *new_item++});
        }
    }
    return changes;
}

}  // namespace drtv::reuse
