#include "bakerd/map/file_source.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <system_error>

namespace drtv::map {
namespace {

namespace fs = std::filesystem;

// What went wrong is told without the path.
tl::expected<FileBytes, FileFailure> read_file(const fs::path& path) {
    const auto fail = [](std::string sentence) { return tl::unexpected(FileFailure{std::move(sentence)}); };
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (error)
        return tl::unexpected(FileFailure{error.message(), status.type() == fs::file_type::not_found});
    // A pipe would be waited for without end.
    if (!fs::is_regular_file(status))
        return fail("it is not a regular file");
    const std::uintmax_t size = fs::file_size(path, error);
    if (error)
        return fail(error.message());
    if (size > max_file_bytes)
        return fail(fmt::format("it has {} bytes, over the limit of {}", size, max_file_bytes));
    FileBytes bytes(size);
    std::ifstream file(path, std::ios::binary);
    char* const data = reinterpret_cast<char*>(bytes.data());
    if (!file.read(data, static_cast<std::streamsize>(size)))
        return fail("it cannot be opened or became shorter");
    return bytes;
}

tl::expected<FileBytes, FileFailure> read_named(const std::string& path, const fs::path& place) {
    return read_file(place).map_error([&](FileFailure failure) {
        failure.sentence = fmt::format("cannot read {}: {}", path, failure.sentence);
        return failure;
    });
}

}  // namespace

FileSource folder_source(std::string folder) {
    return [folder = std::move(folder)](const std::string& path) {
        return read_named(path, folder + "/" + path);
    };
}

FileSource local_source(map_files::LocalMap map) {
    return [map = std::move(map)](const std::string& path) -> tl::expected<FileBytes, FileFailure> {
        const auto place = map.on_disk(path);
        if (!place)
            return tl::unexpected(FileFailure{fmt::format("the file '{}' is missing", path), true});
        return read_named(path, *place);
    };
}

}  // namespace drtv::map
