#include "client/user_name.h"

#include <pwd.h>
#include <unistd.h>

#include <array>

namespace drtv::client {

std::string user_name() {
    passwd entry{};
    passwd* found = nullptr;
    std::array<char, 4096> text{};
    const bool is_known =
        ::getpwuid_r(::getuid(), &entry, text.data(), text.size(), &found) == 0 && found != nullptr;
    return is_known ? found->pw_name : std::to_string(::getuid());
}

}  // namespace drtv::client
