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
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
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
    constexpr std::size_t widest_bar = 24, frame = 4;
    const std::size_t width = terminal_width(),
                      beside = width > text.size() + frame ? width - text.size() - frame : 0;
    const std::size_t bar = std::min(widest_bar, beside);
    const auto full = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(bar) + 0.5);
    std::string done(full, '#'), left(bar - full, '.');
    const std::string shown = text.substr(0, width > bar + frame ? width - bar - frame : 0);
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
