// The daemon's folder: one daemon at a time, blobs and database inside.
#pragma once

#include "bakerd/store/error.h"
#include "bakerd/store/file_descriptor.h"

#include <memory>
#include <string>

namespace drtv::farm {

// Holds the folder's lock while it lives.
class DataFolder {
  public:
    // Makes the folder when it is missing. Fails with a sentence when it cannot be written or another daemon
    // has it.
    [[nodiscard]] static store::Result<std::unique_ptr<DataFolder>> lock(const std::string& path);

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string blobs() const { return path_ + "/blobs"; }
    [[nodiscard]] std::string database() const { return path_ + "/farm.sqlite"; }

  private:
    DataFolder(std::string path, store::FileDescriptor lock)
        : path_(std::move(path)), lock_(std::move(lock)) {}
    const std::string path_;
    const store::FileDescriptor lock_;
};

}  // namespace drtv::farm
