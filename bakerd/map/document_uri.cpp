#include "bakerd/map/document_uri.h"

#include <fmt/format.h>

#include <algorithm>

namespace drtv::map {
namespace {

// Not std::isalnum, which asks the locale.
bool is_base64(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '+' || c == '/';
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

}  // namespace

std::optional<std::string> path_problem(const std::string& path) {
    const bool absolute =
        path.starts_with("/") || path.starts_with("\\") || path.find(':') != std::string::npos;
    if (absolute)
        return fmt::format("the path '{}' is absolute, it must lie in the map's folder", path);
    if (path.empty() || path.find('\0') != std::string::npos || path.find('\\') != std::string::npos)
        return fmt::format("the path '{}' is not valid", path);
    for (std::size_t start = 0; start <= path.size();) {
        const std::size_t end = std::min(path.find('/', start), path.size());
        if (path.substr(start, end - start) == "..")
            return fmt::format("the path '{}' leaves the map's folder", path);
        start = end + 1;
    }
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
        const std::optional<int> high = hex_digit(uri[n + 1]), low = hex_digit(uri[n + 2]);
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

tl::expected<std::string, std::string> plain_data_uri(std::string_view uri,
                                                      std::optional<std::size_t> size_bytes) {
    constexpr std::string_view marker = ";base64,";
    const std::size_t comma = uri.find(',');
    const std::size_t found = uri.substr(0, comma == std::string_view::npos ? 0 : comma + 1).rfind(marker);
    if (found == std::string_view::npos)
        return tl::unexpected(std::string("its data uri is not base64"));
    std::string_view digits = uri.substr(found + marker.size());
    digits = digits.substr(
        0, static_cast<std::size_t>(std::ranges::find_if_not(digits, is_base64) - digits.begin()));
    const std::size_t held = digits.size() * 3 / 4;
    if (held == 0)
        return tl::unexpected(std::string("its data uri holds no base64"));
    if (size_bytes && held < *size_bytes)
        return tl::unexpected(
            fmt::format("its data uri holds {} bytes, byteLength says {}", held, *size_bytes));
    if (size_bytes)
        digits = digits.substr(0, (*size_bytes * 4 + 2) / 3);  // 3 bytes are 4 digits, 1 are 2, 2 are 3
    return "data:application/octet-stream;base64," + std::string(digits);
}

}  // namespace drtv::map
