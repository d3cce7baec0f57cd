#include "bakerd/store/manifest.h"
#include "tests/store/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace drtv::store {
namespace {

Digest digest_of(const std::string& text) {
    return map::digest_of(test::bytes_of(text));
}

Manifest manifest(const std::vector<std::string>& paths, const std::vector<std::string>& roots) {
    Manifest made{{}, roots};
    for (const std::string& path : paths)
        made.files.push_back({path, digest_of(path), 12});
    return made;
}

void expect_refused(const Manifest& bad, const std::string& with) {
    const auto result = normalised(bad);
    ASSERT_FALSE(result) << with;
    EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(result.error().message.find(with), std::string::npos) << result.error().message;
}

TEST(Manifest, PathsThatLeaveTheMapOrHaveTwoSpellingsAreRefused) {
    const std::vector<std::string> bad = {"",
                                          "/a",
                                          "../a",
                                          "a/../b",
                                          "a/..",
                                          "..",
                                          ".",
                                          "./a",
                                          "a/./b",
                                          "a//b",
                                          "a/",
                                          "a\\b",
                                          "C:\\a",
                                          std::string("a\0b", 3),
                                          std::string(1025, 'a')};
    for (const std::string& path : bad)
        expect_refused(manifest({"root.gltf", path}, {"root.gltf"}), "plain relative path");
}

TEST(Manifest, PlainPathsArePassed) {
    const std::vector<std::string> good = {
        "a", "a.b/c..d", "...", "..a/b..", " ", "\xc3\xa4/\xe6\x97\xa5", std::string(1024, 'a')};
    for (const std::string& path : good)
        EXPECT_TRUE(normalised(manifest({path}, {path}))) << path;
}

TEST(Manifest, AFileOrRootThatStandsTwiceIsRefused) {
    expect_refused(manifest({"a", "b", "a"}, {"a"}), "'a' stands twice");
    expect_refused(manifest({"a", "b"}, {"b", "a", "b"}), "'b' stands twice");
}

TEST(Manifest, RootsMustBeAmongTheFiles) {
    expect_refused(manifest({"a"}, {}), "names no glTF file");
    expect_refused(manifest({}, {}), "names no glTF file");
    expect_refused(manifest({"a"}, {"a", "b"}), "'b'");
}

TEST(Manifest, OrderDoesNotMatterAndContentDoes) {
    Manifest made = manifest({"b", "a", "c/d"}, {"b", "a"});
    const std::string bytes = encode_manifest(*normalised(made));
    std::reverse(made.files.begin(), made.files.end());
    std::reverse(made.roots.begin(), made.roots.end());
    EXPECT_EQ(encode_manifest(*normalised(made)), bytes);
    made.files[0].digest = digest_of("other");
    EXPECT_NE(encode_manifest(*normalised(made)), bytes);
}

TEST(Manifest, IsReadAsItWasWritten) {
    const Manifest made = *normalised(manifest({"b", "a \"quoted\"", "\xc3\xa4"}, {"b"}));
    const auto read = decode_manifest(encode_manifest(made));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->roots, made.roots);
    ASSERT_EQ(read->files.size(), 3u);
    for (std::size_t n = 0; n < 3; ++n) {
        EXPECT_EQ(read->files[n].path, made.files[n].path);
        EXPECT_EQ(read->files[n].digest, made.files[n].digest);
        EXPECT_EQ(read->files[n].size_bytes, 12);
    }
}

TEST(Manifest, EveryPrefixIsDataLoss) {
    const std::string bytes = encode_manifest(manifest({"a"}, {"a"}));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const auto read = decode_manifest(bytes.substr(0, size));
        ASSERT_FALSE(read) << size;
        EXPECT_EQ(read.error().code, ErrorCode::data_loss);
    }
    for (const char* odd :
         {"null", "[]", "7", R"({"roots":[]})", R"({"roots":7,"files":[]})",
          R"({"roots":[],"files":[{"path":"a","sha256":"00","size":1}]})", R"({"roots":[],"files":[7]})"})
        EXPECT_FALSE(decode_manifest(odd)) << odd;
}

TEST(ManifestSource, SaysWhichFileIsMissingLostOrDamaged) {
    const test::TemporaryFolder folder;
    const auto store = std::move(*BlobStore::open(folder.path()));
    ASSERT_TRUE(store->put(test::bytes_of("here")));
    const auto source = manifest_source(manifest({"here", "gone"}, {"here"}), *store);
    EXPECT_EQ(source("here").value(), test::bytes_of("here"));
    EXPECT_NE(source("elsewhere").error().sentence.find("'elsewhere' is missing"), std::string::npos);
    EXPECT_NE(source("gone").error().sentence.find("'gone' is lost"), std::string::npos);
}

}  // namespace
}  // namespace drtv::store
