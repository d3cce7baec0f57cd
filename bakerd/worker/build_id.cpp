#include "bakerd/worker/build_id.h"

#include "bakerd/bake/settings_key.h"
#include "bakerd/trace/device.h"

#include <fmt/format.h>

#include <sstream>

namespace drtv::worker {

BuildId this_build() {
    return {bake::baker_version, DRTV_COMMIT, std::string(trace::isa_class())};
}

std::string text_of(const BuildId& build) {
    return fmt::format("{} {} {}", build.baker_version, build.commit, build.isa_class);
}

std::optional<BuildId> build_of(const std::string& text) {
    BuildId build;
    std::istringstream words(text);
    if (!(words >> build.baker_version >> build.commit >> build.isa_class))
        return std::nullopt;
    return build;
}

std::string difference(const BuildId& wanted, const BuildId& here) {
    if (wanted.baker_version != here.baker_version)
        return fmt::format(
            "the daemon has baker version {}, and bakerd here has {}: install the "
            "daemon's build on this node",
            wanted.baker_version,
            here.baker_version);
    if (wanted.commit != here.commit)
        return fmt::format(
            "the daemon is a build of {}, and bakerd here is one of {}: install the "
            "daemon's build on this node",
            wanted.commit,
            here.commit);
    if (wanted.isa_class != here.isa_class)
        return fmt::format(
            "the daemon has the instruction set class {}, and this node has {}: keep the "
            "node out by a constraint",
            wanted.isa_class,
            here.isa_class);
    return "";
}

}  // namespace drtv::worker
