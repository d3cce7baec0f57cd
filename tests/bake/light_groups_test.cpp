// Light groups: each holds what its lights alone would bring, to the byte, and nothing else changes.
#include "bakerd/bake/sector_bake.h"
#include "bakerd/bake/sector_file.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace drtv::test {
namespace {

// What is of a group, by name; "" is none.
using Groups = std::function<std::optional<std::string>(const std::string& light)>;

// A yard with walls, a lamp, a spot, a glowing sign and a sun. Lights that are not `kept` are not there.
GltfBuilder yard(const Groups& group_of, const std::function<bool(const std::string&)>& kept) {
    GltfBuilder b;
    const int grey = b.add_material({.colour = {0.6f, 0.5f, 0.4f, 1}});
    b.place(ground(40), "", grey);
    b.place(box({-6, 0, -1}, {-4, 5, 3}), "", grey);
    b.place(box({8, 0, -12}, {9, 4, -4}), "", grey);
    const auto add = [&](const std::string& name, NodeSource node) {
        if (!kept(name))
            return;
        node.name = name;
        node.light_group = group_of(name);
        b.add_node(node);
    };
    add("lamp", {.light = b.add_light({{"type", "point"}, {"intensity", 3000}, {"color", {1, 0.8, 0.5}}}),
                 .translation = glm::dvec3(10.3, 3.1, -9.7)});
    add("spot",
        {.light = b.add_light({{"type", "spot"}, {"intensity", 9000}, {"spot", {{"outerConeAngle", 0.9}}}}),
         .translation = glm::dvec3(20.1, 6.2, -20.4),
         .rotation = glm::dvec4(-0.6, 0, 0, 0.8)});
    add("sun", {.light = b.add_light({{"type", "directional"}, {"intensity", 500}}),
                .rotation = glm::dvec4(-0.6, 0, 0, 0.8)});
    const int glow = b.add_material({.colour = {0.2f, 0.2f, 0.2f, 1}});
    auto& json = b.json["materials"][static_cast<std::size_t>(glow)];
    json["emissiveFactor"] = {0.2, 0.9, 1};
    json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 700;
    add("sign", {.mesh = b.add_mesh(box({14, 1, -18}, {16, 2, -17.8f}), glow)});
    if (!kept("sign"))
        b.place(box({14, 1, -18}, {16, 2, -17.8f}), "", b.add_material({.colour = {0.2f, 0.2f, 0.2f, 1}}));
    return b;
}

bool all(const std::string&) {
    return true;
}
std::optional<std::string> none(const std::string&) {
    return std::nullopt;
}

Sector baked(const GltfBuilder& b) {
    settings::BakeSettings settings;
    settings.rays = 256;
    auto sector = bake::bake_sector(*open_world(b), {0, 0}, settings);
    EXPECT_TRUE(sector) << sector.error();
    EXPECT_TRUE(bake::encode_sector(sector->sector, sector->warnings));
    return sector->sector;
}

std::optional<std::string> night(const std::string& light) {
    if (light == "lamp" || light == "sign")
        return "night";
    return light == "spot" ? std::optional<std::string>("stage") : std::nullopt;
}

TEST(LightGroups, EachIsWhatItsLightsAloneBring) {
    const Sector sector = baked(yard(night, all));
    ASSERT_EQ(sector.light_groups.size(), 2u);
    EXPECT_EQ(sector.light_groups[0].name, "night");
    EXPECT_EQ(sector.light_groups[1].name, "stage");
    const auto alone = [&](const std::optional<std::string>& group) {
        return baked(yard(none, [&](const std::string& light) { return night(light) == group; }));
    };
    EXPECT_EQ(sector.light_groups[0].irradiance, alone("night").static_irradiance);
    EXPECT_EQ(sector.light_groups[1].irradiance, alone("stage").static_irradiance);
    EXPECT_EQ(sector.static_irradiance, alone(std::nullopt).static_irradiance);
    const Sector ungrouped = baked(yard(none, all));
    EXPECT_TRUE(ungrouped.light_groups.empty());
    EXPECT_EQ(sector.probes, ungrouped.probes) << "what the sky brings does not change";
    EXPECT_EQ(sector.grid, ungrouped.grid);
    // Errors stand beside them.
    ASSERT_TRUE(sector.quality);
    ASSERT_EQ(sector.quality->group_errors.size(), 2u);
    for (std::size_t p = 0; p < sector.probes.size(); ++p) {
        EXPECT_EQ(sector.quality->group_errors[0][p], alone("night").quality->probes[p].static_error);
        EXPECT_EQ(sector.quality->probes[p].static_error,
                  alone(std::nullopt).quality->probes[p].static_error);
    }
}

TEST(LightGroups, TogetherTheyAreAllLight) {
    const Sector grouped = baked(yard(night, all));
    const Sector ungrouped = baked(yard(none, all));
    const auto value = [](const StaticIrradiance& light, std::size_t c, std::size_t b) {
        return static_cast<double>(decode_fixed(light.codes[c][b], scale_of_exponent(light.exponent)));
    };
    double sum = 0, difference = 0;
    for (std::size_t p = 0; p < grouped.probes.size(); ++p) {
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t b = 0; b < basis_count; ++b) {
                double apart = value(grouped.static_irradiance[p], c, b);
                for (const LightGroup& group : grouped.light_groups)
                    apart += value(group.irradiance[p], c, b);
                const double together = value(ungrouped.static_irradiance[p], c, b);
                sum += together;
                difference += apart - together;
            }
        }
    }
    EXPECT_GT(sum, 1);
    EXPECT_NEAR(difference / sum, 0, 0.01);
}

