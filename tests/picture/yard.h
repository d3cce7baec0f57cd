// The talk's scene with lamps, a glowing box and leaves, baked and ready for pictures.
#pragma once

#include "bakerd/picture/moment.h"
#include "bakerd/picture/scenery.h"
#include "tests/ambient/baked_map.h"
#include "tests/map/gltf_builder.h"

#include <memory>

namespace drtv::test {

[[nodiscard]] GltfBuilder yard();
// Baked once for each process.
[[nodiscard]] const BakedMap& baked_yard();
[[nodiscard]] const picture::Scenery& yard_scenery();

// Of a map written in memory, around the origin.
[[nodiscard]] std::unique_ptr<const picture::Scenery> scenery_of(const GltfBuilder& builder);

// The built-in day at 10 hours, lamps of the map lit, and one lamp of the game.
[[nodiscard]] std::unique_ptr<kit::RequestedLight> morning();

}  // namespace drtv::test
