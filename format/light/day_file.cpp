#include <drtv/day_file.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <deque>
#include <initializer_list>
#include <stdexcept>
#include <utility>

namespace drtv {

using nlohmann::json;

struct DayFile::Storage {
    std::vector<SunKey> sun_keys;
    std::vector<ColourKey> sun, zenith, horizon, sun_side;
    std::deque<std::string> names;  // whose texts stay where they are
    std::deque<std::vector<ColourKey>> group_keys;
    std::vector<GroupKeys> groups;
};

namespace {

// What the file does wrong. Thrown and caught in this file alone.
struct Wrong : std::runtime_error {
    using std::runtime_error::runtime_error;
};

[[noreturn]] void refuse(const std::string& where, const json& value, const std::string& what) {
    std::string shown = value.dump(-1, ' ', false, json::error_handler_t::replace);
    constexpr std::size_t max_shown = 60;
    if (shown.size() > max_shown)
        shown = shown.substr(0, max_shown) + "...";
    throw Wrong(where + " is " + shown + ": " + what);
}

void expect_members(const json& object,
                    const std::string& where,
                    std::initializer_list<std::string_view> known) {
    if (!object.is_object())
        refuse(where, object, "it must be an object");
    for (const auto& member : object.items()) {
        if (std::find(known.begin(), known.end(), member.key()) == known.end()) {
            std::string names;
            for (const std::string_view name : known)
                names += (names.empty() ? "" : ", ") + std::string(name);
            throw Wrong("\"" + member.key() + "\" in " + where + " is unknown: there are " + names);
        }
    }
}

const json& member(const json& object, const std::string& where, const std::string& name) {
    const auto found = object.find(name);
    if (found == object.end())
        throw Wrong(where + " has no \"" + name + "\"");
    return *found;
}

float number(const json& value, const std::string& where, double min, double max) {
    if (!value.is_number() || !(value.get<double>() >= min && value.get<double>() <= max)) {
        const auto text = [](double bound) {
            std::string digits = std::to_string(bound);
            return digits.substr(0, digits.find('.'));
        };
        refuse(where, value, "it must be a number from " + text(min) + " to " + text(max));
    }
    return value.get<float>();
}

float time_of(const json& key, const std::string& where) {
    const json& time = member(key, where, "time");
    double hours = 0;
    if (!time.is_string() || !parse_time(time.get<std::string>(), hours))
        refuse(where + ".time", time, "it must be a time of day such as \"06:00\"");
    return static_cast<float>(hours);
}

Float3 colour_of(const json& key, const std::string& where) {
    const json& colour = member(key, where, "colour");
    constexpr double most = 1e6;
    if (!colour.is_array() || colour.size() != channel_count)
        refuse(where + ".colour", colour, "it must be three numbers, [r, g, b]");
    Float3 channels;
    for (std::size_t c = 0; c < channel_count; ++c)
        channels[c] = number(colour[c], where + ".colour[" + std::to_string(c) + "]", 0, most);
    return channels;
}

// Keys of an array, each read by `read(key, where)`; their times must rise.
template <class Key, class Read>
std::vector<Key> keys_of(const json& array, const std::string& where, const Read& read) {
    if (!array.is_array())
        refuse(where, array, "it must be an array of keys");
    std::vector<Key> keys;
    for (std::size_t n = 0; n < array.size(); ++n) {
        const std::string place = where + "[" + std::to_string(n) + "]";
        keys.push_back(read(array[n], place));
        if (n > 0 && !(keys[n].hour > keys[n - 1].hour))
            refuse(place + ".time", array[n]["time"], "times must rise from key to key");
    }
    return keys;
}

std::vector<ColourKey> colour_keys(const json& array, const std::string& where) {
    return keys_of<ColourKey>(array, where, [](const json& key, const std::string& place) {
        expect_members(key, place, {"time", "colour"});
        return ColourKey{time_of(key, place), colour_of(key, place)};
    });
}

constexpr double max_latitude = 90;
constexpr double max_declination = 90;
constexpr double whole_turn = 360;

void read_sun_path(const json& object, SunPath& path, std::vector<SunKey>& keys) {
    const std::string where = "sun_path";
    expect_members(object, where, {"latitude", "declination", "north", "keys"});
    if (const auto north = object.find("north"); north != object.end())
        path.north_deg = number(*north, where + ".north", -whole_turn, whole_turn);
    const auto found = object.find("keys");
    if (found == object.end()) {
        path.latitude_deg =
            number(member(object, where, "latitude"), where + ".latitude", -max_latitude, max_latitude);
        path.declination_deg = number(
            member(object, where, "declination"), where + ".declination", -max_declination, max_declination);
        return;
    }
    if (object.contains("latitude") || object.contains("declination"))
        throw Wrong("sun_path has \"keys\" and also \"latitude\" or \"declination\": take one way");
    keys = keys_of<SunKey>(*found, where + ".keys", [](const json& key, const std::string& place) {
        expect_members(key, place, {"time", "azimuth", "elevation"});
        return SunKey{
            time_of(key, place),
            number(member(key, place, "azimuth"), place + ".azimuth", -whole_turn, whole_turn),
            number(member(key, place, "elevation"), place + ".elevation", -max_latitude, max_latitude)};
    });
    if (keys.empty())
        refuse(where + ".keys", *found, "it must have a key");
    path.keys = keys;
}

void read_groups(const json& object, DayFile::Storage& storage) {
    if (!object.is_object())
        refuse("groups", object, "it must be an object: keys by light group");
    for (const auto& group : object.items()) {
        storage.names.push_back(group.key());
        storage.group_keys.push_back(colour_keys(group.value(), "groups.\"" + group.key() + "\""));
        storage.groups.push_back({storage.names.back(), storage.group_keys.back()});
    }
}

void read_day(const json& root, DayFile::Storage& storage, Day& day) {
    if (!root.is_object())
        refuse("the light", root, "it must be an object");
    expect_members(
        root, "the light", {"$schema", "sun_path", "sun", "zenith", "horizon", "sun_side", "groups"});
    if (const auto path = root.find("sun_path"); path != root.end())
        read_sun_path(*path, day.sun_path, storage.sun_keys);
    const auto read_colours =
        [&](const char* name, std::vector<ColourKey>& keys, std::span<const ColourKey>& span) {
            keys = colour_keys(member(root, "the light", name), name);
            span = keys;
        };
    read_colours("sun", storage.sun, day.sun);
    read_colours("zenith", storage.zenith, day.zenith);
    read_colours("horizon", storage.horizon, day.horizon);
    if (root.contains("sun_side"))
        read_colours("sun_side", storage.sun_side, day.sun_side);
    if (const auto groups = root.find("groups"); groups != root.end())
        read_groups(*groups, storage);
    day.groups = storage.groups;
}

}  // namespace

DayFile::DayFile() : day_(std::make_shared<const Day>(default_day())) {}

tl::expected<DayFile, std::string> DayFile::read(std::string_view text) {
    try {
        const auto storage = std::make_shared<Storage>();
        const auto day = std::make_shared<Day>();
        read_day(json::parse(text), *storage, *day);
        DayFile file;
        file.storage_ = storage;
        file.day_ = day;
        return file;
    } catch (const Wrong& wrong) {
        return tl::unexpected(std::string(wrong.what()));
    } catch (const json::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
        const std::string what = error.what();
        const std::size_t end = what.find("] ");
        return tl::unexpected("it is no JSON: " + (end == std::string::npos ? what : what.substr(end + 2)));
    }
}

bool parse_time(std::string_view text, double& hours) {
    double sum = 0;
    double unit = 1;
    int parts = 0;
    while (true) {
        constexpr int most = 60;
        int value = -1;
        const std::size_t end = std::min(text.find(':'), text.size());
        const auto result = std::from_chars(text.data(), text.data() + end, value);
        const bool whole = end > 0 && end <= 2 && result.ec == std::errc() && result.ptr == text.data() + end;
        if (!whole || value < 0 || value >= most)
            return false;
        sum += value * unit;
        unit /= most;
        ++parts;
        if (end == text.size())
            break;
        text.remove_prefix(end + 1);
    }
    constexpr double day_hours = 24;
    if (parts < 2 || parts > 3 || sum > day_hours)
        return false;
    hours = sum;
    return true;
}

}  // namespace drtv
