// The farm with the real worker on a map of four sectors.
#include "bakerd/farm/farm.h"
#include "tests/store/temporary_folder.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace drtv::farm {
namespace {

using namespace std::chrono_literals;
using test::bytes_of;

constexpr auto long_enough = 300s;  // ends a hang; under a sanitizer all takes long

std::string base64(const std::vector<std::uint8_t>& bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t n = 0; n < bytes.size(); n += 3) {  // REQUIRES: a multiple of 3
        const unsigned group =
            static_cast<unsigned>(bytes[n]) << 16 | static_cast<unsigned>(bytes[n + 1]) << 8 | bytes[n + 2];
        for (int shift = 18; shift >= 0; shift -= 6)
            text += digits[group >> shift & 63];
    }
    return text;
}

// A quad on the ground, world [1, size - 1] squared at this height, as it stands in a file.
std::string ground_gltf(float size, float height = 0) {
    const float low = 1, high = size - 1;
    const float positions[] = {low,  height, -low,  high, height, -low,
                               high, height, -high, low,  height, -high};
    const std::uint16_t indices[] = {0, 1, 2, 0, 2, 3};
    std::vector<std::uint8_t> bytes(sizeof positions + sizeof indices);
    std::memcpy(bytes.data(), positions, sizeof positions);
    std::memcpy(bytes.data() + sizeof positions, indices, sizeof indices);
    return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"scene":0,"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[)" +
           std::to_string(low) + "," + std::to_string(height) + "," + std::to_string(-high) + R"(],"max":[)" +
           std::to_string(high) + "," + std::to_string(height) + "," + std::to_string(-low) +
           R"(]},{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],
        "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
        "buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,)" +
           base64(bytes) + R"("}]})";
}

class FarmTest : public testing::Test {
  protected:
    FarmTest() {
        std::signal(SIGPIPE, SIG_IGN);
        open();
    }

    void open(std::int64_t cache_bytes = std::int64_t{1} << 30) {
        auto opened = Farm::open(
            {data(),
             {{DRTV_BINARY_DIR "/bakerd", "worker", "--blobs", data() + "/blobs", "--threads", "2"}, 2},
             cache_bytes});
        ASSERT_TRUE(opened) << opened.error().message;
        farm = std::move(*opened);
    }
    [[nodiscard]] std::string data() const { return folder.path() + "/data"; }
    [[nodiscard]] std::string object(const Digest& digest) const {
        return data() + "/blobs/objects/" + to_hex(digest).substr(0, 2) + "/" + to_hex(digest);
    }

    store::Result<MapView> create(const std::string& gltf) {
        const Digest digest = farm->blobs().put(bytes_of(gltf)).value();
        return farm->create_map(
            {{{"map.gltf", digest, static_cast<std::int64_t>(gltf.size())}}, {"map.gltf"}});
    }

    // Quick to bake; other `rays`, other results.
    static JobRequest quick(const Digest& map, int rays = 16) {
        settings::JobSettings settings;
        settings.bake = {
            .rays = static_cast<std::uint32_t>(rays), .bounces = 0, .reach_m = 8, .min_distance_m = 16};
        return {.manifest = map, .preset = "draft", .settings = settings, .region = {}};
    }
    // Several seconds per sector.
    static JobRequest endless(const Digest& map) {
        settings::JobSettings settings;
        settings.bake = {.rays = 65536, .bounces = 8, .min_distance_m = 1};
        return {.manifest = map, .preset = "draft", .settings = settings, .region = {}};
    }

    JobView submit(const JobRequest& request) {
        auto job = farm->create_job(request);
        EXPECT_TRUE(job) << job.error().message;
        return job.value();
    }

    JobView wait(
        std::int64_t id, const std::function<bool(const JobView&)>& enough = [](const JobView& view) {
            return view.row.state != JobState::running;
        }) {
        const auto end = std::chrono::steady_clock::now() + long_enough;
        JobView view = farm->get_job(id).value();
        while (!enough(view) && std::chrono::steady_clock::now() < end)
            view = farm->wait_for_change(id, view.version, 500ms).value();
        EXPECT_TRUE(enough(view)) << "job " << id << " hangs at " << view.row.sectors_done << " of "
                                  << view.row.sectors_total;
        return view;
    }

    void expect_succeeded(const JobView& view, std::int64_t sectors) {
        EXPECT_EQ(view.row.state, JobState::succeeded) << view.row.error;
        EXPECT_EQ(std::tuple(view.row.sectors_total, view.row.sectors_done, view.row.sectors_failed),
                  std::tuple(sectors, sectors, 0));
        EXPECT_GT(view.row.probes, 0);
        EXPECT_GE(view.row.ended_ms, view.row.created_ms);
    }

