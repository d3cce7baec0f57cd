// Mip levels: the picture at half the size and less, so that a distant texel is one look-up.
#pragma once

#include "bakerd/map/map.h"

namespace drtv::map {

// Fills `mips` and, unless coverage is whole, `alpha_blocks`. REQUIRES: size, wrapping, coverage and rgba are
// final.
void prefilter(Texture& texture);

}  // namespace drtv::map
