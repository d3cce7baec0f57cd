// What the steps of an import work on: one document, and the map that all documents go into.
#pragma once

#include "bakerd/map/gltf_document.h"
#include "bakerd/map/map.h"

#include <cstdint>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

// A step that adds to the map. The sentence names the file and the element unless the step says otherwise.
using Imported = tl::expected<void, std::string>;

struct HashDigest {
    std::size_t operator()(const Digest& digest) const {
        std::size_t value = 0;
        for (std::size_t k = 0; k < sizeof value; ++k)
            value = value << 8 | digest.bytes[k];
        return value;
    }
};

using IndexByDigest = std::unordered_map<Digest, std::uint32_t, HashDigest>;

// Equal things of several documents (or of one) are kept once.
struct Shared {
    IndexByDigest textures;
    IndexByDigest materials;
    IndexByDigest meshes;
    std::unordered_map<std::uint32_t, glm::vec3> brightest;  // by texture
    std::set<std::string> warned_of_brightness;              // file and material
};

struct ImportState {
    const GltfDocument& document;
    Map& map;
    Shared& shared;
};

// The index of the thing, or of an equal one that was there before. REQUIRES: its digest is final.
template <class Thing>
std::uint32_t keep_once(Thing thing, std::vector<Thing>& things, IndexByDigest& index_of) {
    const auto next = static_cast<std::uint32_t>(things.size());
    const auto [entry, added] = index_of.try_emplace(thing.digest, next);
    if (added)
        things.push_back(std::move(thing));
    return entry->second;
}

}  // namespace drtv::map
