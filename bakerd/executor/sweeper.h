// Takes away what tasks and daemons left in a store and nobody reads any more: at the start and once a day,
// on a thread of its own, because a store on a network takes a millisecond for each file.
#pragma once

#include <string>
#include <thread>

namespace drtv::executor {

class Sweeper {
  public:
    // `owner` is the daemon's data folder (store/owner.h).
    Sweeper(std::string store_folder, std::string owner);

  private:
    std::jthread thread_;
};

}  // namespace drtv::executor
