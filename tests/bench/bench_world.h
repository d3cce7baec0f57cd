// A map opened for a bench, and the probes of its middle sector.
#pragma once

#include "bakerd/bake/world.h"
#include "bakerd/map/import.h"

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace drtv::bench {

[[nodiscard]] inline double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Nothing, and a sentence on stderr, when the map is refused.
[[nodiscard]] inline std::shared_ptr<bake::World> open_world(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    const std::vector<std::string> names = {path.substr(slash == std::string::npos ? 0 : slash + 1)};
    auto map =
        map::import_map(names, map::folder_source(slash == std::string::npos ? "." : path.substr(0, slash)));
    if (!map) {
        std::fprintf(stderr, "%s\n", map.error().c_str());
        return nullptr;
    }
    return bake::World::open(trace::Device::open().value(), std::make_shared<const map::Map>(std::move(*map)))
        .value();
}

[[nodiscard]] inline map::SectorCoordinate middle_sector(const bake::World& world) {
    return world.sectors()[world.sectors().size() / 2];
}

}  // namespace drtv::bench
