// roles.json beside a map: what nodes are for, by their names; and properties that stand where nobody reads
// them.
#include "bakerd/map/import.h"
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <algorithm>

namespace drtv::test {
namespace {

using map::Map;
using map::Role;
using Sentences = std::vector<std::string>;

// Ground, two trees, a hut and a box, without a property.
GltfBuilder bare_scene() {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(ground(20)), .name = "ground"});
    const int crate = b.add_mesh(box({0, 0, 0}, {1, 1, 1}));
    for (const char* name : {"tree.001", "tree.002", "hut", "zone"})
        b.add_node({.mesh = crate, .name = name});
    return b;
}

tl::expected<Map, std::string> import_with(const GltfBuilder& b, const std::string& roles) {
    Files files = b.files();
    files["roles.json"] = bytes_of(roles);
    return import_files(files, {"map.gltf"});
}

std::size_t vegetation_of(const Map& map) {
    return static_cast<std::size_t>(std::ranges::count(map.objects, Role::vegetation, &map::Object::role));
}

TEST(RolesFile, PatternsGiveNodesTheirRoles) {
    const Map map = expect_accepted(import_with(bare_scene(), R"({
        "tree.*": "vegetation",
        "h?t": {"bake_role": "ignore"},
        "[yz]one": {"bake_role": "interior", "bake_spacing": 2}
    })"));
    EXPECT_EQ(vegetation_of(map), 2u);
    EXPECT_EQ(map.objects.size(), 3u);
    ASSERT_EQ(map.volumes.size(), 2u);
    EXPECT_EQ(std::ranges::count(map.volumes, 2.0f, &map::VolumeNode::spacing_m), 1);
    EXPECT_EQ(std::ranges::count(map.volumes, map::VolumeKind::interior, &map::VolumeNode::kind), 1);
    EXPECT_EQ(map.volumes[0].where, "map.gltf: node 4 ('zone')");
    EXPECT_EQ(map.ignored_nodes, 1);
    EXPECT_TRUE(map.warnings.empty());
}

TEST(RolesFile, LettersAreThoseOfAnyScript) {
    for (const char* pattern : {"B?", "B[\u00e4\u00f6]", "?\u00e4"}) {
        GltfBuilder b;
        b.add_node({.mesh = b.add_mesh(ground(20)), .name = "B\u00e4"});
        const Map map = expect_accepted(import_with(b, std::string("{\"") + pattern + "\": \"vegetation\"}"));
        EXPECT_EQ(vegetation_of(map), 1u) << pattern;
    }
}

TEST(RolesFile, LaterPatternsCountAndTheNodeItselfCountsMost) {
    GltfBuilder b = bare_scene();
    b.json["nodes"][1]["extras"] = {{"bake_role", "static"}, {"other", 7}};
    const Map map =
        expect_accepted(import_with(b, R"({"*": "ignore", "tree*": "vegetation", "ground": "static"})"));
    EXPECT_EQ(map.objects.size(), 3u);
    EXPECT_EQ(vegetation_of(map), 1u);
}

TEST(RolesFile, SameRolesAreTheSameContent) {
    GltfBuilder spoken = bare_scene();
    for (const std::size_t n : {1u, 2u})
        spoken.json["nodes"][n]["extras"]["bake_role"] = "vegetation";
    const Map with_extras = expect_accepted(spoken.import());
    const Map with_file = expect_accepted(import_with(bare_scene(), R"({"tree*": "vegetation"})"));
    EXPECT_EQ(with_extras.content, with_file.content);
    EXPECT_NE(with_extras.content, expect_accepted(bare_scene().import()).content);
}

TEST(RolesFile, PatternThatMatchesNothingIsWarnedOf) {
    const Map map =
        expect_accepted(import_with(bare_scene(), R"({"palm_*": "vegetation", "hut": "static"})"));
    EXPECT_EQ(map.warnings, Sentences{"roles.json: 'palm_*' matches the name of no node beside it"});
}

// One file for all documents of its folder, and for those alone.
TEST(RolesFile, CountsForItsFolder) {
    Files files = {{"west/a.gltf", bytes_of(bare_scene().gltf())},
                   {"west/b.gltf", bytes_of(bare_scene().gltf())},
                   {"east/c.gltf", bytes_of(bare_scene().gltf())},
                   {"west/roles.json", bytes_of(R"({"tree*": "vegetation"})")},
                   {"roles.json", bytes_of(R"({"*": "ignore"})")}};
    const Map map = expect_accepted(import_files(files, {"west/a.gltf", "west/b.gltf", "east/c.gltf"}));
    EXPECT_EQ(map.objects.size(), 15u);
    EXPECT_EQ(vegetation_of(map), 4u);
}