// Light that only some rays find does not decide which groups a file has.
TEST(LightGroups, OneThatIsFaintEverywhereIsLeftOut) {
    GltfBuilder b;
    b.place(ground(40), "", b.add_material({.colour = {0.6f, 0.5f, 0.4f, 1}}));
    for (const auto& [candela, group] : {std::pair(1000.0, "bright"), std::pair(0.001, "faint")})
        b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", candela}}),
                    .translation = glm::dvec3(20, 5, -20),
                    .light_group = group});
    const Sector sector = baked(b);
    ASSERT_EQ(sector.light_groups.size(), 1u);
    EXPECT_EQ(sector.light_groups[0].name, "bright");
    EXPECT_EQ(sector.quality->group_errors.size(), 1u);
}

// What no path found is not certain.
TEST(LightGroups, ErrorOfLightThatNoPathFoundIsOne) {
    GltfBuilder b;
    const int grey = b.add_material({.colour = {0.6f, 0.5f, 0.4f, 1}});
    b.place(ground(40), "", grey);
    b.place(room({-4, 0, -3}, {0, 3, 3}), "", grey);
    b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", 10}}),
                .translation = glm::dvec3(20, 5, -20),
                .light_group = "outside"});
    const auto world = open_world(b);
    const bake::ProbeLight inside = light_at(*world, {-2, 0, 1}, 256);
    EXPECT_EQ(inside.groups.at(0).irradiance, bake::BasisIrradiance{});
    EXPECT_EQ(inside.groups.at(0).error, 1);
    EXPECT_EQ(inside.static_error, 0) << "there is no lamp without a group";
    EXPECT_LT(light_at(*world, {18, 19, 1}, 256).groups.at(0).error, 1);
}

TEST(LightGroups, AreInheritedAndAnEmptyNameEndsThem) {
    GltfBuilder b;
    b.place(ground(40), "", b.add_material({.colour = {0.6f, 0.5f, 0.4f, 1}}));
    const auto lamp = [&](double x, std::optional<std::string> group) {
        return b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", 100}}),
                           .translation = glm::dvec3(x, 2, -20),
                           .light_group = std::move(group)});
    };
    const int inner = b.add_node({.children = {lamp(10, std::nullopt), lamp(20, "own"), lamp(30, "")}});
    b.add_node({.children = {inner}, .light_group = "street"});
    const auto map = b.import();
    ASSERT_TRUE(map) << map.error();
    ASSERT_EQ(map->lights.size(), 3u);
    std::vector<std::pair<float, std::string>> groups;
    for (const map::Light& light : map->lights) {
        const bool has = light.light_group != map::no_light_group;
        groups.emplace_back(light.position.x, has ? map->light_groups[light.light_group] : "");
    }
    std::ranges::sort(groups);
    EXPECT_EQ(groups[0].second, "street");
    EXPECT_EQ(groups[1].second, "own");
    EXPECT_EQ(groups[2].second, "");
    EXPECT_TRUE(map->warnings.empty());
}

