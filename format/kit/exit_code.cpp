#include "exit_code.h"

#include <cerrno>
#include <cstdio>

namespace drtv::kit {

void complain(const std::string& sentence) {
    std::fprintf(stderr, "%s: %s\n", program_invocation_short_name, sentence.c_str());
}

}  // namespace drtv::kit