    std::vector<JobSectorView> sectors(std::int64_t job) {
        return farm->list_sectors(job, std::nullopt, 1000).value();
    }
    std::vector<Digest> results(std::int64_t job) {
        std::vector<Digest> found;
        const std::vector<JobSectorView> all = sectors(job);
        for (const JobSectorView& sector : all)
            found.push_back(sector.row.file);
        return found;
    }

    test::TemporaryFolder folder;
    std::unique_ptr<Farm> farm;
};

TEST_F(FarmTest, AMapIsImportedOnceAndFoundAgain) {
    const auto map = create(ground_gltf(128));
    ASSERT_TRUE(map) << map.error().message;
    EXPECT_EQ(map->summary.sectors, (std::vector<map::SectorCoordinate>{{0, 0}, {1, 0}, {0, 1}, {1, 1}}));
    EXPECT_EQ(std::tuple(map->summary.survey.static_objects, map->summary.survey.triangles),
              std::tuple(1, 2));
    EXPECT_EQ(create(ground_gltf(128))->id, map->id);
    EXPECT_EQ(farm->get_map(map->id)->summary.content, map->summary.content);
    EXPECT_NE(create(ground_gltf(128, 1))->id, map->id);
    EXPECT_EQ(farm->get_map(map::digest_of(bytes_of("x"))).error().code, store::ErrorCode::not_found);
}

TEST_F(FarmTest, ABadMapIsRefusedWithTheImportersSentence) {
    for (const std::string& bad :
         {std::string("not json"), std::string("{}"), std::string(R"({"asset":{"version":"1.0"}})"),
          ground_gltf(128).substr(0, 400)}) {
        const auto map = create(bad);
        ASSERT_FALSE(map) << bad;
        EXPECT_EQ(map.error().code, store::ErrorCode::invalid_argument);
        EXPECT_NE(map.error().message.find("map.gltf"), std::string::npos) << map.error().message;
        EXPECT_EQ(create(bad).error().message, map.error().message);
    }
    EXPECT_TRUE(create(ground_gltf(128)));
}

TEST_F(FarmTest, AFileThatWasNotUploadedIsNamed) {
    const auto map = farm->create_map({{{"map.gltf", map::digest_of(bytes_of("nowhere")), 7}}, {"map.gltf"}});
    ASSERT_FALSE(map);
    EXPECT_EQ(map.error().code, store::ErrorCode::failed_precondition);
    EXPECT_NE(map.error().message.find("'map.gltf'"), std::string::npos) << map.error().message;
}

TEST_F(FarmTest, AJobBakesAndAResubmitIsAllCache) {
    const Digest map = create(ground_gltf(128))->id;
    const JobView first = wait(submit(quick(map)).row.id);
    expect_succeeded(first, 4);
    EXPECT_EQ(first.row.sectors_cached, 0);
    for (const Digest& result : results(first.row.id))
        EXPECT_TRUE(farm->blobs().get(result));
    const JobView second = submit(quick(map));
    expect_succeeded(second, 4);  // at once
    EXPECT_EQ(second.row.sectors_cached, 4);
    EXPECT_EQ(results(second.row.id), results(first.row.id));
    expect_succeeded(wait(submit(quick(map, 17)).row.id), 4);  // other settings are other work
}

TEST_F(FarmTest, WrongRequestsAreRefusedAndLeaveNoJob) {
    const Digest map = create(ground_gltf(128))->id;
    JobRequest request = quick(map::digest_of(bytes_of("no map")));
    EXPECT_EQ(farm->create_job(request).error().code, store::ErrorCode::not_found);
    request = quick(map);
    request.region = JobRegion{1000, 1000, 1001, 1001};
    EXPECT_EQ(farm->create_job(request).error().code, store::ErrorCode::invalid_argument);
    request = quick(map);
    request.request_id = std::string(65, 'x');
    EXPECT_EQ(farm->create_job(request).error().code, store::ErrorCode::invalid_argument);
    EXPECT_TRUE(farm->list_jobs(INT64_MAX, 10)->empty());
    for (const std::int64_t id : {0, -1, 7}) {
        EXPECT_EQ(farm->get_job(id).error().code, store::ErrorCode::not_found);
        EXPECT_EQ(farm->cancel_job(id).error().code, store::ErrorCode::not_found);
        EXPECT_EQ(farm->wait_for_change(id, 0, 1ms).error().code, store::ErrorCode::not_found);
        EXPECT_EQ(farm->list_sectors(id, std::nullopt, 1).error().code, store::ErrorCode::not_found);
        EXPECT_EQ(farm->get_sectors(id, {{0, 0}}).error().code, store::ErrorCode::not_found);
    }
}