TEST(LightGroups, MoreThanAFileHoldsAreNamed) {
    const auto world_with = [](int groups, bool with_range) {
        GltfBuilder b;
        b.place(ground(40), "", b.add_material({.colour = {0.6f, 0.5f, 0.4f, 1}}));
        for (int n = 0; n < groups; ++n) {
            Json lamp = {{"type", "point"}, {"intensity", 100}};
            if (with_range && n > 0)
                lamp["range"] = 0.5;
            b.add_node({.light = b.add_light(lamp),
                        .translation = glm::dvec3(4 + 3 * n, n == 0 || !with_range ? 2 : 30, -20),
                        .light_group = "lamps " + std::to_string(n)});
        }
        return open_world(b);
    };
    settings::BakeSettings settings;
    settings.rays = 64;
    EXPECT_TRUE(bake::bake_sector(*world_with(8, false), {0, 0}, settings));
    const auto failed = bake::bake_sector(*world_with(9, false), {0, 0}, settings);
    ASSERT_FALSE(failed);
    EXPECT_TRUE(failed.error().starts_with(
        "sector (0, 0): 9 light groups shine on its probes, a file holds at most 8: lamps 0 (0.0"))
        << failed.error();
    EXPECT_TRUE(failed.error().ends_with(" W/m2). Give lights that are switched together one light_group"))
        << failed.error();
    EXPECT_NE(failed.error().find("lamps 8 (0.0"), std::string::npos) << failed.error();
    // Those that bring nothing do not count.
    const auto far = bake::bake_sector(*world_with(12, true), {0, 0}, settings);
    ASSERT_TRUE(far) << far.error();
    EXPECT_EQ(far->sector.light_groups.size(), 1u);
}

TEST(LightGroups, ANameThatCannotBeIsRefusedAndOneOfNoUseIsWarnedOf) {
    const auto with = [](const Json& name) {
        GltfBuilder b;
        b.place(ground(40));
        const int node = b.add_node({.light = b.add_light({{"type", "point"}}), .name = "lantern"});
        b.json["nodes"][static_cast<std::size_t>(node)]["extras"]["light_group"] = name;
        return b.import();
    };
    EXPECT_TRUE(with(std::string(63, 'a')));
    EXPECT_EQ(with(std::string(64, 'a')).error(), "map.gltf: node 1 ('lantern'): light_group '" +
                                                      std::string(64, 'a') +
                                                      "' has 64 bytes, over the limit of 63");
    EXPECT_EQ(with(7).error(), "map.gltf: node 1 ('lantern'): light_group must be a string");
    EXPECT_EQ(with("lanterns ").error(),
              "map.gltf: node 1 ('lantern'): light_group 'lanterns ' begins or ends with a space");
    EXPECT_EQ(with("a\nb").error(),
              "map.gltf: node 1 ('lantern'): light_group has a control character in its name");

    GltfBuilder b;
    b.place(ground(40));
    b.add_node({.mesh = b.add_mesh(box({0, 0, 0}, {1, 1, 1})), .name = "shade", .light_group = "lanterns"});
    const auto map = b.import();
    ASSERT_TRUE(map) << map.error();
    ASSERT_EQ(map->warnings.size(), 1u);
    EXPECT_EQ(map->warnings[0],
              "map.gltf: node 1 ('shade'): light_group 'lanterns' is of no use: nothing there shines");
}

TEST(LightGroups, InExtrasOfALightAMeshOrAMaterialAreWarnedOf) {
    GltfBuilder b;
    b.place(ground(40), "", b.add_material({.colour = {0.1f, 0.3f, 0.1f, 1}, .name = "grass"}));
    b.add_node({.light = b.add_light({{"type", "point"}, {"name", "bulb"}})});
    b.json["materials"][0]["extras"]["light_group"] = "lanterns";
    b.json["meshes"][0]["extras"]["light_group"] = "lanterns";
    b.json["meshes"][0]["name"] = "meadow";
    b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"]["light_group"] = "lanterns";
    const auto map = b.import();
    ASSERT_TRUE(map) << map.error();
    EXPECT_EQ(map->warnings,
              (std::vector<std::string>{"map.gltf: the light 'bulb' says light_group, which counts on nodes "
                                        "alone: set it on the object, not on its data",
                                        "map.gltf: the mesh 'meadow' says light_group, which counts on nodes "
                                        "alone: set it on the object, not on its data",
                                        "map.gltf: the material 'grass' says light_group, which counts on "
                                        "nodes alone: set it on the objects that wear the material"}));
    EXPECT_TRUE(map->light_groups.empty());
}

TEST(LightGroups, ContentFollowsTheName) {
    const auto content = [](const Groups& groups) { return yard(groups, all).import()->content; };
    const auto named = [](const std::string& name) {
        return [name](const std::string& light) {
            return light == "sign" ? std::optional<std::string>(name) : std::nullopt;
        };
    };
    EXPECT_EQ(content(named("a")), content(named("a")));
    EXPECT_NE(content(named("a")), content(named("b")));
    EXPECT_NE(content(named("a")), content(none));
    EXPECT_EQ(content(named("")), content(none));
}

}  // namespace
}  // namespace drtv::test
