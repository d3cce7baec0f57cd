// The daemon's folder: one daemon at a time, blobs and database inside.
#pragma once

#include "bakerd/store/error.h"
#include "bakerd/store/file_descriptor.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace drtv::farm {

// The name of the file system that statfs tells by this number, where it is one over a network; else "".
[[nodiscard]] std::string_view network_file_system(std::uint32_t magic);

// Holds the folder's lock while it lives.
class DataFolder {
  public:
    // Makes the folder when it is missing. Fails with a sentence when it cannot be written, is another
    // daemon's, or lies on a network file system, where the database would not be safe.
    [[nodiscard]] static store::Result<std::unique_ptr<DataFolder>> lock(const std::string& path);

    [[nodiscard]] const std::string& path() const { return path_; }
    // Random, and kept in the folder: by it a store knows its daemon.
    [[nodiscard]] store::Result<std::string> id() const;
    [[nodiscard]] std::string database() const { return path_ + "/farm.sqlite"; }

  private:
    DataFolder(std::string path, store::FileDescriptor lock)
        : path_(std::move(path)), lock_(std::move(lock)) {}
    const std::string path_;
    const store::FileDescriptor lock_;
};

}  // namespace drtv::farm