TEST_F(FarmTest, ARegionBakesOnlyWhatItTouches) {
    JobRequest request = quick(create(ground_gltf(128))->id);
    request.region = JobRegion{70, 0, 71, 100};
    const JobView view = wait(submit(request).row.id);
    expect_succeeded(view, 2);
    const std::vector<JobSectorView> all = sectors(view.row.id);
    EXPECT_EQ(all[0].row.sector, (map::SectorCoordinate{1, 0}));
    EXPECT_EQ(all[1].row.sector, (map::SectorCoordinate{1, 1}));
    EXPECT_TRUE(farm->get_sectors(view.row.id, {{1, 1}}));
    EXPECT_EQ(farm->get_sectors(view.row.id, {{0, 0}}).error().code, store::ErrorCode::not_found);
}

TEST_F(FarmTest, TwoJobsThatShareSectorsBakeEachOnce) {
    const Digest map = create(ground_gltf(128))->id;
    const JobView one = submit(quick(map, 4096)), two = submit(quick(map, 4096));
    const JobView first = wait(one.row.id), second = wait(two.row.id);
    expect_succeeded(first, 4);
    expect_succeeded(second, 4);
    EXPECT_EQ(results(one.row.id), results(two.row.id));
    // Both saw the same bakes: the rays of each sector once.
    std::int64_t rays = 0;
    const std::vector<JobSectorView> all = sectors(one.row.id);
    for (const JobSectorView& sector : all)
        rays += sector.row.rays;
    EXPECT_EQ(first.rays, rays);
}

TEST_F(FarmTest, TheSameRequestIdGivesTheSameJobAfterARestartToo) {
    JobRequest request = quick(create(ground_gltf(128))->id);
    request.request_id = "a request";
    const std::int64_t id = submit(request).row.id;
    EXPECT_EQ(submit(request).row.id, id);
    wait(id);
    farm.reset();
    open();
    EXPECT_EQ(submit(request).row.id, id);
    EXPECT_EQ(farm->list_jobs(INT64_MAX, 10)->size(), 1u);
}

TEST_F(FarmTest, CancelKeepsWhatIsDoneAndIsFinal) {
    const Digest map = create(ground_gltf(128))->id;
    JobRequest part = endless(map);
    const std::int64_t id = submit(part).row.id;
    const JobView cancelled = farm->cancel_job(id).value();
    EXPECT_EQ(cancelled.row.state, JobState::cancelled);
    EXPECT_EQ(farm->cancel_job(id)->row.state, JobState::cancelled);
    farm.reset();  // does not wait for the endless ones
    open();
    EXPECT_EQ(farm->get_job(id)->row.state, JobState::cancelled);

    JobRequest done = quick(map);
    done.region = JobRegion{1, 1, 1, 1};
    expect_succeeded(wait(submit(done).row.id), 1);
    const std::int64_t whole = submit(quick(map)).row.id;
    EXPECT_GE(farm->cancel_job(whole)->row.sectors_done, 1);
    const JobView again =
        wait(submit(quick(map)).row.id);  // while the cancelled one's sectors may still be at work
    expect_succeeded(again, 4);
    EXPECT_GE(again.row.sectors_cached, 1);
}

TEST_F(FarmTest, ARestartGoesOnWithTheRunningJob) {
    const Digest map = create(ground_gltf(512))->id;
    const std::int64_t id = submit(quick(map)).row.id, cancelled = submit(endless(map)).row.id;
    ASSERT_TRUE(farm->cancel_job(cancelled));
    wait(id, [](const JobView& view) { return view.row.sectors_done >= 5; });
    farm.reset();
    open();
    const JobView view = wait(id);
    expect_succeeded(view, 64);
    for (const Digest& result : results(id))
        EXPECT_TRUE(farm->blobs().has(result));
    EXPECT_EQ(test::files_below(data() + "/blobs/tmp"), 0u);
}

TEST_F(FarmTest, StopPutsBackWhatDoesNotFinish) {
    const std::int64_t id = submit(endless(create(ground_gltf(128))->id)).row.id;
    wait(id, [&](const JobView&) { return farm->get_sectors(id, {{0, 0}})->front().running; });
    farm->stop(100ms);
    farm.reset();
    open();
    EXPECT_EQ(farm->get_job(id)->row.state, JobState::running);
    EXPECT_EQ(farm->get_sectors(id, {{0, 0}})->front().row.failed_attempts, 0);
}

