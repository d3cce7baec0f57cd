#include "bakerd/map/property_check.h"

#include "format/spelling/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        if (!model.nodes[n].extras.IsObject())
            continue;
        for (const std::string& key : model.nodes[n].extras.Keys()) {
            if (const auto meant = property_meant(key))
                sentences.push_back(fmt::format("{} says '{}', which is not read: did you mean {}?",
                                                shown("node", model.nodes[n].name, n),
                                                key,
                                                *meant));
        }
    }
    const std::string on_object = "set it on the object, not on its data";
    tell_of(model.lights, "light", on_object, sentences);
    tell_of(model.meshes, "mesh", on_object, sentences);
    tell_of(model.cameras, "camera", on_object, sentences);
    tell_of(model.materials, "material", "set it on the objects that wear the material", sentences);
    tell_of(model.scenes, "scene", "set it on an object, whose children inherit it", sentences);
    return sentences;
}

}  // namespace drtv::map
