// The one table of settings. The command line, its help, error sentences, the database's columns and the key
// of results follow from it; the contract and README are tested against it.
#pragma once

#include "settings/bake_settings.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <tl/expected.hpp>

namespace drtv::settings {

inline constexpr std::array<std::string_view, 3> preset_names = {"draft", "console", "pc"};
inline constexpr std::string_view default_preset = "console";

using Member = std::
    variant<std::uint32_t BakeSettings::*, float BakeSettings::*, bool BakeSettings::*, float JobSettings::*>;

struct Setting {
    std::string_view name;  // in `--set`, in messages and in JSON
    Member member;
    double min;
    double max;
    std::string_view unit;  // "m", or empty
    std::array<double, preset_names.size()> defaults;
    std::string_view help;           // one line
    bool of_local_transfer = false;  // without local transfer it changes nothing
};

// In the order in which the key of results takes them in. Only ever appended to.
[[nodiscard]] std::span<const Setting> table();

// Whether it changes the bytes of a bake; else it belongs to the job.
[[nodiscard]] bool is_of_bake(const Setting& setting);

// Numbers without a fraction only.
[[nodiscard]] bool is_integer(const Setting& setting);

// nullptr where nothing has this name.
[[nodiscard]] const Setting* find_setting(std::string_view name);

// Those of a preset; a sentence for any other name.
[[nodiscard]] tl::expected<JobSettings, std::string> preset(std::string_view name);

// "rays must be a number from 16 to 65536, not '8'" where the value is out of range or no number.
[[nodiscard]] tl::expected<double, std::string> parse(const Setting& setting, std::string_view text);
[[nodiscard]] tl::expected<void, std::string> check(const Setting& setting, double value);

// REQUIRES: check(setting, value).
void assign(JobSettings& settings, const Setting& setting, double value);
[[nodiscard]] double value_of(const JobSettings& settings, const Setting& setting);

// The value as people write it: "2048", "0.001953125"; short_text with three digits at most below 1:
// "0.00195".
[[nodiscard]] std::string text_of(double value);
[[nodiscard]] std::string short_text(double value);

// A line or two for each setting: name, range, defaults of the presets, what it is. For the help of a
// command.
[[nodiscard]] std::string help_text();

// Calls `function` with the setting's value, as the type it has. `settings` is a JobSettings, const or not.
template <class Settings, class Function>
decltype(auto) visit_value(Settings& settings, const Setting& setting, Function&& function) {
    return std::visit(
        [&](auto member) -> decltype(auto) {
            if constexpr (requires { settings.*member; })
                return function(settings.*member);
            else
                return function(settings.bake.*member);
        },
        setting.member);
}

}  // namespace drtv::settings