TEST_F(FarmTest, ALostResultIsBakedAgainOnResubmit) {
    const Digest map = create(ground_gltf(128))->id;
    const std::int64_t first = wait(submit(quick(map)).row.id).row.id;
    const std::vector<Digest> before = results(first);
    const std::vector<std::uint8_t> bytes = farm->blobs().get(before[2]).value();
    std::filesystem::remove(object(before[2]));
    const JobView again = wait(submit(quick(map)).row.id);
    expect_succeeded(again, 4);
    EXPECT_EQ(again.row.sectors_cached, 4 - std::count(before.begin(), before.end(), before[2]));
    EXPECT_EQ(results(again.row.id), before);
    EXPECT_EQ(farm->blobs().get(before[2]).value(), bytes);
}

TEST_F(FarmTest, ADamagedResultIsAMissAndIsTold) {
    const std::string gltf = ground_gltf(128);
    const std::int64_t first = wait(submit(quick(create(gltf)->id)).row.id).row.id;
    const std::vector<Digest> before = results(first);
    const std::vector<std::uint8_t> bytes = farm->blobs().get(before[2]).value();
    // The same map again, and another file of the same content.
    for (const std::string& map : {gltf, gltf + " "}) {
        test::write_file(object(before[2]), "damaged");
        const JobView again = submit(quick(create(map)->id));
        ASSERT_FALSE(again.warnings.empty());
        EXPECT_NE(again.warnings[0].find("damaged"), std::string::npos) << again.warnings[0];
        expect_succeeded(wait(again.row.id), 4);
        EXPECT_EQ(again.row.sectors_cached, 4 - std::count(before.begin(), before.end(), before[2]));
        EXPECT_EQ(results(again.row.id), before);
        EXPECT_EQ(farm->blobs().get(before[2]).value(), bytes);
    }
}

// Another file of the same content, and one of other content.
TEST_F(FarmTest, AnotherMapFindsWhatStillHolds) {
    const std::string gltf = ground_gltf(128);
    expect_succeeded(wait(submit(quick(create(gltf)->id)).row.id), 4);
    const PlanView same = farm->plan_job(quick(create(gltf + " ")->id)).value();
    EXPECT_EQ(same.plan.count(reuse::Verdict::hit), 4);
    JobRequest night = quick(create(gltf)->id);
    night.settings.tolerance = 0;
    const PlanView exact = farm->plan_job(night).value();
    EXPECT_EQ(exact.plan.count(reuse::Verdict::hit), 4);
    for (const PlannedSector& planned : exact.plan.sectors)
        EXPECT_EQ(planned.reason, "") << "there is none of a hit";
    const Digest raised = create(ground_gltf(128, 1))->id;
    const PlanView other = farm->plan_job(quick(raised)).value();
    EXPECT_EQ(other.plan.count(reuse::Verdict::rebake), 4);
    EXPECT_GT(other.seconds, 0);
    ASSERT_EQ(other.plan.changes.size(), 1u);
    for (const PlannedSector& planned : other.plan.sectors)
        EXPECT_NE(planned.reason.find(other.plan.changes[0].what), std::string::npos) << planned.reason;
    EXPECT_EQ(wait(submit(quick(raised)).row.id).row.sectors_cached, 0);
    // And back again, by the results of the first map.
    const JobView undone = submit(quick(create(gltf + "  ")->id));
    expect_succeeded(undone, 4);
    EXPECT_EQ(undone.row.sectors_cached, 4);
}

TEST_F(FarmTest, ADamagedRecordIsAMissAndIsTold) {
    const Digest map = create(ground_gltf(128))->id;
    wait(submit(quick(map)).row.id);
    // All that is no sector file and no input.
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data() + "/blobs/objects")) {
        if (!entry.is_regular_file())
            continue;
        std::ifstream file(entry.path(), std::ios::binary);
        char first[4] = {};
        file.read(first, 4);
        if (std::memcmp(first, "\x28\xB5\x2F\xFD", 4) == 0)
            std::ofstream(entry.path(), std::ios::binary) << "damaged";
    }
    const Digest raised = create(ground_gltf(128, 1))->id;
    const JobView job = submit(quick(raised));
    ASSERT_FALSE(job.warnings.empty());
    EXPECT_NE(job.warnings[0].find("cannot be used"), std::string::npos) << job.warnings[0];
    expect_succeeded(wait(job.row.id), 4);
}

