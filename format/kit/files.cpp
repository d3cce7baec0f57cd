#include "files.h"

#include "folder/whole_file.h"

#include <drtv/read.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace drtv::kit {

namespace fs = std::filesystem;

namespace {

// Whether the bytes are the beginning of a sector file, as far as they go.
bool may_be_sector(const FileBytes& bytes) {
    constexpr std::string_view magic = "DRTV";
    const std::string_view start = magic.substr(0, bytes.size());
    return std::equal(start.begin(), start.end(), bytes.begin());
}

// The first bytes of a file, as many as there are; nothing where it cannot be opened.
std::optional<std::size_t> read_head(const std::string& path, std::span<std::uint8_t> head) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (file == nullptr)
        return std::nullopt;
    const std::size_t size = std::fread(head.data(), 1, head.size(), file);
    std::fclose(file);
    return size;
}

// "cannot read a.drtv: No such file or directory", as `errno` tells it.
tl::unexpected<cli::Failure> cannot_read(const std::string& path) {
    return cli::fail(cli::exit_unreadable, "cannot read " + path + ": " + std::strerror(errno));
}

}  // namespace

cli::Result<FileBytes> read_file(const std::string& path) {
    std::error_code code;
    if (fs::is_directory(path, code))
        return cli::fail(cli::exit_unreadable, path + " is a folder, not a file");
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (file == nullptr)
        return cannot_read(path);
    FileBytes bytes;
    std::uint8_t buffer[65536];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, file)) > 0;) {
        bytes.insert(bytes.end(), buffer, buffer + n);
        // What is no sector file is refused by its first bytes, however long it is.
        if (!may_be_sector(bytes))
            break;
    }
    const bool failed = std::ferror(file) != 0;
    std::fclose(file);
    if (failed)
        return cannot_read(path);
    return bytes;
}

cli::Result<std::string> read_standard_input() {
    std::string text;
    char buffer[65536];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, stdin)) > 0;)
        text.append(buffer, n);
    if (std::ferror(stdin) != 0)
        return cannot_read("standard input");
    return text;
}

std::optional<std::pair<std::int32_t, std::int32_t>> sector_of_file(const std::string& path) {
    constexpr std::size_t sector_at = 16;  // in the header (SPEC.md, section 4.1): i, then j
    std::array<std::uint8_t, sector_at + 8> head{};
    if (read_head(path, head) != head.size() || !may_be_sector(FileBytes(head.begin(), head.end())))
        return std::nullopt;
    std::pair<std::int32_t, std::int32_t> sector;
    std::memcpy(&sector.first, &head[sector_at], sizeof sector.first);
    std::memcpy(&sector.second, &head[sector_at + 4], sizeof sector.second);
    return sector;
}

cli::Result<void> write_file(const std::string& path, const FileBytes& bytes) {
    return folder::write_whole(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string format_version(std::span<const std::uint8_t> bytes) {
    const auto number = [&](std::size_t at) {
        const unsigned low = bytes[at];
        const unsigned high = bytes[at + 1];
        return std::to_string(low | high << 8);
    };
    return number(4) + "." + number(6);
}

cli::Result<FilePaths> sector_files(const std::string& path) {
    std::error_code code;
    const fs::file_status status = fs::status(path, code);
    if (!fs::exists(status))
        return cli::fail(cli::exit_unreadable, (path.empty() ? "\"\"" : path) + " does not exist");
    if (!fs::is_directory(status))
        return FilePaths{path};
    FilePaths files;
    fs::recursive_directory_iterator entry(path, code);
    for (; !code && entry != fs::recursive_directory_iterator(); entry.increment(code)) {
        std::error_code ignored;
        if (entry->path().extension() == ".drtv" && entry->is_regular_file(ignored))
            files.push_back(entry->path().string());
    }
    if (code)
        return cli::fail(cli::exit_unreadable, "cannot read the folder " + path + ": " + code.message());
    if (files.empty())
        return cli::fail(cli::exit_unreadable, "the folder " + path + " holds no .drtv file");
    std::sort(files.begin(), files.end());
    return files;
}

namespace {

// What `open(bytes, opened)` makes of a file's bytes.
template <class Opened, class Open>
cli::Result<Opened> opened_file(const std::string& path, const Open& open) {
    auto file = read_file(path);
    if (!file)
        return tl::unexpected(file.error());
    Opened opened;
    if (const ReadStatus status = open(*file, opened); !status.ok())
        return cli::fail(cli::exit_invalid, path + ": " + status.message);
    return opened;
}

}  // namespace

cli::Result<RawSector> load_raw_sector(const std::string& path) {
    return opened_file<RawSector>(path, [](const FileBytes& file, RawSector& sector) {
        const ReadStatus status = unpack_sector(file, sector.bytes);
        return status.ok() ? open_sector(sector.bytes, sector.view) : status;
    });
}

cli::Result<Sector> load_sector(const std::string& path, FileBytes* bytes) {
    return opened_file<Sector>(path, [bytes](FileBytes& file, Sector& sector) {
        const ReadStatus status = read_sector(file, sector);
        if (status.ok() && bytes != nullptr)
            *bytes = std::move(file);
        return status;
    });
}

}  // namespace drtv::kit
