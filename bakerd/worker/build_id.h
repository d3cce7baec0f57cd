// Which build and machine bakes.
#pragma once

#include <cstdint>
#include <optional>
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

// One line, and back; nothing where the line is none.
[[nodiscard]] std::string text_of(const BuildId& build);
[[nodiscard]] std::optional<BuildId> build_of(const std::string& text);

// Empty where a task of this build may work for one of `wanted`; else a sentence.
[[nodiscard]] std::string difference(const BuildId& wanted, const BuildId& here);

}  // namespace drtv::worker