TEST_F(FarmTest, TheCacheKeepsToItsLimit) {
    const Digest map = create(ground_gltf(512))->id;
    const JobView first = wait(submit(quick(map)).row.id);
    const CacheView all = farm->cache().value();
    EXPECT_EQ(all.counts.results, 64);
    EXPECT_EQ(all.counts.baked, 64);
    farm.reset();
    open(all.counts.bytes / 2);
    const JobView second = wait(submit(quick(map, 17)).row.id);
    expect_succeeded(second, 64);
    for (const Digest& result : results(second.row.id))
        EXPECT_TRUE(farm->blobs().has(result)) << "needed by a job that was running";
    // When nobody holds them any more, the next sector makes room.
    JobRequest corner = quick(map, 18);
    corner.region = JobRegion{1, 1, 1, 1};
    wait(submit(corner).row.id);
    const CacheView left = farm->cache().value();
    EXPECT_LE(left.counts.bytes, left.limit_bytes);
    EXPECT_GT(left.counts.results, 0);
    std::size_t kept = 0;
    for (const Digest& result : results(first.row.id))
        kept += farm->blobs().has(result) ? 1u : 0u;
    EXPECT_EQ(kept, 0u) << "those used longest ago go first";
    EXPECT_EQ(farm->clear_cache()->counts.results, 0);
    expect_succeeded(wait(submit(quick(map)).row.id), 64);
}

// The case: a job that still runs has counted a sector, another job asks for it anew.
TEST_F(FarmTest, ASectorAskedForAnewIsNotCountedTwiceByARunningJob) {
    const Digest map = create(ground_gltf(512))->id;
    const std::int64_t first = submit(quick(map, 2048)).row.id;
    wait(first, [](const JobView& view) { return view.row.sectors_done >= 2; });
    const std::vector<JobSectorView> all = sectors(first);
    for (const JobSectorView& sector : all) {
        if (sector.row.state == SectorState::done)
            std::filesystem::remove(object(sector.row.file));
    }
    ASSERT_EQ(farm->get_job(first)->row.state, JobState::running) << "too quick for this test";
    const std::int64_t second = submit(quick(map, 2048)).row.id;
    // Neither ends before all 64 are there.
    expect_succeeded(wait(first), 64);
    expect_succeeded(wait(second), 64);
    for (const Digest& result : results(first))
        EXPECT_TRUE(farm->blobs().has(result));
}

TEST_F(FarmTest, AFailedSectorFailsTheJobAndAResubmitGivesItAnotherChance) {
    const std::string gltf = ground_gltf(512);
    const Digest map = create(gltf)->id, file = map::digest_of(bytes_of(gltf));
    // A new worker has to import again, and cannot.
    farm.reset();
    open();
    std::filesystem::remove(object(file));
    JobRequest corner = quick(map, 2048);
    corner.region = JobRegion{1, 1, 1, 1};
    const JobView failed = wait(submit(corner).row.id);
    EXPECT_EQ(failed.row.state, JobState::failed);
    EXPECT_NE(failed.row.error.find("1 of 1 sectors failed; sector (0, 0): "), std::string::npos)
        << failed.row.error;
    EXPECT_NE(failed.row.error.find("'map.gltf' is lost"), std::string::npos) << failed.row.error;
    ASSERT_TRUE(create(gltf));  // uploads it again
    expect_succeeded(wait(submit(corner).row.id), 1);
}

TEST_F(FarmTest, JobsAreListedNewestFirstInPages) {
    JobRequest request = quick(create(ground_gltf(64))->id);
    std::vector<std::int64_t> ids;
    for (int n = 0; n < 7; ++n)
        ids.insert(ids.begin(), submit(request).row.id);
    std::vector<std::int64_t> seen;
    std::int64_t before = INT64_MAX;
    for (;;) {
        const auto page = farm->list_jobs(before, 3).value();
        if (page.empty())
            break;
        for (const JobView& view : page)
            seen.push_back(view.row.id);
        before = seen.back();
    }
    EXPECT_EQ(seen, ids);
    EXPECT_TRUE(farm->list_jobs(0, 3)->empty());
    EXPECT_TRUE(farm->list_jobs(INT64_MIN, 3)->empty());
}

TEST_F(FarmTest, AMapWithoutGroundSucceedsAtOnceWithNothing) {
    const auto map =
        create(R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"name":"empty"}]})");
    ASSERT_TRUE(map) << map.error().message;
    const JobView view = submit(quick(map->id));
    EXPECT_EQ(view.row.state, JobState::succeeded);
    EXPECT_EQ(view.row.sectors_total, 0);
}

TEST_F(FarmTest, OneFolderHasOneFarm) {
    const auto second = Farm::open({data(), {{"/bin/false"}, 1}});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, store::ErrorCode::failed_precondition);
}

}  // namespace
}  // namespace drtv::farm
