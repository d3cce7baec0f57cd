// The table of references that end-to-end tests read too, and how a map is found on a disk.
#include "map_files/reference.h"

#include "bakerd/map/import.h"
#include "map_files/local_map.h"
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <filesystem>
#include <fstream>

#include <sys/stat.h>
#include <unistd.h>

namespace drtv::test {
namespace {

namespace fs = std::filesystem;
using map_files::LocalMap;
using Names = std::vector<std::string>;

Json cases() {
    std::ifstream file(DRTV_SOURCE_DIR "/tests/map_files/references.json");
    return Json::parse(file);
}

GltfBuilder lawn() {
    GltfBuilder b;
    b.place(ground(4));
    return b;
}

// Through the importer, which reads the buffer that the uri names.
TEST(References, TableHoldsForTheImporter) {
    const GltfBuilder b = lawn();
    for (const Json& one : cases()) {
        SCOPED_TRACE(one.dump());
        const auto document = one["document"].get<std::string>();
        Files files = {{document, bytes_of(b.gltf(one["uri"]))}};
        if (one.contains("file"))
            files[one["file"]] = b.bin;
        // What must not be read is there: only the rule keeps it out.
        for (const char* bait : {"../data.bin", "/etc/hostname", "C:/data.bin", "pictures\\data.bin", "."})
            files[bait] = b.bin;
        const auto map = map::import_map(
            Names{document}, [&](const std::string& path) -> tl::expected<FileBytes, map::FileFailure> {
                const auto found = files.find(path);
                if (found == files.end())
                    return tl::unexpected(map::FileFailure{"the file '" + path + "' is missing", true});
                return found->second;
            });
        if (one.contains("file"))
            EXPECT_EQ(expect_accepted(map).objects.size(), 1u);
        else
            expect_refused(map, {document + ": buffer 0: ", one["refused"]});
    }
}

// A file that is there but cannot be read is not passed over for the other spelling.
TEST(References, LostFileIsNoMissingFile) {
    const GltfBuilder b = lawn();
    const auto map = map::import_map(
        Names{"map.gltf"}, [&](const std::string& path) -> tl::expected<FileBytes, map::FileFailure> {
            if (path == "map.gltf")
                return bytes_of(b.gltf("a%20b.bin"));
            if (path == "a b.bin")
                return tl::unexpected(map::FileFailure{"the file 'a b.bin' is lost"});
            return b.bin;
        });
    expect_refused(map, {"buffer 0: the file 'a b.bin' is lost"});
}

TEST(References, PathsOfTheContractAreInTheirShortestForm) {
    for (const char* path : {"map.gltf", "a/b.bin", "100%.bin", "地図.bin", "a:b.bin"})
        EXPECT_TRUE(map_files::check_path(path)) << path;
    for (const char* path : {"", "./a", "a//b", "a/../b", "../a", "/a", "a/", "a\\b", "\xFF"})
        EXPECT_FALSE(map_files::check_path(path)) << path;
}

TEST(References, DocumentsAreKnownByTheirEnding) {
    for (const char* name : {"a.gltf", "a.glb", "WEST.GLB", "a.GlTf", ".glb"})
        EXPECT_TRUE(map_files::is_document_name(name)) << name;
    for (const char* name : {"a.bin", "glb", "a.glb.bak", "a.gltf~", "", "a."})
        EXPECT_FALSE(map_files::is_document_name(name)) << name;
}

class LocalMaps : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("drtv_local_map_" + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write(const std::string& name) {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << "x";
    }
    LocalMap find(const Names& names) {
        Names arguments;
        for (const std::string& name : names)
            arguments.push_back((folder_ / name).string());
        auto map = LocalMap::find(arguments);
        EXPECT_TRUE(map) << map.error();
        return map.value_or(LocalMap());
    }

    fs::path folder_;
};

TEST_F(LocalMaps, FolderGivesDocumentsOfEitherCase) {
    for (const char* name : {"WEST.GLB", "east.glb", "notes.txt", "sub/below.glb"})
        write(name);
    for (const char* name : {".#lock.glb", "a.glb", "z.glb"})
        fs::create_symlink("nowhere", folder_ / name);
    EXPECT_EQ(find({""}).documents(), (Names{"WEST.GLB", "east.glb"}));
    EXPECT_EQ(find({"east.glb", "sub/below.glb"}).documents(), (Names{"east.glb", "sub/below.glb"}));
}

TEST_F(LocalMaps, SameDocumentIsThereOnce) {
    write("east.glb");
    const LocalMap map = find({"east.glb", "", "./east.glb"});
    EXPECT_EQ(map.documents(), Names{"east.glb"});
    EXPECT_EQ(map.repeated().size(), 2u);
}

TEST_F(LocalMaps, LinkFindsItsCompanionsBesideItAndBesideItsTarget) {
    for (const char* name :
         {"store/v7.gltf", "store/far.bin", "store/both.bin", "work/near.bin", "work/both.bin"})
        write(name);
    fs::create_symlink("../store/v7.gltf", folder_ / "work/map.gltf");
    const LocalMap map = find({"work/map.gltf"});
    EXPECT_EQ(map.documents(), Names{"map.gltf"});
    EXPECT_EQ(map.on_disk("near.bin"), fs::canonical(folder_ / "work/near.bin"));
    EXPECT_EQ(map.on_disk("far.bin"), fs::canonical(folder_ / "store/far.bin"));
    EXPECT_EQ(map.on_disk("both.bin"), fs::canonical(folder_ / "work/both.bin"));
    EXPECT_FALSE(map.on_disk("gone.bin"));
}

TEST_F(LocalMaps, LinkedFolderIsAFolder) {
    for (const char* name : {"store/map.gltf", "store/map.bin"})
        write(name);
    fs::create_directory_symlink("store", folder_ / "link");
    EXPECT_EQ(find({"link"}).documents(), Names{"map.gltf"});
    EXPECT_TRUE(find({"link/map.gltf"}).on_disk("map.bin"));
}

TEST_F(LocalMaps, WhatIsNoMapIsTold) {
    write("notes/a.txt");
    ASSERT_EQ(::mkfifo((folder_ / "pipe.glb").c_str(), 0600), 0);
    fs::create_symlink("nowhere", folder_ / "broken.glb");
    for (const auto& [name, sentence] :
         std::vector<std::pair<std::string, std::string>>{{"gone.glb", "does not exist"},
                                                          {"broken.glb", "does not exist"},
                                                          {"notes", "holds no .glb or .gltf file"},
                                                          {"pipe.glb", "is not a regular file"}}) {
        const auto map = LocalMap::find(Names{(folder_ / name).string()});
        expect_refused(map, {name, sentence});
    }
    expect_refused(LocalMap::find(Names{""}), {"does not exist"});
}

}  // namespace
}  // namespace drtv::test
