// The arrays that a daemon has made and not closed, as files in its store: tasks read them, and after a
// restart they say what may be at work.
#pragma once

#include "bakerd/store/error.h"
#include "bakerd/worker/array_file.h"

#include <string>
#include <utility>
#include <vector>

namespace drtv::executor {

class ArrayFolder {
  public:
    // Makes the folder where it is missing. `owner` is the daemon's data folder (store/owner.h).
    [[nodiscard]] static store::Result<ArrayFolder> open(const std::string& store_folder,
                                                         const std::string& owner);

    // Durable when it returns.
    [[nodiscard]] store::Result<void> write(const std::string& key, const worker::ArrayFile& array) const;
    // Tasks of it that begin later end at once.
    void remove(const std::string& key) const;

    // One that is no list of an array's sectors has no batches.
    [[nodiscard]] store::Result<std::vector<std::pair<std::string, worker::ArrayFile>>> all() const;

    [[nodiscard]] std::string path_of(const std::string& key) const;

  private:
    explicit ArrayFolder(std::string folder) : folder_(std::move(folder)) {}

    std::string folder_;
};

}  // namespace drtv::executor
