// Batches of sectors as tasks of a cluster bake them, beside the worker that the daemon asks.
#include "bakerd/store/manifest.h"
#include "bakerd/worker/answers.h"
#include "bakerd/worker/array_file.h"
#include "bakerd/worker/run_batch.h"
#include "bakerd/worker/worker.h"
#include "tests/map/gltf_builder.h"
#include "tests/store/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace drtv::worker {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;

const std::vector<map::SectorCoordinate> sectors = {{-1, -1}, {0, -1}, {-1, 0}, {0, 0}};

BakeRequest request(map::SectorCoordinate sector, const Digest& manifest = {}) {
    BakeRequest bake;
    bake.manifest = manifest;
    bake.sector = sector;
    bake.settings.bake.rays = 16;
    bake.settings.bake.bounces = 1;
    return bake;
}

// The lawn of those four sectors, in a store.
Digest put_lawn(const std::string& store_folder) {
    test::GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(test::ground(40)), .role = "static"});
    const std::string gltf = b.gltf();
    auto blobs = std::move(*store::BlobStore::open(store_folder + "/blobs"));
    const Digest file = blobs->put(bytes_of(gltf)).value();
    const std::string manifest = store::encode_manifest(
        {{{"lawn.gltf", file, static_cast<std::int64_t>(gltf.size())}}, {"lawn.gltf"}});
    return blobs->put(bytes_of(manifest)).value();
}

void write_array(const std::string& path, const ArrayFile& array) {
    std::ofstream(path, std::ios::binary) << encode(array);
}

class BatchTest : public testing::Test {
  protected:
    BatchTest() : manifest(put_lawn(folder.path())), answers(Answers::open(folder.path()).value()) {
        ArrayFile array{this_build(), {{}, {}}};
        for (std::size_t n = 0; n < sectors.size(); ++n)
            array.batches[n / 3].push_back(request(sectors[n], manifest));
        write_array(options.array, array);
    }

    [[nodiscard]] std::vector<Digest> keys(std::size_t count = sectors.size()) const {
        std::vector<Digest> keys;
        for (std::size_t n = 0; n < count; ++n)
            keys.push_back(answer_key(request(sectors[n], manifest)));
        std::ranges::sort(keys);
        return keys;
    }

    const test::TemporaryFolder folder;
    const Digest manifest;
    const Answers answers;
    BatchOptions options{folder.path(), folder.path() + "/array", 0, 2, "node7", "logs/7"};
};

TEST_F(BatchTest, TasksBakeWhatAWorkerBakes) {
    ASSERT_TRUE(run_batch(options));
    EXPECT_EQ(answers.among(keys()), keys(3)) << "a task bakes its own batch";
    options.task = 1;
    ASSERT_TRUE(run_batch(options));
    EXPECT_EQ(answers.among(keys()), keys());

    const test::TemporaryFolder other;
    const Digest same = put_lawn(other.path());
    ASSERT_EQ(same, manifest);
    const auto worker = Worker::open(other.path() + "/blobs").value();
    for (const map::SectorCoordinate& sector : sectors) {
        const auto answer = answers.read(answer_key(request(sector, manifest)));
        ASSERT_TRUE(answer);
        EXPECT_EQ(answer->node, "node7");
        EXPECT_EQ(answer->log, sector == sectors[3] ? "logs/7/1.log" : "logs/7/0.log");
        EXPECT_GT(answer->peak_memory_bytes, 1 << 20);
        EXPECT_GT(answer->load_seconds, 0);
        EXPECT_LT(answer->load_seconds, 100);
        const auto& baked = std::get<SectorResult>(answer->what);
        const auto asked = worker->answer({0, request(sector, manifest)});
        const auto& expected = std::get<SectorResult>(asked.what);
        EXPECT_EQ(baked.blobs.file, expected.blobs.file);
        EXPECT_EQ(baked.blobs.footprint, expected.blobs.footprint);
        EXPECT_EQ(baked.probes, expected.probes);
        EXPECT_GT(baked.probes, 0);
    }
}

TEST_F(BatchTest, WhatHasAnAnswerIsLeftAlone) {
    const Digest key = answer_key(request(sectors[1], manifest));
    ASSERT_TRUE(answers.write(key, {RequestFailure{"from before", false}, "node1", "", 0}));
    ASSERT_TRUE(run_batch(options));
    const auto kept = answers.read(key);
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->node, "node1");
    EXPECT_EQ(answers.read(answer_key(request(sectors[0], manifest)))->node, "node7");
}

TEST_F(BatchTest, AMapThatCannotBeImportedIsAnAnswer) {
    auto blobs = std::move(*store::BlobStore::open(folder.path() + "/blobs"));
    const Digest file = blobs->put(bytes_of("no map")).value();
    const std::string broken = store::encode_manifest({{{"a.gltf", file, 6}}, {"a.gltf"}});
    const BakeRequest lost = request({0, 0}, blobs->put(bytes_of(broken)).value());
    write_array(options.array, {this_build(), {{lost}}});
    ASSERT_TRUE(run_batch(options));
    const auto answer = answers.read(answer_key(lost));
    ASSERT_TRUE(answer);
    EXPECT_FALSE(std::get<RequestFailure>(answer->what).sentence.empty());
}

TEST_F(BatchTest, AFailureThatMayPassIsNoAnswer) {
    // Files stand where most folders of blobs would.
    for (int n = 0; n < 256; ++n) {
        const std::string path = fmt::format("{}/blobs/objects/{:02x}", folder.path(), n);
        if (!fs::exists(path))
            test::write_file(path, "");
    }
    const auto ran = run_batch(options);
    ASSERT_FALSE(ran);
    EXPECT_NE(ran.error().sentence.find("blobs/objects"), std::string::npos) << ran.error().sentence;
    EXPECT_TRUE(answers.among(keys()).empty());
}

