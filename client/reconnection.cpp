#include "client/reconnection.h"

#include "client/interrupt.h"
#include "format/cli/report.h"

#include <fmt/format.h>

#include <thread>

namespace drtv::client {

bool Reconnection::try_again(bool heard) {
    constexpr std::chrono::seconds patience{60};
    constexpr std::chrono::milliseconds pause{300};
    if (heard)
        last_contact_ = Clock::now();
    if (Clock::now() - last_contact_ > patience || time_is_over() || interrupted())
        return false;
    if (!told_)
        cli::note(fmt::format("lost bakerd at {}; trying again for up to {} s", server_, patience.count()));
    told_ = true;
    std::this_thread::sleep_for(pause);
    return true;
}

}  // namespace drtv::client
