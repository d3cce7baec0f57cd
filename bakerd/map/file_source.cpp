#include "bakerd/map/file_source.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <system_error>

namespace drtv::map {
namespace {

namespace fs = std::filesystem;

// What went wrong is told without the path.
tl::expected<FileBytes, std::string> read_file(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (error)
        return tl::unexpected(error.message());
    // A pipe would be waited for without end.
    if (!fs::is_regular_file(status))
        return tl::unexpected(std::string("it is not a regular file"));
    const std::uintmax_t size = fs::file_size(path, error);
    if (error)
        return tl::unexpected(error.message());
    if (size > max_file_bytes)
        return tl::unexpected(fmt::format("it has {} bytes, over the limit of {}", size, max_file_bytes));
    FileBytes bytes(size);
    std::ifstream file(path, std::ios::binary);
    char* const data = reinterpret_cast<char*>(bytes.data());
    if (!file.read(data, static_cast<std::streamsize>(size)))
        return tl::unexpected(std::string("it cannot be opened or became shorter"));
    return bytes;
}

}  // namespace

FileSource folder_source(std::string folder) {
    return [folder = std::move(folder)](const std::string& path) {
        const fs::path full = folder + "/" + path;
        return read_file(full).map_error(
            [&](const std::string& why) { return fmt::format("cannot read {}: {}", path, why); });
    };
}

}  // namespace drtv::map
