// A progress line on standard error, on a terminal only.
#pragma once

#include <string>

namespace drtv::client {

class Progress {
  public:
    Progress();
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Draws a bar with a text behind it over the line drawn before.
    void show(double share, const std::string& text);

    // Takes the line away, so that ordinary output can follow.
    void clear();

  private:
    const bool on_terminal_;
    const bool colours_;
    bool drawn_ = false;
};

}  // namespace drtv::client
