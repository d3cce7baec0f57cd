#include "bakerd/farm/worker_protocol.h"

#include <nlohmann/json.hpp>

#include <utility>

namespace drtv::farm {
namespace {

using Json = nlohmann::json;

std::string line(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// The library would cut a number to its type without a word.
template <class Integer>
Integer integer(const Json& json) {
    const bool fits = json.is_number_unsigned()
                          ? std::in_range<Integer>(json.get<std::uint64_t>())
                          : json.is_number_integer() && std::in_range<Integer>(json.get<std::int64_t>());
    if (!fits)
        throw Json::other_error::create(502, "not an integer in range", nullptr);
    return json.get<Integer>();
}

Json to_json(const map::SectorCoordinate& sector) {
    return Json::array({sector.i, sector.j});
}
map::SectorCoordinate sector_from(const Json& json) {
    return {integer<std::int32_t>(json.at(0)), integer<std::int32_t>(json.at(1))};
}

Json to_json(const bake::Settings& s) {
    return {{"rays", s.rays},
            {"bounces", s.bounces},
            {"reach", s.reach_m},
            {"min_distance", s.min_distance_m},
            {"error", s.error},
            {"lprt", s.local_transfer},
            {"lprt_bounces", s.local_bounces},
            {"lprt_rays", s.local_rays},
            {"tolerance", s.tolerance}};
}
bake::Settings settings_from(const Json& json) {
    bake::Settings s;
    s.rays = integer<std::uint32_t>(json.at("rays"));
    s.bounces = integer<std::uint32_t>(json.at("bounces"));
    s.reach_m = json.at("reach").get<float>();
    s.min_distance_m = json.at("min_distance").get<float>();
    s.tolerance = json.value("tolerance", 0.0f);  // before there was one, results were exact
    if (!json.contains("error"))
        return s;  // written before there were the others
    s.error = json.at("error").get<float>();
    s.local_transfer = json.at("lprt").get<bool>();
    s.local_bounces = integer<std::uint32_t>(json.at("lprt_bounces"));
    s.local_rays = integer<std::uint32_t>(json.at("lprt_rays"));
    return s;
}

map::Digest digest_from(const Json& json) {
    const auto digest = map::digest_from_hex(json.get<std::string>());
    if (!digest)
        throw Json::other_error::create(501, "malformed digest", nullptr);
    return *digest;
}

Json to_json(const ResultDigests& result) {
    return {to_hex(result.file), to_hex(result.footprint), to_hex(result.inventory)};
}
ResultDigests result_from(const Json& json) {
    return {digest_from(json.at(0)), digest_from(json.at(1)), digest_from(json.at(2))};
}

Json to_json(const AssessRequest& request) {
    Json sectors = Json::array();
    for (const AssessRequest::Sector& sector : request.sectors) {
        Json candidates = Json::array();
        for (const ResultDigests& candidate : sector.candidates)
            candidates.push_back(to_json(candidate));
        sectors.push_back({to_json(sector.sector), std::move(candidates)});
    }
    return {{"id", request.id},
            {"op", "assess"},
            {"map", to_hex(request.manifest)},
            {"settings", to_json(request.settings)},
            {"sectors", std::move(sectors)}};
}

AssessRequest assess_request_from(const Json& json) {
    AssessRequest request{integer<std::uint64_t>(json.at("id")),
                          digest_from(json.at("map")),
                          settings_from(json.at("settings")),
                          {}};
    for (const Json& sector : json.at("sectors")) {
        AssessRequest::Sector& asked = request.sectors.emplace_back();
        asked.sector = sector_from(sector.at(0));
        for (const Json& candidate : sector.at(1))
            asked.candidates.push_back(result_from(candidate));
    }
    return request;
}

Json to_json(const AssessAnswer& answer) {
    Json sectors = Json::array(), changes = Json::array();
    for (const AssessAnswer::Sector& sector : answer.sectors)
        sectors.push_back({static_cast<unsigned>(sector.verdict),
                           sector.candidate,
                           sector.bound,
                           sector.share,
                           sector.reason});
    for (const AssessAnswer::Change& change : answer.changes) {
        const map::Bounds& b = change.bounds;
        changes.push_back({change.what, b.low.x, b.low.y, b.low.z, b.high.x, b.high.y, b.high.z});
    }
    return {{"verdicts", std::move(sectors)}, {"changes", std::move(changes)}, {"warnings", answer.warnings}};
}

AssessAnswer assess_answer_from(const Json& json) {
    AssessAnswer answer;
    for (const Json& sector : json.at("verdicts")) {
        const auto verdict = integer<std::uint8_t>(sector.at(0));
        if (verdict > static_cast<std::uint8_t>(reuse::Verdict::rebake))
            throw Json::other_error::create(504, "unknown verdict", nullptr);
        answer.sectors.push_back({static_cast<reuse::Verdict>(verdict),
                                  integer<std::size_t>(sector.at(1)),
                                  sector.at(2).get<float>(),
                                  sector.at(3).get<float>(),
                                  sector.at(4).get<std::string>()});
    }
    for (const Json& change : json.at("changes")) {
        const auto number = [&](std::size_t n) { return change.at(n).get<float>(); };
        answer.changes.push_back({change.at(0).get<std::string>(),
                                  {{number(1), number(2), number(3)}, {number(4), number(5), number(6)}}});
    }
    answer.warnings = json.at("warnings").get<std::vector<std::string>>();
    return answer;
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
    if (const auto* inspect = std::get_if<InspectRequest>(&request))
        return line({{"id", inspect->id}, {"op", "inspect"}, {"map", to_hex(inspect->manifest)}});
    if (const auto* assess = std::get_if<AssessRequest>(&request))
        return line(to_json(*assess));
    const auto& bake = std::get<BakeRequest>(request);
    Json json = {{"id", bake.id},
                 {"op", "bake"},
                 {"map", to_hex(bake.manifest)},
                 {"sector", to_json(bake.sector)},
                 {"settings", to_json(bake.settings)}};
    if (bake.earlier)
        json["earlier"] = to_json(*bake.earlier);
    return line(json);
}

std::optional<WorkerRequest> decode_request(std::string_view text) {
    return guarded(text, [](const Json& json) -> WorkerRequest {
        const auto id = integer<std::uint64_t>(json.at("id"));
        const auto op = json.at("op").get<std::string>();
        if (op == "assess")
            return assess_request_from(json);
        if (op != "inspect" && op != "bake")
            throw Json::other_error::create(503, "unknown request", nullptr);
        if (op == "inspect")
            return InspectRequest{id, digest_from(json.at("map"))};
        BakeRequest bake{id,
                         digest_from(json.at("map")),
                         sector_from(json.at("sector")),
                         settings_from(json.at("settings")),
                         {}};
        if (json.contains("earlier"))
            bake.earlier = result_from(json.at("earlier"));
        return bake;
    });
}

std::string encode(const WorkerAnswer& answer) {
    Json json = {{"id", answer.id}};
    if (const auto* inspected = std::get_if<InspectAnswer>(&answer.what)) {
        Json sectors = Json::array();
        for (const map::SectorCoordinate& sector : inspected->sectors)
            sectors.push_back(to_json(sector));
        json.update({{"content", to_hex(inspected->content)},
                     {"inventory", to_hex(inspected->inventory)},
                     {"sectors", std::move(sectors)},
                     {"objects", inspected->object_count},
                     {"triangles", inspected->triangle_count},
                     {"warnings", inspected->warnings}});
    } else if (const auto* baked = std::get_if<BakeAnswer>(&answer.what)) {
        json.update({{"result", to_hex(baked->result)},
                     {"size", baked->size_bytes},
                     {"probes", baked->probes},
                     {"rays", baked->rays},
                     {"warnings", baked->warnings},
                     {"footprint", to_hex(baked->footprint)},
                     {"inventory", to_hex(baked->inventory)},
                     {"footprint_size", baked->footprint_bytes},
                     {"seconds", baked->seconds},
                     {"bound", baked->bound}});
    } else if (const auto* assessed = std::get_if<AssessAnswer>(&answer.what)) {
        json.update(to_json(*assessed));
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
            answer.what = BakeAnswer{digest_from(json.at("result")),
                                     integer<std::int64_t>(json.at("size")),
                                     integer<std::int64_t>(json.at("probes")),
                                     integer<std::int64_t>(json.at("rays")),
                                     json.at("warnings").get<std::vector<std::string>>(),
                                     digest_from(json.at("footprint")),
                                     digest_from(json.at("inventory")),
                                     integer<std::int64_t>(json.at("footprint_size")),
                                     json.at("seconds").get<double>(),
                                     json.at("bound").get<float>()};
        } else if (json.contains("verdicts")) {
            answer.what = assess_answer_from(json);
        } else {
            InspectAnswer inspected;
            inspected.content = digest_from(json.at("content"));
            if (json.contains("inventory"))
                inspected.inventory =
                    digest_from(json.at("inventory"));  // else kept from before there were any
            for (const Json& sector : json.at("sectors"))
                inspected.sectors.push_back(sector_from(sector));
            inspected.object_count = integer<std::int64_t>(json.at("objects"));
            inspected.triangle_count = integer<std::int64_t>(json.at("triangles"));
            inspected.warnings = json.at("warnings").get<std::vector<std::string>>();
            answer.what = std::move(inspected);
        }
        return answer;
    });
}

std::string encode_settings(const bake::Settings& settings) {
    return line(to_json(settings));
}

std::optional<bake::Settings> decode_settings(std::string_view text) {
    return guarded(text, [](const Json& json) { return settings_from(json); });
}

}  // namespace drtv::farm
