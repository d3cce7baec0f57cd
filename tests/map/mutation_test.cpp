// Cut and damaged files: each gives a map or one sentence. Run under sanitizers, this is where reads out of
// bounds would show.
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"
#include "tests/map/specimen.h"

#include <chrono>
#include <functional>
#include <random>

namespace drtv::test {
namespace {

constexpr unsigned seed = 20240613;

void expect_map_or_sentence(const FileBytes& bytes) {
    const auto start = std::chrono::steady_clock::now();
    const auto map = import_files({{"x", bytes}}, {"x"});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
    if (!map)
        expect_refused(map, {"x: "});
}

TEST(Mutation, SpecimenIsSound) {
    EXPECT_EQ(expect_accepted(specimen().import()).objects.size(), 3u);
    EXPECT_EQ(expect_accepted(import_files({{"x", specimen().glb()}}, {"x"})).objects.size(), 3u);
    EXPECT_EQ(expect_accepted(extended_specimen().import()).objects.size(), 2u);
}

TEST(Mutation, EveryPrefixOfAGlbIsRefused) {
    const FileBytes glb = specimen().glb();
    for (std::size_t size = 0; size < glb.size(); size += size < 200 ? 1 : 7) {
        expect_refused(
            import_files({{"x", {glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(size)}}}, {"x"}),
            {"x: "});
    }
}

// The header's length corrected, so that more of the reader is reached.
TEST(Mutation, EveryPrefixOfAGlbThatSaysItsLengthIsMapOrSentence) {
    const FileBytes glb = specimen().glb();
    for (std::size_t size = 20; size < glb.size(); size += size < 200 ? 1 : 7) {
        FileBytes cut(glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(size));
        cut[8] = static_cast<std::uint8_t>(size);
        cut[9] = static_cast<std::uint8_t>(size >> 8);
        expect_map_or_sentence(cut);
    }
}

TEST(Mutation, EveryPrefixOfAGltfIsRefused) {
    const std::string text = specimen().gltf();
    for (std::size_t size = 0; size < text.size(); size += size < 200 ? 1 : 7)
        expect_refused(import_files({{"x", bytes_of(text.substr(0, size))}}, {"x"}), {"x: "});
}

void damage(const FileBytes& sound, int times, unsigned salt) {
    std::mt19937 random(seed + salt);
    for (int n = 0; n < times && !::testing::Test::HasFailure(); ++n) {
        FileBytes bytes = sound;
        const std::size_t at = random() % bytes.size();
        const auto value = static_cast<std::uint8_t>(random());
        SCOPED_TRACE("byte " + std::to_string(at) + " = " + std::to_string(value));
        bytes[at] = value;
        expect_map_or_sentence(bytes);
    }
}

TEST(Mutation, DamagedGlbIsMapOrSentence) {
    damage(specimen().glb(), 4000, 1);
}

TEST(Mutation, DamagedGltfIsMapOrSentence) {
    damage(bytes_of(specimen().gltf()), 4000, 2);
}

TEST(Mutation, DamagedExtensionsAreMapOrSentence) {
    damage(extended_specimen().glb(), 4000, 4);
}

// Damage that keeps the JSON sound reaches deeper: each number, string and member is replaced in turn.
void visit(Json& at, const std::function<void(Json&)>& edit) {
    edit(at);
    if (!at.is_structured())
        return;
    for (Json& child : at)
        visit(child, edit);
}

TEST(Mutation, AnyValueReplacedIsMapOrSentence) {
    const Json sound = Json::parse(specimen().gltf());
    std::size_t values = 0;
    Json counted = sound;
    visit(counted, [&](Json&) { ++values; });
    const std::vector<Json> others = {-1,
                                      0,
                                      1,
                                      2,
                                      3,
                                      7,
                                      255,
                                      65536,
                                      2147483647,
                                      2147483648u,
                                      4294967295u,
                                      4294967296,
                                      UINT64_MAX,
                                      INT64_MIN,
                                      0.5,
                                      -0.0,
                                      1e39,
                                      1e300,
                                      nullptr,
                                      true,
                                      "",
                                      "x",
                                      "../x",
                                      "data:,",
                                      Json::array(),
                                      Json::object(),
                                      Json::array({0}),
                                      Json::array({Json::object()})};
    for (std::size_t n = 0; n < values && !::testing::Test::HasFailure(); ++n) {
        for (const Json& other : others) {
            Json broken = sound;
            std::size_t k = 0;
            visit(broken, [&](Json& value) {
                if (k++ == n)
                    value = other;
            });
            SCOPED_TRACE("value " + std::to_string(n) + " = " + other.dump());
            expect_map_or_sentence(bytes_of(broken.dump()));
        }
    }
}

TEST(Mutation, DamagedPicturesAreMapOrSentence) {
    // A JPEG's decoder is only reached through real files; corpus_test damages those.
    Picture picture{16, 16, std::vector<std::uint8_t>(16 * 16 * 4)};
    for (std::size_t n = 0; n < picture.rgba.size(); ++n)
        picture.rgba[n] = static_cast<std::uint8_t>(n * n);
    const FileBytes sound = png_of(picture);
    GltfBuilder b;
    b.json["images"] = Json::array({Json::object({{"uri", "x.png"}})});
    b.json["textures"] = Json::array({Json::object({{"source", 0}})});
    b.place(ground(1), "", b.add_material({.texture = 0}));
    std::mt19937 random(seed + 3);
    for (int n = 0; n < 3000; ++n) {
        FileBytes bytes = sound;
        for (std::size_t k = random() % 3 + 1; k > 0; --k)
            bytes[random() % (n % 2 == 0 ? 80 : bytes.size())] = static_cast<std::uint8_t>(random());
        const auto map = import_files({{"x", bytes_of(b.gltf())}, {"x.png", bytes}}, {"x"});
        if (!map)
            expect_refused(map, {"x: ", "image 0"});
    }
}

}  // namespace
}  // namespace drtv::test
