#include "progress_bar.h"

#include <unistd.h>

#include <cstdio>

namespace drtv::kit {
namespace {

constexpr auto first_after = std::chrono::milliseconds(300), between = std::chrono::milliseconds(100);
constexpr std::size_t width = 30;

}  // namespace

ProgressBar::ProgressBar(std::string verb, std::size_t total)
    : verb_(std::move(verb)),
      total_(total),
      on_terminal_(::isatty(STDERR_FILENO) == 1),
      next_(Clock::now() + first_after) {}

ProgressBar::~ProgressBar() {
    if (drawn_)
        std::fputs("\r\033[K", stderr);
}

void ProgressBar::show(std::size_t done) {
    if (!on_terminal_)
        return;
    const std::lock_guard lock(mutex_);
    if (Clock::now() < next_)
        return;
    next_ = Clock::now() + between;
    drawn_ = true;
    const std::size_t filled = done * width / total_;
    std::fprintf(stderr,
                 "\r[%s%s] %zu of %zu %s\033[K",
                 std::string(filled, '#').c_str(),
                 std::string(width - filled, '.').c_str(),
                 done,
                 total_,
                 verb_.c_str());
    std::fflush(stderr);
}

}  // namespace drtv::kit
