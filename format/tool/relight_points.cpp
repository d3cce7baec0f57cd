#include "relight_points.h"

#include "cli/number_list.h"
#include "folder/whole_file.h"
#include "kit/files.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

namespace drtv::tool {
namespace {

using nlohmann::json;

std::optional<Float3> unit(const Double3& v) {
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 0) || !std::isfinite(length))
        return std::nullopt;
    const Double3 divided = {v[0] / length, v[1] / length, v[2] / length};
    return cli::float3_of(divided.data());
}

std::optional<Double3> triple(const json& object, const char* name) {
    const auto found = object.find(name);
    if (found == object.end() || !found->is_array() || found->size() != 3)
        return std::nullopt;
    Double3 numbers;
    for (std::size_t n = 0; n < 3; ++n) {
        if (!(*found)[n].is_number())
            return std::nullopt;
        numbers[n] = (*found)[n].get<double>();
    }
    return numbers;
}

cli::Result<RelightPoint> read_line(std::string_view line) {
    const auto wrong = [](std::string what) { return cli::fail(cli::exit_usage, std::move(what)); };
    const json object = json::parse(line, nullptr, false);
    if (object.is_discarded() || !object.is_object())
        return wrong(R"(it must be a JSON object such as {"at":[0,0,2],"normal":[0,0,1]})");
    for (const auto& member : object.items()) {
        if (member.key() != "at" && member.key() != "normal")
            return wrong("\"" + member.key() + "\" is unknown: there are at and normal");
    }
    const auto at = triple(object, "at");
    if (!at)
        return wrong("\"at\" must be three numbers");
    const auto normal = triple(object, "normal");
    if (!normal)
        return wrong("\"normal\" must be three numbers");
    const auto direction = unit(*normal);
    if (!direction)
        return wrong("\"normal\" has no length");
    return RelightPoint{*at, *direction};
}

}  // namespace

cli::Result<std::vector<RelightPoint>> read_point(const std::string& at, const std::string& normal) {
    const auto place = cli::number_list(at, 3);
    if (!place)
        return cli::fail(cli::exit_usage, "relight: --at takes x,y,z, not \"" + at + "\"");
    const auto numbers = cli::number_list(normal, 3);
    const auto direction = numbers ? unit({(*numbers)[0], (*numbers)[1], (*numbers)[2]}) : std::nullopt;
    if (!direction) {
        return cli::fail(cli::exit_usage,
                         "relight: --normal takes x,y,z of some length, not \"" + normal + "\"");
    }
    return std::vector{RelightPoint{{(*place)[0], (*place)[1], (*place)[2]}, *direction}};
}

cli::Result<std::vector<RelightPoint>> read_points(const std::string& path) {
    const auto file = path == "-" ? kit::read_standard_input() : folder::read_whole(path);
    if (!file)
        return tl::unexpected(file.error());
    std::vector<RelightPoint> points;
    std::string_view rest = *file;
    for (std::size_t number = 1; !rest.empty(); ++number) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (line.find_first_not_of(" \t\r") == std::string_view::npos)
            continue;
        const auto point = read_line(line);
        if (!point) {
            const std::string where = path == "-" ? "standard input" : path;
            return cli::fail(point.error().code,
                             where + ", line " + std::to_string(number) + ": " + point.error().sentence);
        }
        points.push_back(*point);
    }
    return points;
}

}  // namespace drtv::tool
