#include "bakerd/map/file_source.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace drtv::map {

FileSource folder_source(std::string folder) {
    return [folder = std::move(folder)](const std::string& path) -> tl::expected<FileBytes, std::string> {
        std::ifstream file(folder + "/" + path, std::ios::binary | std::ios::ate);
        const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
        // A folder opens too, but has no sensible size.
        if (size < 0 || size > (std::streamoff{1} << 40)) {
            return tl::unexpected(fmt::format("cannot read {}: {}", path, std::strerror(errno == 0 ? EISDIR : errno)));
        }
        FileBytes bytes(static_cast<std::size_t>(size));
        file.seekg(0);
        if (size > 0 && !file.read(reinterpret_cast<char*>(bytes.data()), size)) {
            return tl::unexpected(fmt::format("cannot read {}: {}", path, std::strerror(errno)));
        }
        return bytes;
    };
}

}  // namespace drtv::map
