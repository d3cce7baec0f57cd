#include "version.h"

#include "drtv_commit.h"

#include <drtv/version.h>

namespace drtv::cli {

std::string_view built_isa_class() {
#if defined(__AVX2__)
    return "x86-64-avx2";
#elif defined(__x86_64__) || defined(_M_X64)
    return "x86-64";
#elif defined(__aarch64__) || defined(_M_ARM64)
    return "aarch64";
#else
    return "unknown instruction set";
#endif
}

std::string version_text(std::string_view program, std::string_view isa_class, std::string_view more) {
    std::string text =
        std::string(program) + " " DRTV_VERSION " (commit " DRTV_COMMIT ", " + std::string(isa_class);
    if (!more.empty())
        text += ", " + std::string(more);
    return text + ")";
}

}  // namespace drtv::cli
