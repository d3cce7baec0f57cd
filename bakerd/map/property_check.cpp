#include "bakerd/map/property_check.h"

#include "format/spelling/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

namespace drtv::map {
namespace {

constexpr std::array<std::string_view, 4> properties = {
    "bake_role", "bake_probe", "bake_spacing", "light_group"};

// Lower-case letters and digits alone: "Bake-Role" is "bakerole".
std::string bare(std::string_view key) {
    std::string letters;
    for (const char c : key) {
        if (c >= 'A' && c <= 'Z')
            letters += static_cast<char>(c - 'A' + 'a');
        else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
            letters += c;
    }
    return letters;
}

std::string shown(const std::string& kind, const std::string& name, std::size_t number) {
    return name.empty() ? fmt::format("{} {}", kind, number) : fmt::format("the {} '{}'", kind, name);
}

// Of one kind of things that are not nodes.
template <class Things>
void tell_of(const Things& things,
             const std::string& kind,
             const std::string& remedy,
             std::vector<std::string>& sentences) {
    for (std::size_t n = 0; n < things.size(); ++n) {
        if (!things[n].extras.IsObject())
            continue;
        for (const std::string& key : things[n].extras.Keys()) {
            if (is_property(key) || property_meant(key))
                sentences.push_back(fmt::format("{} says {}, which counts on nodes alone: {}",
                                                shown(kind, things[n].name, n),
                                                key,
                                                remedy));
        }
    }
}

struct Seen {
    std::size_t first;
    std::size_t count;
};

std::string who(const std::vector<tinygltf::Node>& nodes, const Seen& seen) {
    const std::string first = shown("node", nodes[seen.first].name, seen.first);
    return seen.count == 1 ? first + " says" : fmt::format("{} and {} more say", first, seen.count - 1);
}

// Each key once: an artist who misspells it does so on every object.
void tell_misspelled(const std::vector<tinygltf::Node>& nodes, std::vector<std::string>& sentences) {
    std::map<std::string, Seen> seen;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (!nodes[n].extras.IsObject())
            continue;
        for (const std::string& key : nodes[n].extras.Keys()) {
            if (property_meant(key))
                ++seen.try_emplace(key, Seen{n, 0}).first->second.count;
        }
    }
    for (const auto& [key, where] : seen)
        sentences.push_back(fmt::format(
            "{} '{}', which is not read: did you mean {}?", who(nodes, where), key, *property_meant(key)));
}

// Words of ours under keys that are not: told where no node has a role, for other programs use them as well.
void tell_words_of_ours(const std::vector<tinygltf::Node>& nodes, std::vector<std::string>& sentences) {
    constexpr std::array<std::string_view, 5> roles = {
        "vegetation", "ignore", "probe", "no_probes", "interior"};
    const auto is_role = [&](std::string_view word) { return std::ranges::find(roles, word) != roles.end(); };
    std::map<std::string, Seen> seen;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const tinygltf::Value& extras = nodes[n].extras;
        if (!extras.IsObject())
            continue;
        if (extras.Has("bake_role"))
            return;
        for (const std::string& key : extras.Keys()) {
            const tinygltf::Value& value = extras.Get(key);
            const bool names_role =
                value.IsString() && is_role(value.Get<std::string>()) && !property_meant(key);
            if (names_role || is_role(key))
                ++seen.try_emplace(key, Seen{n, 0}).first->second.count;
        }
    }
    for (const auto& [key, where] : seen)
        sentences.push_back(
            fmt::format("{} '{}', and no node has a bake_role: did you mean that?", who(nodes, where), key));
}

}  // namespace

bool is_property(std::string_view key) {
    return std::ranges::find(properties, key) != properties.end();
}

std::optional<std::string_view> property_meant(std::string_view key) {
    if (is_property(key))
        return std::nullopt;
    const std::string letters = bare(key);
    const auto is_meant = [&](std::string_view property) {
        return spelling::edit_distance(letters, bare(property)) <= 1;
    };
    const auto* found = std::ranges::find_if(properties, is_meant);
    return found == properties.end() ? std::nullopt : std::optional(*found);
}

std::vector<std::string> unheard_properties(const tinygltf::Model& model) {
    std::vector<std::string> sentences;
    tell_misspelled(model.nodes, sentences);
    tell_words_of_ours(model.nodes, sentences);
    const std::string on_object = "set it on the object, not on its data";
    tell_of(model.lights, "light", on_object, sentences);
    tell_of(model.meshes, "mesh", on_object, sentences);
    tell_of(model.cameras, "camera", on_object, sentences);
    tell_of(model.materials, "material", "set it on the objects that wear the material", sentences);
    tell_of(model.scenes, "scene", "set it on an object, whose children inherit it", sentences);
    return sentences;
}

}  // namespace drtv::map
