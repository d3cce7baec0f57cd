#include "bakerd/map/document_uri.h"

#include <fmt/format.h>

#include <algorithm>

namespace drtv::map {
namespace {

// Not std::isalnum, which asks the locale.
bool is_base64(char c) {
    const bool is_letter = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    const bool is_digit = c >= '0' && c <= '9';
    return is_letter || is_digit || c == '+' || c == '/';
}

std::optional<int> hex_digit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return std::nullopt;
}

bool is_absolute(const std::string& path) {
    const bool has_drive_or_scheme = path.find(':') != std::string::npos;
    return path.starts_with("/") || path.starts_with("\\") || has_drive_or_scheme;
}

bool is_valid(const std::string& path) {
    constexpr std::string_view never("\0\\", 2);
    return !path.empty() && path.find_first_of(never) == std::string::npos;
}

bool leaves_folder(std::string_view path) {
    for (std::size_t start = 0; start <= path.size();) {
        const std::size_t end = std::min(path.find('/', start), path.size());
        const std::string_view name = path.substr(start, end - start);
        if (name == "..")
            return true;
        start = end + 1;
    }
    return false;
}

// The digits of a data uri's base64, without what follows them; nothing when it is not base64.
std::optional<std::string_view> base64_of(std::string_view data_uri) {
    constexpr std::string_view marker = ";base64,";
    const std::size_t comma = data_uri.find(',');
    if (comma == std::string_view::npos)
        return std::nullopt;
    const std::size_t found = data_uri.substr(0, comma + 1).rfind(marker);
    if (found == std::string_view::npos)
        return std::nullopt;
    const std::string_view rest = data_uri.substr(found + marker.size());
    const auto* end = std::ranges::find_if_not(rest, is_base64);
    return rest.substr(0, static_cast<std::size_t>(end - rest.begin()));
}

// 3 bytes are 4 digits, 1 are 2, 2 are 3.
std::size_t digits_for(std::size_t size_bytes) {
    return (size_bytes * 4 + 2) / 3;
}

}  // namespace

tl::expected<void, std::string> check_path(const std::string& path) {
    if (is_absolute(path))
        return tl::unexpected(
            fmt::format("the path '{}' is absolute, it must lie in the map's folder", path));
    if (!is_valid(path))
        return tl::unexpected(fmt::format("the path '{}' is not valid", path));
    if (leaves_folder(path))
        return tl::unexpected(fmt::format("the path '{}' leaves the map's folder", path));
    return {};
}

std::optional<std::string> decode_uri(const std::string& uri) {
    std::string decoded;
    for (std::size_t n = 0; n < uri.size(); ++n) {
        if (uri[n] != '%') {
            decoded += uri[n];
            continue;
        }
        if (n + 2 >= uri.size())
            return std::nullopt;
        const std::optional<int> high = hex_digit(uri[n + 1]);
        const std::optional<int> low = hex_digit(uri[n + 2]);
        if (!high || !low)
            return std::nullopt;
        decoded += static_cast<char>(*high * 16 + *low);
        n += 2;
    }
    return decoded;
}

bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

tl::expected<std::string, std::string> plain_data_uri(std::string_view uri, SizeBytes size_bytes) {
    const std::optional<std::string_view> base64 = base64_of(uri);
    if (!base64)
        return tl::unexpected(std::string("its data uri is not base64"));
    const std::size_t held_bytes = base64->size() * 3 / 4;
    if (held_bytes == 0)
        return tl::unexpected(std::string("its data uri holds no base64"));
    std::string plain("data:application/octet-stream;base64,");
    if (!size_bytes)
        return plain.append(*base64);
    if (held_bytes < *size_bytes)
        return tl::unexpected(
            fmt::format("its data uri holds {} bytes, byteLength says {}", held_bytes, *size_bytes));
    return plain.append(base64->substr(0, digits_for(*size_bytes)));
}

}  // namespace drtv::map
