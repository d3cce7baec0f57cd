// The arguments of one command, taken apart. Whatever is wrong is told in a sentence.
#pragma once

#include "commands.h"

#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::tool {

// "a,b" as its parts.
[[nodiscard]] std::vector<std::string> split_list(const std::string& list);

struct Option {
    std::string_view name;  // "--out"
    bool takes_value = false;
};

class ParsedArguments {
  public:
    // Nothing, and a complaint, for an option that is not among `options`, or lacks its value.
    [[nodiscard]] static std::optional<ParsedArguments> parse(std::string_view command,
                                                              Arguments arguments,
                                                              std::initializer_list<Option> options);

    [[nodiscard]] bool has(std::string_view option) const { return values_.contains(option); }
    // The last value, or "".
    [[nodiscard]] std::string value(std::string_view option) const;
    // All values, in their order: of an option that may stand more than once.
    [[nodiscard]] std::vector<std::string> all(std::string_view option) const;
    // The value as a whole number from `least` to `most`, or as a number above 0 and below `most`;
    // `otherwise` where the option is not given. Nothing, and a complaint, for anything else.
    [[nodiscard]] std::optional<std::size_t> count(std::string_view option,
                                                   std::size_t least,
                                                   std::size_t most,
                                                   std::size_t otherwise) const;
    [[nodiscard]] std::optional<double> positive(std::string_view option,
                                                 double most,
                                                 double otherwise) const;

    std::vector<std::string> positional;

  private:
    std::string command_;
    std::map<std::string, std::vector<std::string>, std::less<>> values_;
};

}  // namespace drtv::tool
