#include "bakerd/reuse/footprint.h"

#include "bakerd/bake/settings_key.h"

#include <string_view>

namespace drtv::reuse {

map::Digest results_key(const settings::BakeSettings& settings) {
    map::Hasher hasher;
    hasher.add_sized(std::string_view("drtv results"));
    hasher.add(bake::settings_key(settings));
    hasher.add(footprint_version);
    return hasher.finish();
}

}  // namespace drtv::reuse