TEST_F(BatchTest, AnotherBuildOrMachineIsRefusedInASentence) {
    const auto refused = [&](const auto& change) {
        ArrayFile array{this_build(), {{request({0, 0}, manifest)}}};
        change(array.build);
        write_array(options.array, array);
        const auto ran = run_batch(options);
        EXPECT_EQ(ran.has_value(), ran || !ran.error().differs);
        return ran ? std::string() : ran.error().sentence;
    };
    EXPECT_EQ(refused([](BuildId&) {}), "");
    EXPECT_NE(refused([](BuildId& build) { build.baker_version = 99; }).find("baker version 99"),
              std::string::npos);
    EXPECT_NE(refused([](BuildId& build) { build.commit = "abc"; }).find("is a build of abc"),
              std::string::npos);
    EXPECT_NE(refused([](BuildId& build) { build.isa_class = "vax"; }).find("class vax"), std::string::npos);
}

TEST_F(BatchTest, AStoreThatCannotBeWrittenIsASentence) {
    options.store_folder = "/proc/drtv";
    const auto ran = run_batch(options);
    ASSERT_FALSE(ran);
    EXPECT_NE(ran.error().sentence.find("/proc/drtv"), std::string::npos) << ran.error().sentence;
}

TEST(AnswerKey, IsOfTheAnswerAlone) {
    const BakeRequest one = request({0, 0});
    BakeRequest other = one;
    other.earlier = ResultBlobs{map::digest_of(bytes_of("a")), {}, {}};
    EXPECT_EQ(answer_key(one), answer_key(other));
    other = one;
    other.settings.bake.rays = 17;
    EXPECT_NE(answer_key(one), answer_key(other));
    EXPECT_NE(answer_key(one), answer_key(request({0, 1})));
    EXPECT_NE(answer_key(one), answer_key(request({0, 0}, map::digest_of(bytes_of("b")))));
}

TEST(Answers, WhatIsDamagedIsNone) {
    const test::TemporaryFolder folder;
    const Answers answers = Answers::open(folder.path()).value();
    const Digest key = map::digest_of(bytes_of("key"));
    EXPECT_FALSE(answers.read(key));
    SectorResult result;
    result.probes = 7;
    result.warnings = {"one", "two"};
    ASSERT_TRUE(answers.write(key, {result, "node", "log", 12}));
    const std::string path = folder.path() + "/answers/" + to_hex(key).substr(0, 2) + "/" + to_hex(key);
    std::ifstream file(path);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    for (std::size_t size = 0; size + 1 < text.size(); ++size) {
        test::write_file(path, text.substr(0, size));
        EXPECT_FALSE(answers.read(key)) << size;
    }
    test::write_file(path, text);
    EXPECT_EQ(std::get<SectorResult>(answers.read(key)->what).warnings, result.warnings);
    answers.remove(std::span(&key, 1));
    EXPECT_TRUE(answers.among(std::span(&key, 1)).empty());
}

TEST(ArrayFile, IsReadWholeAndByTask) {
    const test::TemporaryFolder folder;
    const ArrayFile array{{6, "abc", "avx2"},
                          {{request({0, 0}), request({-3, 5})}, {}, {request({70000, -70000})}}};
    const std::string text = encode(array), path = folder.path() + "/array";
    test::write_file(path, text);
    const auto whole = decode_array(text);
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->build, array.build);
    ASSERT_EQ(whole->batches.size(), 3u);
    for (std::size_t task = 0; task < 3; ++task) {
        const auto batch = read_batch(path, task);
        ASSERT_TRUE(batch) << batch.error();
        EXPECT_EQ(batch->build, array.build);
        ASSERT_EQ(batch->sectors.size(), array.batches[task].size());
        for (std::size_t n = 0; n < batch->sectors.size(); ++n) {
            EXPECT_EQ(answer_key(batch->sectors[n]), answer_key(array.batches[task][n]));
            EXPECT_EQ(answer_key(whole->batches[task][n]), answer_key(array.batches[task][n]));
        }
    }
    EXPECT_NE(read_batch(path, 3).error().find("no task 3"), std::string::npos);
    EXPECT_NE(read_batch(path + "x", 0).error().find(path), std::string::npos);
}

TEST(ArrayFile, AnyPrefixAndAnyChangedByteIsDefined) {
    const test::TemporaryFolder folder;
    const std::string text = encode(ArrayFile{{6, "abc", "avx2"}, {{request({0, 0})}, {request({1, 0})}}});
    const std::string path = folder.path() + "/array";
    for (std::size_t size = 0; size < text.size(); ++size) {
        test::write_file(path, text.substr(0, size));
        EXPECT_FALSE(decode_array(text.substr(0, size))) << size;
        EXPECT_FALSE(read_batch(path, 1)) << size;
    }
    for (std::size_t at = 0; at < text.size(); ++at) {
        std::string changed = text;
        changed[at] = static_cast<char>(changed[at] ^ 1);
        test::write_file(path, changed);
        static_cast<void>(decode_array(changed));
        static_cast<void>(read_batch(path, 1));
    }
    // More than there is, or than any memory holds.
    for (const char* end : {"100000", "18446744073709551615"}) {
        test::write_file(path,
                         fmt::format("{{\"version\":1,\"baker_version\":6,\"commit\":\"abc\",\"isa_class\":"
                                     "\"avx2\",\"ends\":[{}]}}\nx\n",
                                     end));
        ASSERT_FALSE(read_batch(path, 0));
        EXPECT_NE(read_batch(path, 0).error().find("cut off"), std::string::npos);
    }
}

}  // namespace
}  // namespace drtv::worker
