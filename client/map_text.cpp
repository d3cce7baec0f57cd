#include "client/map_text.h"

#include "client/number_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <vector>

namespace drtv::client {
namespace {

std::string digest_of(const std::string& resource) {
    return resource.substr(resource.find('/') + 1);
}

// "64 m", "2.05 km".
std::string length_text(double metres) {
    constexpr double kilometre = 1000;
    return metres < kilometre ? fmt::format("{:.3g} m", metres)
                              : fmt::format("{:.3g} km", metres / kilometre);
}

struct Counted {
    std::int64_t count;
    const char* one;
    const char* many;
};

// "12 lamps, 1 sun": what there is none of is left out.
std::string list_of(const std::vector<Counted>& things) {
    std::vector<std::string> parts;
    for (const Counted& thing : things) {
        if (thing.count > 0)
            parts.push_back(counted(thing.count, thing.one, thing.many));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

std::string map_json_line(const v1::Map& map) {
    const v1::MapSurvey& survey = map.survey();
    nlohmann::ordered_json json;
    json["kind"] = "map";
    json["map"] = digest_of(map.name());
    json["content"] = map.content_sha256();
    json["sectors"] = map.sector_count();
    json["low"] = {survey.x0(), survey.y0(), survey.z0()};
    json["high"] = {survey.x1(), survey.y1(), survey.z1()};
    json["static_objects"] = survey.static_objects();
    json["vegetation_objects"] = survey.vegetation_objects();
    json["ignored_nodes"] = survey.ignored_nodes();
    json["triangles"] = survey.triangles();
    json["lamps"] = survey.lamps();
    json["suns"] = survey.suns();
    json["glowing_objects"] = survey.glowing_objects();
    json["probes"] = survey.probes();
    json["interiors"] = survey.interiors();
    json["probe_free_volumes"] = survey.probe_free_volumes();
    json["spacing_volumes"] = survey.spacing_volumes();
    return json.dump();
}

std::string map_text(const v1::Map& map) {
    const v1::MapSurvey& survey = map.survey();
    std::string text = fmt::format("the map: {} x {}, {} high; {}",
                                   length_text(survey.x1() - survey.x0()),
                                   length_text(survey.y1() - survey.y0()),
                                   length_text(survey.z1() - survey.z0()),
                                   list_of({{map.sector_count(), "sector", "sectors"}}));
    const std::string objects = list_of({{survey.static_objects(), "static object", "static objects"},
                                         {survey.vegetation_objects(), "of vegetation", "of vegetation"},
                                         {survey.triangles(), "triangle", "triangles"},
                                         {survey.ignored_nodes(), "node ignored", "nodes ignored"}});
    const std::string lights = list_of({{survey.lamps(), "lamp", "lamps"},
                                        {survey.suns(), "sun", "suns"},
                                        {survey.glowing_objects(), "glowing object", "glowing objects"}});
    const std::string helpers =
        list_of({{survey.probes(), "hand-placed probe", "hand-placed probes"},
                 {survey.interiors(), "interior", "interiors"},
                 {survey.probe_free_volumes(), "volume without probes", "volumes without probes"},
                 {survey.spacing_volumes(), "volume with a spacing", "volumes with a spacing"}});
    const bool has_roles = survey.vegetation_objects() + survey.ignored_nodes() > 0 || !helpers.empty();
    std::string without = has_roles ? "" : "no bake_role: all of it is static";
    if (lights.empty())
        without += std::string(without.empty() ? "" : "; ") + "no lights of its own";
    for (const std::string& line : {objects, lights, helpers, without}) {
        if (!line.empty())
            text += "\n  " + line;
    }
    return text;
}

}  // namespace drtv::client
