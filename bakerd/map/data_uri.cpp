#include "bakerd/map/data_uri.h"

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
