#include "bakerd/map/roles_file.h"

#include "bakerd/map/json_text.h"
#include "bakerd/map/node_role.h"
#include "bakerd/map/property_check.h"
#include "map_files/reference.h"

#include <fmt/format.h>
#include <fnmatch.h>
#include <locale.h>
#include <nlohmann/json.hpp>

namespace drtv::map {
namespace {

using OrderedJson = nlohmann::ordered_json;

tl::expected<tinygltf::Value, std::string> value_of(const std::string& key, const OrderedJson& json) {
    if (const auto meant = property_meant(key))
        return tl::unexpected(fmt::format("'{}' is no property: did you mean {}?", key, *meant));
    if (!is_property(key))
        return tl::unexpected(
            fmt::format("'{}' is no property; bake_role, bake_probe, bake_spacing and light_group are", key));
    if (json.is_string())
        return tinygltf::Value(json.get<std::string>());
    if (json.is_number())
        return tinygltf::Value(json.get<double>());
    return tl::unexpected(fmt::format("{} is neither a text nor a number", key));
}

tl::expected<tinygltf::Value::Object, std::string> properties_of(const OrderedJson& json) {
    tinygltf::Value::Object properties;
    if (json.is_string()) {
        properties["bake_role"] = tinygltf::Value(json.get<std::string>());
        return properties;
    }
    if (!json.is_object())
        return tl::unexpected(std::string("it must be a role, or an object of properties"));
    for (const auto& [key, value] : json.items()) {
        auto read = value_of(key, value);
        if (!read)
            return tl::unexpected(read.error());
        properties[key] = std::move(*read);
    }
    return properties;
}

// While it lives, this thread's letters are those of UTF-8, whatever the environment says.
class Utf8Letters {
  public:
    Utf8Letters() : locale_(::newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr)) {
        if (locale_ != nullptr)
            before_ = ::uselocale(locale_);
    }
    ~Utf8Letters() {
        if (locale_ == nullptr)
            return;
        ::uselocale(before_);
        ::freelocale(locale_);
    }
    Utf8Letters(const Utf8Letters&) = delete;
    Utf8Letters& operator=(const Utf8Letters&) = delete;

  private:
    locale_t locale_;
    locale_t before_ = nullptr;
};

bool matches(const std::string& pattern, const std::string& name) {
    return ::fnmatch(pattern.c_str(), name.c_str(), FNM_NOESCAPE) == 0;
}

}  // namespace

tl::expected<RolesFile, std::string> RolesFile::parse(std::string_view text) {
    const auto json = parse_json<OrderedJson>(text);
    if (!json)
        return tl::unexpected("its JSON " + json.error());
    if (!json->is_object())
        return tl::unexpected(std::string("it is not an object of name patterns"));
    RolesFile file;
    for (const auto& item : json->items()) {
        const std::string& pattern = item.key();
        const auto fail = [&](const std::string& why) {
            return tl::unexpected(fmt::format("'{}': {}", pattern, why));
        };
        auto properties = properties_of(item.value());
        if (!properties)
            return fail(properties.error());
        // What would be wrong with a node that it matches is wrong with the file.
        tinygltf::Node node;
        node.extras = tinygltf::Value(*properties);
        NodePurpose purpose;
        if (auto read = read_purpose(node, purpose); !read)
            return fail(read.error());
        file.rules_.push_back({pattern, std::move(*properties)});
    }
    return file;
}

void RolesFile::apply(tinygltf::Model& model) {
    const Utf8Letters letters;
    for (tinygltf::Node& node : model.nodes) {
        tinygltf::Value::Object properties;
        for (Rule& rule : rules_) {
            if (!matches(rule.pattern, node.name))
                continue;
            rule.used = true;
            for (const auto& [key, value] : rule.properties)
                properties[key] = value;
        }
        if (properties.empty())
            continue;
        if (node.extras.IsObject()) {
            for (const auto& [key, value] : node.extras.Get<tinygltf::Value::Object>())
                properties[key] = value;
        }
        node.extras = tinygltf::Value(properties);
    }
}

std::vector<std::string> RolesFile::unused() const {
    std::vector<std::string> patterns;
    for (const Rule& rule : rules_) {
        if (!rule.used)
            patterns.push_back(rule.pattern);
    }
    return patterns;
}

tl::expected<void, std::string> RolesFiles::apply(GltfDocument& document) {
    const std::string path = map_files::roles_path(document.path);
    auto known = known_.find(path);
    if (known == known_.end()) {
        std::optional<RolesFile> file;
        const auto bytes = files_(path);
        if (!bytes && !bytes.error().is_missing)
            return tl::unexpected(bytes.error().sentence);
        if (bytes) {
            auto parsed = RolesFile::parse({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
            if (!parsed)
                return tl::unexpected(path + ": " + parsed.error());
            file = std::move(*parsed);
        }
        known = known_.emplace(path, std::move(file)).first;
    }
    if (known->second)
        known->second->apply(document.model);
    return {};
}

std::vector<std::string> RolesFiles::warnings() const {
    std::vector<std::string> sentences;
    for (const auto& [path, file] : known_) {
        if (!file)
            continue;
        for (const std::string& pattern : file->unused())
            sentences.push_back(fmt::format("{}: '{}' matches the name of no node beside it", path, pattern));
    }
    return sentences;
}

}  // namespace drtv::map
