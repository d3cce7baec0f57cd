#include "bakerd/map/json_checker.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace drtv::map {
namespace {

constexpr double max_index = INT32_MAX;
constexpr double max_count = 1099511627776;  // 2^40

// As the specification allows, 3.0 is a whole number too.
bool is_whole(const Json& v, double max) {
    if (!v.is_number())
        return false;
    const auto number = v.get<double>();
    return number >= 0 && number <= max && number == std::floor(number);
}

bool has_type(const Json& v, Type type);

bool is_array_of(const Json& v, Type type) {
    const auto fits = [&](const Json& element) { return has_type(element, type); };
    return v.is_array() && std::ranges::all_of(v, fits);
}

bool has_type(const Json& v, Type type) {
    switch (type) {
        case Type::number:
            return v.is_number();
        case Type::index:
            return is_whole(v, max_index);
        case Type::count:
            return is_whole(v, max_count);
        case Type::string:
            return v.is_string();
        case Type::boolean:
            return v.is_boolean();
        case Type::object:
            return v.is_object();
        case Type::index_array:
            return is_array_of(v, Type::index);
        case Type::number_array:
            return is_array_of(v, Type::number);
    }
    return false;
}

void write_plainly(Json& v, Type type) {
    if (type == Type::index || type == Type::count)
        v = static_cast<std::uint64_t>(v.get<double>());
    if (type == Type::number)
        v = v.get<double>();
    if (type == Type::index_array || type == Type::number_array) {
        for (Json& element : v)
            write_plainly(element, type == Type::index_array ? Type::index : Type::number);
    }
}

std::string_view name_of(Type type) {
    switch (type) {
        case Type::number:
            return "a number";
        case Type::index:
            return "an index";
        case Type::count:
            return "a size of at most 2^40";
        case Type::string:
            return "a string";
        case Type::boolean:
            return "true or false";
        case Type::object:
            return "an object";
        case Type::index_array:
            return "an array of indices";
        case Type::number_array:
            return "an array of numbers";
    }
    return "";
}

}  // namespace

std::string shown(const Json& value) {
    std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > 40)
        text = text.substr(0, 37) + "...";
    return text;
}

CheckResult Checker::properties(Json& object,
                                const std::string& where,
                                std::initializer_list<Property> properties) const {
    if (!object.is_object())
        return wrong("{} is not an object", where);
    for (const Property& wanted : properties) {
        const auto found = object.find(wanted.name);
        if (found == object.end()) {
            if (wanted.required)
                return wrong("{} has no {}", where, wanted.name);
            continue;
        }
        if (CheckResult checked = property(*found, where, wanted); !checked)
            return checked;
        write_plainly(*found, wanted.type);
    }
    return {};
}

CheckResult Checker::property(const Json& value, const std::string& where, const Property& wanted) const {
    if (!has_type(value, wanted.type))
        return wrong("{}: {} must be {}, it is {}", where, wanted.name, name_of(wanted.type), shown(value));
    if (wanted.length != 0 && value.size() != wanted.length) {
        return wrong(
            "{}: {} must have {} elements, it has {}", where, wanted.name, wanted.length, value.size());
    }
    if (wanted.refers_to == nullptr)
        return {};
    return references(value, fmt::format("{}: {}", where, wanted.name), wanted.refers_to);
}

CheckResult Checker::accessors_of(Json& attributes, const std::string& where) const {
    const std::size_t count = size_of("accessors");
    for (const auto& [name, accessor] : attributes.items()) {
        if (!has_type(accessor, Type::index) || accessor.get<double>() >= static_cast<double>(count)) {
            return wrong("{}: {} names accessor {}, the file has {}", where, name, shown(accessor), count);
        }
        write_plainly(accessor, Type::index);
    }
    return {};
}

std::size_t Checker::size_of(const char* array) const {
    const auto found = root_.find(array);
    return found != root_.end() && found->is_array() ? found->size() : 0;
}

CheckResult Checker::references(const Json& value, const std::string& where, const char* array) const {
    const std::size_t size = size_of(array);
    const auto check = [&](const Json& index) -> CheckResult {
        if (index.get<double>() < static_cast<double>(size))
            return {};
        return wrong("{} names {} {}, the file has {}", where, array, shown(index), size);
    };
    if (!value.is_array())
        return check(value);
    for (const Json& index : value) {
        if (CheckResult checked = check(index); !checked)
            return checked;
    }
    return {};
}

}  // namespace drtv::map
