#include "bakerd/bake/settings_key.h"

#include "bakerd/trace/device.h"
#include "settings/table.h"

#include <string_view>

namespace drtv::bake {

map::Digest settings_key(const settings::BakeSettings& settings) {
    constexpr std::uint32_t format_version = 1;
    map::Hasher hasher;
    hasher.add_sized(std::string_view("drtv settings"));
    hasher.add(format_version);
    hasher.add(baker_version);
    hasher.add_sized(trace::isa_class());
    const settings::JobSettings all{settings};
    for (const settings::Setting& setting : settings::table()) {
        if (settings::is_of_bake(setting) && (settings.local_transfer || !setting.of_local_transfer))
            settings::visit_value(all, setting, [&](auto value) { hasher.add(value); });
    }
    return hasher.finish();
}

}  // namespace drtv::bake
