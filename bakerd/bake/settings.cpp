#include "bakerd/bake/settings.h"

#include "bakerd/trace/device.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace drtv::bake {
namespace {

template <class Number>
tl::expected<Number, std::string> parse(std::string_view key,
                                        std::string_view value,
                                        Number least,
                                        Number most) {
    Number number{};
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || end != value.data() + value.size() || !(number >= least && number <= most)) {
        return tl::unexpected(
            fmt::format("{} must be a number from {} to {}, not '{}'", key, least, most, value));
    }
    return number + Number{0};  // no negative zero: it is the same setting
}

template <class Number>
tl::expected<void, std::string> assign(Number& field, const tl::expected<Number, std::string>& parsed) {
    if (!parsed)
        return tl::unexpected(parsed.error());
    field = *parsed;
    return {};
}

}  // namespace

tl::expected<Settings, std::string> preset(std::string_view name) {
    if (name == "console")
        return Settings{};
    if (name == "pc") {
        Settings pc;
        pc.rays = 4096;
        pc.local_transfer = true;
        return pc;
    }
    if (name == "draft") {
        Settings draft;
        draft.rays = 256;
        return draft;
    }
    return tl::unexpected(fmt::format("the preset '{}' is unknown: there are draft, console and pc", name));
}

tl::expected<void, std::string> set(Settings& settings, std::string_view key, std::string_view value) {
    if (key == "rays")
        return assign(settings.rays, parse<std::uint32_t>(key, value, 16, 65536));
    if (key == "bounces")
        return assign(settings.bounces, parse<std::uint32_t>(key, value, 0, 8));
    if (key == "reach")
        return assign(settings.reach_m, parse<float>(key, value, 1, 8192));
    if (key == "min_distance")
        return assign(settings.min_distance_m, parse<float>(key, value, 1, 16));
    if (key == "error")
        return assign(settings.error, parse<float>(key, value, 0, 1));
    if (key == "lprt_bounces")
        return assign(settings.local_bounces, parse<std::uint32_t>(key, value, 1, 4));
    if (key == "lprt_rays")
        return assign(settings.local_rays, parse<std::uint32_t>(key, value, 16, 4096));
    if (key == "tolerance")
        return assign(settings.tolerance, parse<float>(key, value, 0, 0.0625f));
    if (key == "lprt") {
        const auto parsed = parse<std::uint32_t>(key, value, 0, 1);
        if (!parsed)
            return tl::unexpected(parsed.error());
        settings.local_transfer = *parsed == 1;
        return {};
    }
    return tl::unexpected(
        fmt::format("the setting '{}' is unknown: there are rays, bounces, reach, min_distance, error, lprt, "
                    "lprt_bounces, lprt_rays and tolerance",
                    key));
}

map::Digest settings_key(const Settings& settings) {
    constexpr std::uint32_t format_version = 1;
    map::Hasher hasher;
    hasher.add_sized(std::string_view("drtv settings"));
    hasher.add(format_version);
    hasher.add(baker_version);
    hasher.add_sized(trace::isa_class());
    hasher.add(settings.rays);
    hasher.add(settings.bounces);
    hasher.add(settings.reach_m);
    hasher.add(settings.min_distance_m);
    hasher.add(settings.error);
    hasher.add(settings.local_transfer);
    if (settings.local_transfer) {
        hasher.add(settings.local_bounces);
        hasher.add(settings.local_rays);
    }
    return hasher.finish();
}

}  // namespace drtv::bake
