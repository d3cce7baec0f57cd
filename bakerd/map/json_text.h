// JSON as people write it, read with a sentence where it is broken.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace drtv::map {

// "is broken at line 3, column 15": `at` counts bytes from 0.
[[nodiscard]] std::string broken_at(std::string_view json, std::size_t at);

// The sentence goes on after "its JSON".
template <class AnyJson>
[[nodiscard]] tl::expected<AnyJson, std::string> parse_json(std::string_view text) {
    try {
        return AnyJson::parse(text.begin(), text.end());
    } catch (const nlohmann::json::parse_error& error) {
        // Counted from 1; 0 for the end.
        return tl::unexpected(broken_at(text, error.byte == 0 ? text.size() : error.byte - 1));
    } catch (const nlohmann::json::exception&) {
        return tl::unexpected(std::string("has a number that is out of range"));
    }
}

}  // namespace drtv::map