TEST(RolesFile, MistakesAreToldByPattern) {
    for (const auto& [roles, parts] : std::vector<std::pair<std::string, Sentences>>{
             {"{\"a\": \"static\",\n \"b\"", {"its JSON ends too early at line 2"}},
             {"[]", {"not an object of name patterns"}},
             {R"({"tree*": "vegetatoin"})", {"'tree*'", "vegetatoin", "is not one of"}},
             {R"({"nobody": {"bake_role": 3}})", {"'nobody'", "must be a string"}},
             {R"({"nobody": {"bake_rule": "static"}})",
              {"'nobody'", "'bake_rule'", "did you mean bake_role"}},
             {R"({"nobody": {"colour": "red"}})", {"'nobody'", "'colour' is no property"}},
             {R"({"nobody": ["static"]})", {"'nobody'", "object of properties"}},
             {R"({"nobody": {"bake_spacing": 99}})", {"'nobody'", "99"}}}) {
        for (const std::string& part : parts)
            expect_refused(import_with(bare_scene(), roles), {"roles.json: ", part});
    }
}

TEST(RolesFile, LostFileIsNotPassedOver) {
    const std::string text = bare_scene().gltf();
    const auto map = map::import_map(
        Sentences{"map.gltf"}, [&](const std::string& path) -> tl::expected<FileBytes, map::FileFailure> {
            if (path == "map.gltf")
                return bytes_of(text);
            return tl::unexpected(map::FileFailure{"the file 'roles.json' is lost"});
        });
    expect_refused(map, {"'roles.json' is lost"});
}

TEST(Properties, WhereNobodyReadsThemAreToldWithARemedy) {
    const auto warnings = [](const auto& edit) {
        GltfBuilder b = bare_scene();
        b.json["materials"] = Json::array({Json::object({{"name", "leaf"}})});
        b.json["scenes"] = Json::array({Json::object({{"nodes", {0, 1, 2, 3, 4}}})});
        edit(b.json);
        return expect_accepted(b.import()).warnings;
    };
    EXPECT_EQ(warnings([](Json& j) { j["meshes"][0]["extras"]["bake_role"] = "vegetation"; }),
              Sentences{"map.gltf: mesh 0 says bake_role, which counts on nodes alone: set it on the object, "
                        "not on its data"});
    EXPECT_EQ(
        warnings([](Json& j) { j["materials"][0]["extras"]["bake_role"] = "vegetation"; }),
        Sentences{"map.gltf: the material 'leaf' says bake_role, which counts on nodes alone: set it on "
                  "the objects that wear the material"});
    EXPECT_EQ(warnings([](Json& j) { j["scenes"][0]["extras"]["bake_role"] = "vegetation"; }),
              Sentences{"map.gltf: scene 0 says bake_role, which counts on nodes alone: set it on an object, "
                        "whose children inherit it"});
    for (const char* key : {"bake-role", "BakeRole", "bakerole", "Bake Role", "bake_rol", "bake_rules"}) {
        SCOPED_TRACE(key);
        const std::string meant = std::string("map.gltf: the node 'hut' says '") + key +
                                  "', which is not read: did you mean bake_role?";
        const Sentences told = warnings([&](Json& j) { j["nodes"][3]["extras"][key] = 1; });
        EXPECT_EQ(told.size(), std::string(key) == "bake_rules" ? 0u : 1u);
        if (!told.empty()) {
            EXPECT_EQ(told[0], meant);
        }
    }
    // Once for all objects.
    const Sentences of_two = warnings([](Json& j) {
        j["nodes"][2]["extras"]["bakerole"] = j["nodes"][3]["extras"]["bakerole"] = "ignore";
    });
    ASSERT_EQ(of_two.size(), 1u);
    EXPECT_NE(of_two[0].find("and 1 more say 'bakerole'"), std::string::npos) << of_two[0];
    // Words that other programs use as well: only where no node has a role.
    const auto say_role = [](Json& j) { j["nodes"][3]["extras"]["role"] = "vegetation"; };
    EXPECT_EQ(
        warnings(say_role),
        Sentences{"map.gltf: the node 'hut' says 'role', and no node has a bake_role: did you mean that?"});
    EXPECT_EQ(warnings([](Json& j) { j["nodes"][3]["extras"]["vegetation"] = true; }).size(), 1u);
    EXPECT_TRUE(warnings([&](Json& j) {
                    say_role(j);
                    j["nodes"][2]["extras"]["bake_role"] = "static";
                }).empty());
    EXPECT_TRUE(
        warnings([](Json& j) {
            j["nodes"][3]["extras"] = {{"bake_role", "ignore"}, {"role", "x"}, {"light", 1}, {"bake", 1}};
        }).empty());
}

}  // namespace
}  // namespace drtv::test
