// Sound maps with much in little room: what tests damage, and what fuzzing starts from.
#pragma once

#include "tests/map/gltf_builder.h"

namespace drtv::test {

// A little of everything, in about 3 KiB.
[[nodiscard]] GltfBuilder specimen();

// The extensions of materials, volumes with a named probe, quantised positions and strips.
[[nodiscard]] GltfBuilder extended_specimen();

}  // namespace drtv::test
