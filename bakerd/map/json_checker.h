// Typed looks at a JSON document: what an element must hold, and what it may refer to.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <tl/expected.hpp>

namespace drtv::map {

using Json = nlohmann::json;
using CheckResult = tl::expected<void, std::string>;  // else a sentence

template <class... Arguments>
[[nodiscard]] tl::unexpected<std::string> wrong(fmt::format_string<Arguments...> sentence,
                                                Arguments&&... arguments) {
    return tl::unexpected(fmt::format(sentence, std::forward<Arguments>(arguments)...));
}

enum class Type { number, index, count, string, boolean, object, index_array, number_array };

// What a member must be where it is there. Made by the functions below.
struct Property {
    const char* name;
    Type type;
    std::size_t length = 0;           // arrays: exact number of elements, 0: any
    const char* refers_to = nullptr;  // index or index_array: the top-level array it points into
    bool required = false;
};

constexpr Property number_at(const char* name) {
    return {name, Type::number};
}

// At most 2^31 - 1.
constexpr Property index_at(const char* name) {
    return {name, Type::index};
}

// At most 2^40.
constexpr Property size_at(const char* name) {
    return {name, Type::count};
}

constexpr Property string_at(const char* name) {
    return {name, Type::string};
}

constexpr Property boolean_at(const char* name) {
    return {name, Type::boolean};
}

constexpr Property object_at(const char* name) {
    return {name, Type::object};
}

constexpr Property numbers_at(const char* name, std::size_t length) {
    return {name, Type::number_array, length};
}

// An index into the top-level array.
constexpr Property reference_at(const char* name, const char* array) {
    return {name, Type::index, 0, array};
}

// An array of such indices.
constexpr Property references_at(const char* name, const char* array) {
    return {name, Type::index_array, 0, array};
}

constexpr Property required(Property property) {
    property.required = true;
    return property;
}

// A short form of the value for a message.
[[nodiscard]] std::string shown(const Json& value);

// Checks parts of a document, and writes the numbers that it has checked as tinygltf wants them: it skips an
// index written as 3.0, and cuts large whole numbers in extensions to 32 bits.
class Checker {
  public:
    explicit Checker(Json& root) : root_(root) {}

    [[nodiscard]] CheckResult properties(Json& object,
                                         const std::string& where,
                                         std::initializer_list<Property> properties) const;

    // Each member of `attributes` names an accessor.
    [[nodiscard]] CheckResult accessors_of(Json& attributes, const std::string& where) const;

    // Runs `check(element, "node 3")` over a top-level array.
    template <class Check>
    [[nodiscard]] CheckResult each(const char* array, const char* singular, Check check) const {
        const auto found = root_.find(array);
        if (found == root_.end())
            return {};
        if (!found->is_array())
            return wrong("{} must be an array", array);
        for (std::size_t n = 0; n < found->size(); ++n) {
            const std::string where = fmt::format("{} {}", singular, n);
            if (CheckResult checked = check((*found)[n], where); !checked)
                return checked;
        }
        return {};
    }

    // REQUIRES: `index` was checked to refer to the array.
    [[nodiscard]] const Json& element(const char* array, const Json& index) const {
        return root_[array][index.get<std::size_t>()];
    }

  private:
    [[nodiscard]] CheckResult property(const Json& value,
                                       const std::string& where,
                                       const Property& wanted) const;
    [[nodiscard]] std::size_t size_of(const char* array) const;
    [[nodiscard]] CheckResult references(const Json& value,
                                         const std::string& where,
                                         const char* array) const;

    Json& root_;
};

}  // namespace drtv::map
