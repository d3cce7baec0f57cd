#include "bakerd/farm/worker_protocol.h"

#include <nlohmann/json.hpp>

#include <utility>

namespace drtv::farm {
namespace {

using Json = nlohmann::json;

std::string line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

// The library would cut a number to its type without a word.
template <class Integer>
Integer integer(const Json& json) {
    const bool fits = json.is_number_unsigned() ? std::in_range<Integer>(json.get<std::uint64_t>()) : json.is_number_integer() && std::in_range<Integer>(json.get<std::int64_t>());
    if (!fits) throw Json::other_error::create(502, "not an integer in range", nullptr);
    return json.get<Integer>();
}

Json to_json(const map::SectorCoordinate& sector) { return Json::array({sector.i, sector.j}); }
map::SectorCoordinate sector_from(const Json& json) { return {integer<std::int32_t>(json.at(0)), integer<std::int32_t>(json.at(1))}; }

Json to_json(const bake::Settings& s) {
    return {{"rays", s.rays}, {"bounces", s.bounces}, {"reach", s.reach_m}, {"min_distance", s.min_distance_m}, {"error", s.error}, {"lprt", s.local_transfer}, {"lprt_bounces", s.local_bounces}, {"lprt_rays", s.local_rays}};
}
bake::Settings settings_from(const Json& json) {
    bake::Settings s;
    s.rays = integer<std::uint32_t>(json.at("rays"));
    s.bounces = integer<std::uint32_t>(json.at("bounces"));
    s.reach_m = json.at("reach").get<float>();
    s.min_distance_m = json.at("min_distance").get<float>();
    if (!json.contains("error")) return s;  // written before there were the others
    s.error = json.at("error").get<float>();
    s.local_transfer = json.at("lprt").get<bool>();
    s.local_bounces = integer<std::uint32_t>(json.at("lprt_bounces"));
    s.local_rays = integer<std::uint32_t>(json.at("lprt_rays"));
    return s;
}

map::Digest digest_from(const Json& json) {
    const auto digest = map::digest_from_hex(json.get<std::string>());
    if (!digest) throw Json::other_error::create(501, "malformed digest", nullptr);
    return *digest;
}

// A line from the other side is trusted no further than this: anything odd is nothing.
template <class Decode>
auto guarded(std::string_view text, Decode decode) -> std::optional<decltype(decode(Json()))> {
    try {
        const Json json = Json::parse(text);
        return decode(json);
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

}  // namespace

std::string encode(const WorkerRequest& request) {
    if (const auto* inspect = std::get_if<InspectRequest>(&request)) return line({{"id", inspect->id}, {"op", "inspect"}, {"map", to_hex(inspect->manifest)}});
    const auto& bake = std::get<BakeRequest>(request);
    return line({{"id", bake.id}, {"op", "bake"}, {"map", to_hex(bake.manifest)}, {"sector", to_json(bake.sector)}, {"settings", to_json(bake.settings)}});
}

std::optional<WorkerRequest> decode_request(std::string_view text) {
    return guarded(text, [](const Json& json) -> WorkerRequest {
        const auto id = integer<std::uint64_t>(json.at("id"));
        const auto op = json.at("op").get<std::string>();
        if (op != "inspect" && op != "bake") throw Json::other_error::create(503, "unknown request", nullptr);
        if (op == "inspect") return InspectRequest{id, digest_from(json.at("map"))};
        return BakeRequest{id, digest_from(json.at("map")), sector_from(json.at("sector")), settings_from(json.at("settings"))};
    });
}

std::string encode(const WorkerAnswer& answer) {
    Json json = {{"id", answer.id}};
    if (const auto* inspected = std::get_if<InspectAnswer>(&answer.what)) {
        Json sectors = Json::array();
        for (const map::SectorCoordinate& sector : inspected->sectors) sectors.push_back(to_json(sector));
        json.update({{"content", to_hex(inspected->content)}, {"sectors", std::move(sectors)}, {"objects", inspected->object_count}, {"triangles", inspected->triangle_count}, {"warnings", inspected->warnings}});
    } else if (const auto* baked = std::get_if<BakeAnswer>(&answer.what)) {
        json.update({{"result", to_hex(baked->result)}, {"size", baked->size_bytes}, {"probes", baked->probes}, {"rays", baked->rays}, {"warnings", baked->warnings}});
    } else {
        const auto& failure = std::get<FailureAnswer>(answer.what);
        json.update({{"error", failure.sentence}, {"retry", failure.may_retry}});
    }
    return line(json);
}

std::optional<WorkerAnswer> decode_answer(std::string_view text) {
    return guarded(text, [](const Json& json) -> WorkerAnswer {
        WorkerAnswer answer;
        answer.id = integer<std::uint64_t>(json.at("id"));
        if (json.contains("error")) {
            answer.what = FailureAnswer{json.at("error").get<std::string>(), json.at("retry").get<bool>()};
        } else if (json.contains("result")) {
            answer.what = BakeAnswer{digest_from(json.at("result")), integer<std::int64_t>(json.at("size")), integer<std::int64_t>(json.at("probes")), integer<std::int64_t>(json.at("rays")), json.at("warnings").get<std::vector<std::string>>()};
        } else {
            InspectAnswer inspected;
            inspected.content = digest_from(json.at("content"));
            for (const Json& sector : json.at("sectors")) inspected.sectors.push_back(sector_from(sector));
            inspected.object_count = integer<std::int64_t>(json.at("objects"));
            inspected.triangle_count = integer<std::int64_t>(json.at("triangles"));
            inspected.warnings = json.at("warnings").get<std::vector<std::string>>();
            answer.what = std::move(inspected);
        }
        return answer;
    });
}

std::string encode_settings(const bake::Settings& settings) { return line(to_json(settings)); }

std::optional<bake::Settings> decode_settings(std::string_view text) {
    return guarded(text, [](const Json& json) { return settings_from(json); });
}

}  // namespace drtv::farm
