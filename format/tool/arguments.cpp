#include "arguments.h"

#include <algorithm>
#include <charconv>

namespace drtv::tool {
namespace {

template <class Number>
bool parse_whole(const std::string& text, Number& number) {
    const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
    return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

std::string plain(double number) {
    std::string text = std::to_string(number);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.'))
        text.pop_back();
    return text;
}

}  // namespace

std::vector<std::string> split_list(const std::string& list) {
    std::vector<std::string> parts;
    for (std::size_t start = 0; start <= list.size();) {
        const std::size_t end = std::min(list.find(',', start), list.size());
        parts.push_back(list.substr(start, end - start));
        start = end + 1;
    }
    return parts;
}

std::optional<ParsedArguments> ParsedArguments::parse(std::string_view command,
                                                      Arguments arguments,
                                                      std::initializer_list<Option> options) {
    ParsedArguments parsed;
    parsed.command_ = command;
    for (std::size_t n = 0; n < arguments.size(); ++n) {
        const std::string& argument = arguments[n];
        if (!argument.starts_with("-") || argument == "-") {
            parsed.positional.push_back(argument);
            continue;
        }
        const auto* option = std::ranges::find(options, argument, &Option::name);
        if (option == options.end()) {
            complain(parsed.command_ + ": unknown option \"" + argument + "\"");
            return std::nullopt;
        }
        if (option->takes_value && n + 1 == arguments.size()) {
            complain(parsed.command_ + ": " + argument + " needs a value");
            return std::nullopt;
        }
        parsed.values_[argument].push_back(option->takes_value ? arguments[++n] : "");
    }
    return parsed;
}

std::string ParsedArguments::value(std::string_view option) const {
    const auto found = values_.find(option);
    return found == values_.end() ? "" : found->second.back();
}

std::vector<std::string> ParsedArguments::all(std::string_view option) const {
    const auto found = values_.find(option);
    return found == values_.end() ? std::vector<std::string>() : found->second;
}

std::optional<std::size_t> ParsedArguments::count(std::string_view option,
                                                  std::size_t least,
                                                  std::size_t most,
                                                  std::size_t otherwise) const {
    if (!has(option))
        return otherwise;
    std::size_t number = 0;
    if (parse_whole(value(option), number) && number >= least && number <= most)
        return number;
    complain(command_ + ": " + std::string(option) + " takes a number from " + std::to_string(least) +
             " to " + std::to_string(most) + ", not \"" + value(option) + "\"");
    return std::nullopt;
}

std::optional<double> ParsedArguments::positive(std::string_view option,
                                                double most,
                                                double otherwise) const {
    if (!has(option))
        return otherwise;
    double number = 0;
    if (parse_whole(value(option), number) && number > 0 && number < most)
        return number;
    complain(command_ + ": " + std::string(option) + " takes a number between 0 and " + plain(most) +
             ", not \"" + value(option) + "\"");
    return std::nullopt;
}

}  // namespace drtv::tool
