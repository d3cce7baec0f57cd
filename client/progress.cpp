#include "client/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace drtv::client {
namespace {

std::size_t terminal_width() {
    winsize size{};
    const bool is_known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return is_known ? size.ws_col : 80;
}

// Not below 0.
std::size_t less(std::size_t width, std::size_t taken) {
    return width > taken ? width - taken : 0;
}

}  // namespace

Progress::Progress()
    : on_terminal_(::isatty(STDERR_FILENO) == 1), colours_(std::getenv("NO_COLOR") == nullptr) {}

Progress::~Progress() {
    clear();
}

void Progress::show(double share, const std::string& text) {
    if (!on_terminal_)
        return;
    // The text counts more than the bar: on a narrow terminal the bar shrinks.
    constexpr std::size_t max_bar = 24;
    constexpr std::size_t frame = 4;
    const std::size_t width = terminal_width();
    const std::size_t bar = std::min(max_bar, less(width, text.size() + frame));
    const std::string shown = text.substr(0, less(width, bar + frame));
    const double bounded_share = std::clamp(share, 0.0, 1.0);
    const auto full = static_cast<std::size_t>(bounded_share * static_cast<double>(bar) + 0.5);
    std::string done(full, '#');
    const std::string left(bar - full, '.');
    if (colours_)
        done = "\x1b[32m" + done + "\x1b[0m";
    std::fprintf(stderr, "\r\x1b[K[%s%s] %s", done.c_str(), left.c_str(), shown.c_str());
    std::fflush(stderr);
    drawn_ = true;
}

void Progress::clear() {
    if (!drawn_)
        return;
    std::fputs("\r\x1b[K", stderr);
    std::fflush(stderr);
    drawn_ = false;
}

}  // namespace drtv::client
