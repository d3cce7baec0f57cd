// The daemon's folder: one daemon at a time, blobs and database inside.
#pragma once

#include "bakerd/farm/error.h"

#include <memory>
#include <string>

namespace drtv::farm {

// Holds the folder's lock while it lives.
class DataFolder {
  public:
    // Makes the folder when it is missing. Fails with a sentence when it cannot be written or another daemon
    // has it.
    [[nodiscard]] static Result<std::unique_ptr<DataFolder>> lock(const std::string& path);
    ~DataFolder();
    DataFolder(const DataFolder&) = delete;
    DataFolder& operator=(const DataFolder&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string blobs() const { return path_ + "/blobs"; }
    [[nodiscard]] std::string database() const { return path_ + "/farm.sqlite"; }

  private:
    DataFolder(std::string path, int fd) : path_(std::move(path)), fd_(fd) {}
    std::string path_;
    int fd_;
};

}  // namespace drtv::farm
