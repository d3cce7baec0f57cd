// Which build and machine bakes.
#pragma once

#include <cstdint>
#include <string>

namespace drtv::worker {

// Builds that are equal give equal bytes.
struct BuildId {
    std::uint32_t baker_version = 0;
    std::string commit;     // of the sources, as far as the build knew
    std::string isa_class;  // of the machine (trace/device.h)

    bool operator==(const BuildId&) const = default;
};

[[nodiscard]] BuildId this_build();

// Empty where a task of this build may work for one of `wanted`; else a sentence.
[[nodiscard]] std::string difference(const BuildId& wanted, const BuildId& here);

}  // namespace drtv::worker
