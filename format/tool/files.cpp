#include "files.h"

#include "commands.h"

#include <drtv/read.h>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>

namespace drtv::tool {

namespace fs = std::filesystem;

std::optional<std::vector<std::uint8_t>> read_file(const std::string& path, std::string& error) {
    std::error_code code;
    if (fs::is_directory(path, code)) {
        error = path + " is a folder, not a file";
        return std::nullopt;
    }
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (file == nullptr) {
        error = "cannot read " + path + ": " + std::strerror(errno);
        return std::nullopt;
    }
    std::vector<std::uint8_t> bytes;
    std::uint8_t buffer[65536];
    constexpr std::string_view magic = "DRTV";
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, file)) > 0;) {
        bytes.insert(bytes.end(), buffer, buffer + n);
        // What is no sector file is refused by its first bytes, however long it is.
        if (!std::equal(magic.begin(),
                        magic.begin() + static_cast<std::ptrdiff_t>(std::min(magic.size(), bytes.size())),
                        bytes.begin()))
            break;
    }
    const bool failed = std::ferror(file) != 0;
    std::fclose(file);
    if (failed) {
        error = "cannot read " + path + ": " + std::strerror(errno);
        return std::nullopt;
    }
    return bytes;
}

bool write_file(const std::string& link, const std::vector<std::uint8_t>& bytes, std::string& error) {
    // The file behind a link is replaced, not the link; a device or a pipe is not replaced at all.
    std::error_code code;
    const std::string path = fs::is_symlink(link, code) ? fs::weakly_canonical(link, code).string() : link;
    if (const fs::file_status status = fs::status(path, code);
        fs::exists(status) && !fs::is_regular_file(status)) {
        error = "cannot write " + link + ": it is not a regular file";
        return false;
    }
    const std::string temporary = path + ".tmp" + std::to_string(::getpid());
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    bool written = file != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (file != nullptr && std::fclose(file) != 0)
        written = false;
    if (written && std::rename(temporary.c_str(), path.c_str()) == 0)
        return true;
    error = "cannot write " + path + ": " + std::strerror(errno);
    if (file != nullptr)
        std::remove(temporary.c_str());
    return false;
}

std::string format_version(std::span<const std::uint8_t> bytes) {
    const auto number = [&](std::size_t at) {
        return std::to_string(unsigned{bytes[at]} | unsigned{bytes[at + 1]} << 8);
    };
    return number(4) + "." + number(6);
}

std::optional<std::vector<std::string>> sector_files(const std::string& path) {
    std::error_code code;
    const fs::file_status status = fs::status(path, code);
    if (!fs::exists(status)) {
        complain((path.empty() ? "\"\"" : path) + " does not exist");
        return std::nullopt;
    }
    if (!fs::is_directory(status))
        return std::vector<std::string>{path};
    std::vector<std::string> files;
    fs::recursive_directory_iterator entry(path, code);
    for (; !code && entry != fs::recursive_directory_iterator(); entry.increment(code)) {
        std::error_code ignored;
        if (entry->path().extension() == ".drtv" && entry->is_regular_file(ignored))
            files.push_back(entry->path().string());
    }
    if (code) {
        complain("cannot read the folder " + path + ": " + code.message());
        return std::nullopt;
    }
    if (files.empty()) {
        complain("the folder " + path + " holds no .drtv file");
        return std::nullopt;
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::optional<Sector> load_sector(const std::string& path, int& exit_code, std::vector<std::uint8_t>* bytes) {
    std::string error;
    auto read = read_file(path, error);
    if (!read) {
        complain(error);
        exit_code = exit_unreadable;
        return std::nullopt;
    }
    std::optional<Sector> sector(std::in_place);
    if (const ReadStatus status = read_sector(*read, *sector); !status.ok()) {
        complain(path + ": " + status.message);
        exit_code = exit_invalid;
        return std::nullopt;
    }
    if (bytes != nullptr)
        *bytes = std::move(*read);
    return sector;
}

}  // namespace drtv::tool
