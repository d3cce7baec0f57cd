#include "option_checks.h"

#include <algorithm>
#include <cmath>

namespace drtv::cli {

std::string joined(const std::vector<std::string>& words) {
    return CLI::detail::join(words, ", ");
}

CLI::Validator one_of(const std::vector<std::string>& words) {
    const auto check = [words](const std::string& word) {
        const bool known = std::ranges::find(words, word) != words.end();
        return known ? std::string() : "takes one of " + joined(words) + ", not \"" + word + "\"";
    };
    return {check, ""};
}

CLI::Validator whole_number(std::size_t min, std::size_t max) {
    const auto check = [=](const std::string& text) {
        std::size_t number = 0;
        if (CLI::detail::lexical_cast(text, number) && number >= min && number <= max)
            return std::string();
        return "takes a number from " + std::to_string(min) + " to " + std::to_string(max) + ", not \"" +
               text + "\"";
    };
    return {check, ""};
}

CLI::Validator number_between(double min, double max) {
    const auto check = [=](const std::string& text) {
        double number = 0;
        if (CLI::detail::lexical_cast(text, number) && number >= min && number <= max)
            return std::string();
        return "takes a number from " + CLI::detail::to_string(min) + " to " + CLI::detail::to_string(max) +
               ", not \"" + text + "\"";
    };
    return {check, ""};
}

CLI::Validator number_below(double max) {
    const auto check = [=](const std::string& text) {
        double number = 0;
        if (CLI::detail::lexical_cast(text, number) && number > 0 && number < max)
            return std::string();
        return "takes a number between 0 and " + CLI::detail::to_string(max) + ", not \"" + text + "\"";
    };
    return {check, ""};
}

CLI::Validator finite_number() {
    const auto check = [](const std::string& text) {
        double number = 0;
        if (CLI::detail::lexical_cast(text, number) && std::isfinite(number))
            return std::string();
        return "takes a number, not \"" + text + "\"";
    };
    return {check, ""};
}

}  // namespace drtv::cli
