// Long because it holds one list of fields per message, and the codec that all of them share.
#include "bakerd/worker/protocol.h"

#include "settings/table.h"

#include <nlohmann/json.hpp>

#include <concepts>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace drtv::worker {
namespace {

using Json = nlohmann::json;

// Each struct lists its fields once, for both directions: fields() hands each with its key to `codec`.
template <class Self, class Struct>
concept Is = std::same_as<std::remove_const_t<Self>, Struct>;

void fields(auto& codec, Is<settings::JobSettings> auto& settings) {
    for (const settings::Setting& setting : settings::table())
        settings::visit_value(settings, setting, [&](auto& value) { codec(setting.name, value); });
}

void fields(auto& codec, Is<map::SectorCoordinate> auto& sector) {
    codec("i", sector.i);
    codec("j", sector.j);
}

void fields(auto& codec, Is<ResultBlobs> auto& blobs) {
    codec("file", blobs.file);
    codec("footprint", blobs.footprint);
    codec("inventory", blobs.inventory);
}

void fields(auto& codec, Is<InspectRequest> auto& request) {
    codec("manifest", request.manifest);
}

void fields(auto& codec, Is<BakeRequest> auto& request) {
    codec("manifest", request.manifest);
    codec("sector", request.sector);
    codec("settings", request.settings);
    codec("earlier", request.earlier);
}

void fields(auto& codec, Is<AssessRequest::Sector> auto& sector) {
    codec("sector", sector.sector);
    codec("candidates", sector.candidates);
}

void fields(auto& codec, Is<AssessRequest> auto& request) {
    codec("manifest", request.manifest);
    codec("settings", request.settings);
    codec("sectors", request.sectors);
}

void fields(auto& codec, Is<map::Survey> auto& survey) {
    map::visit_values(codec, survey);
}

void fields(auto& codec, Is<MapSummary> auto& summary) {
    codec("content", summary.content);
    codec("inventory", summary.inventory);
    codec("sectors", summary.sectors);
    codec("survey", summary.survey);
    codec("warnings", summary.warnings);
}

void fields(auto& codec, Is<SectorNumbers> auto& numbers) {
    worker::visit_values(codec, numbers);
}

void fields(auto& codec, Is<bake::StageSeconds> auto& stages) {
    bake::visit_values(codec, stages);
}

void fields(auto& codec, Is<SectorResult> auto& result) {
    codec("blobs", result.blobs);
    codec("file_bytes", result.file_bytes);
    codec("footprint_bytes", result.footprint_bytes);
    codec("probes", result.probes);
    codec("rays", result.rays);
    codec("warnings", result.warnings);
    codec("seconds", result.seconds);
    codec("bound", result.bound);
    codec("numbers", result.numbers);
    codec("stages", result.stages);
}

void fields(auto& codec, Is<Assessments::Sector> auto& sector) {
    codec("verdict", sector.verdict);
    codec("candidate", sector.candidate);
    codec("bound", sector.bound);
    codec("share", sector.share);
    codec("reason", sector.reason);
    codec("cause", sector.cause);
}

void fields(auto& codec, Is<MapChange> auto& change) {
    codec("what", change.what);
    codec("x0", change.bounds.low.x);
    codec("y0", change.bounds.low.y);
    codec("z0", change.bounds.low.z);
    codec("x1", change.bounds.high.x);
    codec("y1", change.bounds.high.y);
    codec("z1", change.bounds.high.z);
}

void fields(auto& codec, Is<Assessments> auto& assessments) {
    codec("sectors", assessments.sectors);
    codec("changes", assessments.changes);
    codec("warnings", assessments.warnings);
}

void fields(auto& codec, Is<RequestFailure> auto& failure) {
    codec("sentence", failure.sentence);
    codec("may_retry", failure.may_retry);
}

class Writer {
  public:
    template <class Value>
    void operator()(std::string_view key, const Value& value) {
        json_[key] = written(value);
    }
    // Left out where there is none.
    template <class Value>
    void operator()(std::string_view key, const std::optional<Value>& value) {
        if (value)
            json_[key] = written(*value);
    }

    template <class Struct>
    static Json written(const Struct& value) {
        Writer writer;
        fields(writer, value);
        return std::move(writer.json_);
    }
    template <class Value>
    static Json written(const std::vector<Value>& values) {
        Json json = Json::array();
        for (const Value& value : values)
            json.push_back(written(value));
        return json;
    }
    template <class Number>
    requires std::is_arithmetic_v<Number>
    static Json written(const Number& number) { return number; }
    static Json written(const std::string& text) { return text; }
    static Json written(const Digest& digest) { return to_hex(digest); }
    static Json written(const reuse::Verdict& verdict) { return static_cast<unsigned>(verdict); }

