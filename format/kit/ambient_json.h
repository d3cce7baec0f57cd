// The light of a place as JSON.
#pragma once

#include "json_writer.h"

#include <drtv/ambient.h>

#include <cstdint>

namespace drtv::kit {

// "parts", with each of them.
void append_parts(JsonWriter& json, const AmbientParts& parts);

// Under the key the sector and an index within it; null where there is none.
void append_reference(JsonWriter& json, const char* key, const LoadedSector* sector, std::uint32_t index);

}  // namespace drtv::kit
