#include "map_files/reference.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>

namespace drtv::map_files {
namespace {

using Segments = std::vector<std::string_view>;

// Not std::isalpha and its kin, which ask the locale.
bool is_letter(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

char in_lower_case(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::optional<int> hex_digit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    const char lower = in_lower_case(c);
    if (lower >= 'a' && lower <= 'f')
        return lower - 'a' + 10;
    return std::nullopt;
}

// A % without two hexadecimal digits behind it stands for itself.
std::string decoded(std::string_view uri) {
    std::string text;
    for (std::size_t n = 0; n < uri.size(); ++n) {
        const bool has_room = uri[n] == '%' && n + 2 < uri.size();
        const auto high = has_room ? hex_digit(uri[n + 1]) : std::nullopt;
        const auto low = has_room ? hex_digit(uri[n + 2]) : std::nullopt;
        if (!high || !low) {
            text += uri[n];
            continue;
        }
        text += static_cast<char>(*high * 16 + *low);
        n += 2;
    }
    return text;
}

// JSON and the contract hold UTF-8 alone.
bool is_utf8(std::string_view text) {
    using nlohmann::json;
    const std::string valid_part = json(text).dump(-1, ' ', false, json::error_handler_t::ignore);
    return json::parse(valid_part) == text;
}

// "C:" or "https:" (RFC 3986, 3.1). A colon behind the first slash belongs to a name.
bool has_drive_or_scheme(std::string_view path) {
    const std::size_t end = path.find_first_of(":/");
    if (end == std::string_view::npos || path[end] != ':' || end == 0 || !is_letter(path[0]))
        return false;
    return std::ranges::all_of(path.substr(1, end - 1), [](char c) {
        return is_letter(c) || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
    });
}

std::string absolute(std::string_view path) {
    return fmt::format("the path '{}' is absolute, it must lie in the map's folder", path);
}

tl::expected<void, std::string> check_characters(std::string_view path) {
    if (path.empty())
        return tl::unexpected(std::string("the path is empty"));
    if (!is_utf8(path))
        return tl::unexpected(std::string("the path is not UTF-8"));
    if (path.starts_with('/') || path.starts_with('\\'))
        return tl::unexpected(absolute(path));
    if (path.find('\0') != std::string_view::npos)
        return tl::unexpected(std::string("the path is not valid: it has a null character"));
    if (path.find('\\') != std::string_view::npos)
        return tl::unexpected(
            fmt::format("the path '{}' is not valid: names are separated by '/', not by '\\'", path));
    return {};
}

// Appends the names of a path, "." and ".." carried out. False where it leads above the first.
bool walk(std::string_view path, Segments& names) {
    for (std::size_t start = 0; start <= path.size();) {
        const std::size_t end = std::min(path.find('/', start), path.size());
        const std::string_view name = path.substr(start, end - start);
        start = end + 1;
        if (name.empty() || name == ".")
            continue;
        if (name != "..")
            names.push_back(name);
        else if (names.empty())
            return false;
        else
            names.pop_back();
    }
    return true;
}

bool names_a_folder(std::string_view path) {
    const std::string_view last = path.substr(path.rfind('/') + 1);  // npos + 1 is 0
    return last.empty() || last == "." || last == "..";
}

// The file that a name leads to from the document.
tl::expected<std::string, std::string> resolved(std::string_view document, std::string_view path) {
    if (auto checked = check_characters(path); !checked)
        return tl::unexpected(checked.error());
    Segments names;
    if (!walk(document, names))
        return tl::unexpected(fmt::format("the path '{}' leaves the map's folder", document));
    if (!names.empty())
        names.pop_back();
    if (!walk(path, names))
        return tl::unexpected(fmt::format("the path '{}' leaves the map's folder", path));
    if (names_a_folder(path))
        return tl::unexpected(fmt::format("the path '{}' names a folder", path));
    return fmt::format("{}", fmt::join(names, "/"));
}

}  // namespace

bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

tl::expected<std::vector<std::string>, std::string> files_named(std::string_view document,
                                                                std::string_view uri) {
    const std::string path = decoded(uri);
    if (has_drive_or_scheme(path))
        return tl::unexpected(absolute(path));
    auto likeliest = resolved(document, path);
    if (!likeliest)
        return tl::unexpected(likeliest.error());
    std::vector<std::string> files{std::move(*likeliest)};
    if (auto as_written = resolved(document, uri); as_written && *as_written != files[0])
        files.push_back(std::move(*as_written));
    return files;
}

tl::expected<void, std::string> check_path(std::string_view path) {
    const auto file = resolved("", path);
    if (!file)
        return tl::unexpected(file.error());
    if (*file != path)
        return tl::unexpected(fmt::format("the path '{}' is not in its shortest form, '{}'", path, *file));
    return {};
}

std::string roles_path(std::string_view document) {
    return fmt::format("{}roles.json", document.substr(0, document.rfind('/') + 1));  // npos + 1 is 0
}

bool is_document_name(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos)
        return false;
    std::string ending(name.substr(dot));
    std::ranges::transform(ending, ending.begin(), in_lower_case);
    return ending == ".gltf" || ending == ".glb";
}

}  // namespace drtv::map_files