  private:
    Json json_ = Json::object();
};

// Throws what Json and the standard library throw.
class Reader {
  public:
    explicit Reader(const Json& json) : json_(json) {}

    template <class Value>
    void operator()(std::string_view key, Value& value) {
        read(json_.at(key), value);
    }
    template <class Value>
    void operator()(std::string_view key, std::optional<Value>& value) {
        if (json_.contains(key))
            read(json_.at(key), value.emplace());
    }

    template <class Struct>
    static void read(const Json& json, Struct& value) {
        Reader reader(json);
        fields(reader, value);
    }
    template <class Value>
    static void read(const Json& json, std::vector<Value>& values) {
        for (const Json& element : json.get_ref<const Json::array_t&>())
            read(element, values.emplace_back());
    }
    template <std::integral Integer>
    static void read(const Json& json, Integer& value) {
        // The library would cut a number to its type without a word.
        const bool fits = json.is_number_unsigned()
                              ? std::in_range<Integer>(json.get<std::uint64_t>())
                              : json.is_number_integer() && std::in_range<Integer>(json.get<std::int64_t>());
        if (!fits)
            throw std::out_of_range("not an integer in range");
        value = json.get<Integer>();
    }
    template <std::floating_point Real>
    static void read(const Json& json, Real& value) {
        value = json.get<Real>();
    }
    static void read(const Json& json, bool& value) { value = json.get<bool>(); }
    static void read(const Json& json, std::string& text) { text = json.get<std::string>(); }
    static void read(const Json& json, Digest& digest) {
        digest = map::digest_from_hex(json.get<std::string>()).value();
    }
    static void read(const Json& json, reuse::Verdict& verdict) {
        std::uint8_t number = 0;
        read(json, number);
        if (number > static_cast<std::uint8_t>(reuse::Verdict::rebake))
            throw std::out_of_range("unknown verdict");
        verdict = static_cast<reuse::Verdict>(number);
    }

  private:
    const Json& json_;
};

// Which of the alternatives a line holds.
template <class What>
constexpr const char* name_of = nullptr;
template <>
constexpr const char* name_of<InspectRequest> = "inspect";
template <>
constexpr const char* name_of<BakeRequest> = "bake";
template <>
constexpr const char* name_of<AssessRequest> = "assess";
template <>
constexpr const char* name_of<MapSummary> = "inspected";
template <>
constexpr const char* name_of<SectorResult> = "baked";
template <>
constexpr const char* name_of<Assessments> = "assessed";
template <>
constexpr const char* name_of<RequestFailure> = "failed";

template <class Message>
std::string line_of(const Message& message) {
    Json json = std::visit(
        [](const auto& what) {
            Json fields = Writer::written(what);
            fields["op"] = name_of<std::decay_t<decltype(what)>>;
            return fields;
        },
        message.what);
    json["id"] = message.id;
    // Left out where it is 0: what names a request by its line names it without.
    if constexpr (requires { message.rank; }) {
        if (message.rank != 0)
            json["rank"] = message.rank;
    }
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <class... Alternatives>
void read_named(const Json& json, std::variant<Alternatives...>& what) {
    const std::string op = json.at("op").get<std::string>();
    const auto read_if = [&]<class What>(std::type_identity<What>) {
        if (op == name_of<What>)
            Reader::read(json, what.template emplace<What>());
        return op == name_of<What>;
    };
    if (!(read_if(std::type_identity<Alternatives>{}) || ...))
        throw std::invalid_argument("unknown operation");
}

// A line from the other side is trusted no further than this: anything odd is nothing.
template <class Message>
std::optional<Message> message_of(std::string_view line) {
    try {
        const Json json = Json::parse(line);
        Message message;
        Reader::read(json.at("id"), message.id);
        read_named(json, message.what);
        if constexpr (requires { message.rank; }) {
            if (json.contains("rank"))
                Reader::read(json.at("rank"), message.rank);
        }
        return message;
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

}  // namespace

std::string encode(const Request& request) {
    return line_of(request);
}

std::string encode(const Answer& answer) {
    return line_of(answer);
}

std::optional<Request> decode_request(std::string_view line) {
    return message_of<Request>(line);
}

std::optional<Answer> decode_answer(std::string_view line) {
    return message_of<Answer>(line);
}

}  // namespace drtv::worker
