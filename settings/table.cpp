#include "settings/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace drtv::settings {
namespace {

using Bake = BakeSettings;

constexpr std::array settings_table = {
    Setting{"rays", &Bake::rays, 16, 65536, "", {256, 2048, 4096}, "primary rays per probe"},
    Setting{"bounces", &Bake::bounces, 0, 8, "", {3, 3, 3}, "surface bounces"},
    Setting{"reach", &Bake::reach_m, 1, 8192, "m", {512, 512, 512}, "what is farther away is sky"},
    Setting{"min_distance", &Bake::min_distance_m, 1, 16, "m", {6, 6, 6}, "between automatic probes"},
    Setting{"error",
            &Bake::error,
            0,
            1,
            "",
            {0, 0, 0},
            "a probe stops once its standard error is this part of its relit irradiance (0.01: 1 %), not "
            "before 1,024 rays and never beyond `rays`; 0 always traces all"},
    Setting{"lprt",
            &Bake::local_transfer,
            0,
            1,
            "",
            {0, 0, 1},
            "1: local radiance transfer, from up to 128 sources per probe"},
    Setting{
        "lprt_bounces", &Bake::local_bounces, 1, 4, "", {2, 2, 2}, "surface bounces of local transfer", true},
    Setting{"lprt_rays",
            &Bake::local_rays,
            16,
            4096,
            "",
            {1024, 1024, 1024},
            "rays per source of local transfer",
            true},
    Setting{"tolerance",
            &JobSettings::tolerance,
            0,
            0.0625,
            "",
            {1 / 512.0, 1 / 512.0, 1 / 512.0},
            "largest error allowed where an earlier result is reused, as a part of a coefficient's range; 0 "
            "allows none. With lprt there is no such reuse"},
};

// `shown` is what was given instead.
tl::unexpected<std::string> out_of_range(const Setting& setting, std::string_view shown) {
    return tl::unexpected(fmt::format("{} must be a number from {} to {}, not {}",
                                      setting.name,
                                      text_of(setting.min),
                                      text_of(setting.max),
                                      shown));
}

bool is_in_range(const Setting& setting, double value) {
    return value >= setting.min && value <= setting.max &&
           (!is_integer(setting) || value == std::trunc(value));
}

template <class Number>
tl::expected<double, std::string> parse_as(const Setting& setting, std::string_view text) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc() && end == text.data() + text.size() &&
        is_in_range(setting, static_cast<double>(number)))
        return static_cast<double>(number) + 0.0;  // no negative zero: it is the same setting
    return out_of_range(setting, fmt::format("'{}'", text));
}

}  // namespace

std::span<const Setting> table() {
    return settings_table;
}

bool is_of_bake(const Setting& setting) {
    return !std::holds_alternative<float JobSettings::*>(setting.member);
}

bool is_integer(const Setting& setting) {
    return !std::holds_alternative<float BakeSettings::*>(setting.member) &&
           !std::holds_alternative<float JobSettings::*>(setting.member);
}

const Setting* find_setting(std::string_view name) {
    const auto found = std::ranges::find(settings_table, name, &Setting::name);
    return found == settings_table.end() ? nullptr : &*found;
}

tl::expected<JobSettings, std::string> preset(std::string_view name) {
    const auto found = std::ranges::find(preset_names, name);
    if (found == preset_names.end()) {
        return tl::unexpected(
            fmt::format("the preset '{}' is unknown: there are {}", name, fmt::join(preset_names, ", ")));
    }
    JobSettings settings;
    for (const Setting& setting : settings_table)
        assign(settings, setting, setting.defaults[static_cast<std::size_t>(found - preset_names.begin())]);
    return settings;
}

tl::expected<double, std::string> parse(const Setting& setting, std::string_view text) {
    return is_integer(setting) ? parse_as<std::uint32_t>(setting, text) : parse_as<float>(setting, text);
}

tl::expected<void, std::string> check(const Setting& setting, double value) {
    if (is_in_range(setting, value))
        return {};
    return out_of_range(setting, is_integer(setting) ? fmt::format("{}", value) : text_of(value));
}

void assign(JobSettings& settings, const Setting& setting, double value) {
    visit_value(settings, setting, [&]<class Value>(Value& to) { to = static_cast<Value>(value + 0.0); });
}

double value_of(const JobSettings& settings, const Setting& setting) {
    return visit_value(settings, setting, [](auto value) { return static_cast<double>(value); });
}

std::string text_of(double value) {
    return fmt::format("{}", static_cast<float>(value));
}

std::string short_text(double value) {
    return value < 1 ? fmt::format("{:.3g}", value) : text_of(value);
}

std::string help_text() {
    std::string text = fmt::format(
        "{:<12}  {:<13}  {:<7}  {:<7}  {:<7}  what\n", "--set", "range", "draft", "console", "pc");
    for (const Setting& setting : settings_table) {
        const std::string range = fmt::format("{} to {}{}{}",
                                              text_of(setting.min),
                                              text_of(setting.max),
                                              setting.unit.empty() ? "" : " ",
                                              setting.unit);
        text += fmt::format("{:<12}  {:<13}", setting.name, range);
        for (const double value : setting.defaults)
            text += fmt::format("  {:<7}", short_text(value));
        text += fmt::format("  {}\n", setting.help);
    }
    return text;
}

}  // namespace drtv::settings
