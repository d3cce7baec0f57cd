#include "png_file.h"

#include "folder/whole_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace drtv::image {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::uint8_t, 8> signature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};

tl::unexpected<cli::Failure> cannot_write(const std::string& path, const std::string& why) {
    return cli::fail(cli::exit_unreadable, "cannot write " + path + ": " + why);
}

// False, too, for what cannot be opened: to write it fails with the reason.
bool is_something_else(const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (file == nullptr)
        return false;
    std::array<std::uint8_t, signature.size()> head{};
    const std::size_t size = std::fread(head.data(), 1, head.size(), file);
    std::fclose(file);
    return size > 0 && (size < head.size() || head != signature);
}

}  // namespace

cli::Result<void> check_png_target(const std::string& path) {
    std::error_code code;
    if (fs::is_directory(path, code))
        return cannot_write(path, "it is a folder");
    std::string ending = fs::path(path).extension().string();
    std::ranges::transform(ending, ending.begin(), [](char c) {
        return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    });
    if (ending != ".png")
        return cli::fail(cli::exit_usage,
                         path + ": a picture is written as .png, and " +
                             (ending.empty() ? "this name has no ending" : "not as " + ending));
    const fs::path folder = fs::absolute(path, code).parent_path();
    if (!fs::is_directory(folder, code))
        return cannot_write(path, "there is no folder " + folder.string());
    if (fs::is_regular_file(path, code) && is_something_else(path))
        return cli::fail(cli::exit_unreadable, path + " is there and no PNG file: it is not replaced");
    return {};
}

cli::Result<void> write_png_file(const std::string& path,
                                 const Image& image,
                                 const std::vector<PngText>& texts) {
    if (auto target = check_png_target(path); !target)
        return target;
    return encode_png(image, texts).and_then([&](const std::vector<std::uint8_t>& png) {
        return folder::write_whole(path, {reinterpret_cast<const char*>(png.data()), png.size()});
    });
}

}  // namespace drtv::image
