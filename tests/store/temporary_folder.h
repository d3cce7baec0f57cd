// A folder for one test, gone with it, and bytes to fill it with.
#pragma once

#include "tests/store/bytes_of.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::test {

class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    std::string path_;
};

// Differ for each seed.
[[nodiscard]] std::vector<std::uint8_t> noise(std::size_t size, std::uint32_t seed);

// Below the folder, at any depth.
[[nodiscard]] std::size_t files_below(const std::string& folder);
void write_file(const std::string& path, std::string_view text);

}  // namespace drtv::test
