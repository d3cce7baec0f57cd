#include "bakerd/map/file_source.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <system_error>

namespace drtv::map {

FileSource folder_source(std::string folder) {
    return [folder = std::move(folder)](const std::string& path) -> tl::expected<FileBytes, std::string> {
        const auto fail = [&](const std::string& why) {
            return tl::unexpected(fmt::format("cannot read {}: {}", path, why));
        };
        const std::filesystem::path full = folder + "/" + path;
        std::error_code error;
        const std::filesystem::file_status status = std::filesystem::status(full, error);
        if (error)
            return fail(error.message());
        // A pipe would be waited for without end.
        if (!std::filesystem::is_regular_file(status))
            return fail("it is not a regular file");
        const std::uintmax_t size = std::filesystem::file_size(full, error);
        if (error)
            return fail(error.message());
        if (size > max_file_bytes)
            return fail(fmt::format("it has {} bytes, over the limit of {}", size, max_file_bytes));
        FileBytes bytes(static_cast<std::size_t>(size));
        std::ifstream file(full, std::ios::binary);
        if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
            return fail("it cannot be opened or became shorter");
        return bytes;
    };
}

}  // namespace drtv::map
