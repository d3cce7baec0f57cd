#include "bakerd/executor/local_executor.h"
#include "tests/executor/fake_worker.h"
#include "tests/store/temporary_folder.h"

#include <gtest/gtest.h>

#include <csignal>
#include <ctime>
#include <set>
#include <thread>

namespace drtv::executor {
namespace {

using namespace std::chrono_literals;
namespace fake = test::fake;

constexpr auto long_enough = 300s;  // ends a hang; under a sanitizer all takes long

// A queue of sectors before the executor and a book of their outcomes behind it.
class LocalExecutorTest : public testing::Test {
  protected:
    LocalExecutorTest() { std::signal(SIGPIPE, SIG_IGN); }

    void start(std::vector<std::string> command, int threads = 2) {
        LocalExecutor::Callbacks callbacks;
        callbacks.next = [this](Priority priority) -> std::optional<SectorTask> {
            const std::lock_guard lock(mutex);
            const auto found = std::ranges::find(queue, priority, &SectorTask::priority);
            if (found == queue.end())
                return std::nullopt;
            const SectorTask request = *found;
            queue.erase(found);
            changed.notify_all();
            return request;
        };
        callbacks.finished = [this](SectorEnd end) {
            const std::lock_guard lock(mutex);
            EXPECT_TRUE(outcomes.emplace(end.id, std::pair(end.failed_attempts, std::move(end.reply))).second)
                << end.id << " finished twice";
            changed.notify_all();
        };
        executor = std::make_unique<LocalExecutor>(
            LocalExecutor::Options{std::move(command), threads, stall_limit}, std::move(callbacks));
    }
    void start_fake(const std::string& mode, int threads = 2) { start({DRTV_FAKE_WORKER, mode}, threads); }

    // A sector that the worker treats so; its id is its place in the order of adding, from 0.
    void add(std::int32_t behaviour, Priority priority = Priority::interactive) {
        const std::lock_guard lock(mutex);
        const auto id = static_cast<std::uint64_t>(added++);
        queue.push_back({id, {{}, {behaviour, static_cast<std::int32_t>(id)}, {}, {}}, priority});
    }

    bool wait_for_all() {
        executor->wake();
        std::unique_lock lock(mutex);
        return changed.wait_for(lock, long_enough, [&] { return outcomes.size() == added; });
    }

    // Until `count` sectors have left the queue: they are in flight or done, however slow the machine.
    void wait_until_taken(std::size_t count) {
        executor->wake();
        std::unique_lock lock(mutex);
        ASSERT_TRUE(changed.wait_for(lock, long_enough, [&] { return added - queue.size() == count; }));
    }

    void expect_baked(std::uint64_t id) {
        const auto& baked = outcomes.at(id).second;
        ASSERT_TRUE(baked) << "sector " << id;
        EXPECT_EQ(baked->probes, static_cast<std::int64_t>(id));
    }
    void expect_failed(std::uint64_t id, int attempts, const std::string& with) {
        const auto& reply = outcomes.at(id).second;
        ASSERT_FALSE(reply) << "sector " << id;
        EXPECT_EQ(outcomes.at(id).first, attempts);
        EXPECT_NE(reply.error().sentence.find(with), std::string::npos) << reply.error().sentence;
    }

    std::chrono::milliseconds stall_limit = std::chrono::minutes(30);
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<SectorTask> queue;                                                   // guarded by mutex
    std::map<std::uint64_t, std::pair<int, Reply<worker::SectorResult>>> outcomes;  // guarded by mutex
    std::size_t added = 0;                                                          // guarded by mutex
    std::unique_ptr<LocalExecutor> executor;  // last: its thread uses the above
};

TEST_F(LocalExecutorTest, SectorsAreBakedAndEachAnswerFindsItsOwn) {
    start_fake("normal");
    for (int n = 0; n < 200; ++n)
        add(fake::good);
    ASSERT_TRUE(wait_for_all());
    for (std::uint64_t id = 0; id < 200; ++id)
        expect_baked(id);
    for (int n = 0; n < 5; ++n)
        add(fake::good);  // and again after a rest
    EXPECT_TRUE(wait_for_all());
}

TEST_F(LocalExecutorTest, AnswersMayComeInAnyOrder) {
    start({DRTV_FAKE_WORKER, "reverse", "6"}, 4);
    for (int n = 0; n < 60; ++n)
        add(fake::good);
    ASSERT_TRUE(wait_for_all());
    for (std::uint64_t id = 0; id < 60; ++id)
        expect_baked(id);
}

// It goes to the worker, which begins it when the next thread is free.
TEST_F(LocalExecutorTest, AnInteractiveSectorDoesNotWaitBehindNightlyOnes) {
    const test::TemporaryFolder folder;
    start({DRTV_FAKE_WORKER, "gate", folder.path() + "/open"}, 1);
    for (int n = 0; n < 10; ++n)
        add(fake::gated, Priority::nightly);
    wait_until_taken(3);
    add(fake::good);
    executor->wake();
    {
        std::unique_lock lock(mutex);
        EXPECT_TRUE(changed.wait_for(lock, long_enough, [&] { return outcomes.contains(10); }));
        EXPECT_EQ(queue.size(), 7u) << "what was not sent may be overtaken";
    }
    test::write_file(folder.path() + "/open", "");
    EXPECT_TRUE(wait_for_all());
}

TEST_F(LocalExecutorTest, ASectorThatKillsTheWorkerFailsAloneAfterThreeAttempts) {
    start_fake("normal", 4);
    for (int n = 0; n < 40; ++n)
        add(n == 7 || n == 8 || n == 30 ? fake::deadly : fake::good);
    ASSERT_TRUE(wait_for_all());
    for (std::uint64_t id = 0; id < 40; ++id) {
        if (id == 7 || id == 8 || id == 30)
            expect_failed(id, max_attempts, "signal 9");
        else
            expect_baked(id);
    }
}

TEST_F(LocalExecutorTest, AWorkerThatQuitsSaysItsStatus) {
    start_fake("normal");
    add(fake::quits);
    ASSERT_TRUE(wait_for_all());
    expect_failed(0, max_attempts, "status 3");
}

TEST_F(LocalExecutorTest, ARetryableFailureIsTriedAgainAndAHopelessOneIsNot) {
    start_fake("normal");
    add(fake::fails_once);
    add(fake::always_later);
    add(fake::hopeless);
    add(fake::good);
    ASSERT_TRUE(wait_for_all());
    expect_baked(0);
    EXPECT_EQ(outcomes.at(0).first, 1);
    expect_failed(1, max_attempts, "the disk is full");
    expect_failed(2, 0, "the sector is bad");
    expect_baked(3);
}

TEST_F(LocalExecutorTest, AnswersToNobodyAreIgnored) {
    start_fake("normal");
    for (int n = 0; n < 10; ++n)
        add(n % 2 == 0 ? fake::unknown_id : fake::twice);
    ASSERT_TRUE(wait_for_all());
    for (std::uint64_t id = 0; id < 10; ++id)
        expect_baked(id);
}

TEST_F(LocalExecutorTest, AWorkerThatNeverLivesFailsEachSectorWithAReason) {
    for (const auto& [mode, reason] :
         {std::pair("die_at_start", "status 4"), std::pair("garbage", "signal 9"),
          std::pair("close_output", "signal 9")}) {
        start_fake(mode);
        added = 0;
        outcomes.clear();
        for (int n = 0; n < 5; ++n)
            add(fake::good);
        ASSERT_TRUE(wait_for_all()) << mode;
        for (std::uint64_t id = 0; id < 5; ++id)
            expect_failed(id, max_attempts, reason);
        executor.reset();
    }
}

TEST_F(LocalExecutorTest, AWorkerThatCannotBeStartedIsSaid) {
    start({"/no/such/program"});
    add(fake::good);
    ASSERT_TRUE(wait_for_all());
    expect_failed(0, max_attempts, "no worker could be started");
}

TEST_F(LocalExecutorTest, InspectionsAreAnsweredWhileSectorsWait) {
    start_fake("normal");
    for (int n = 0; n < 50; ++n)
        add(fake::good);
    executor->wake();
    map::Digest manifest;
    manifest.bytes[5] = 77;
    auto answer = executor->inspect({manifest});
    ASSERT_EQ(answer.wait_for(long_enough), std::future_status::ready);
    EXPECT_EQ(answer.get().value().content, manifest);
    EXPECT_TRUE(wait_for_all());
}

TEST_F(LocalExecutorTest, AMapThatKillsTheWorkerFailsWithAReason) {
    start_fake("normal");
    map::Digest manifest;
    manifest.bytes[0] = fake::deadly_map;
    for (int n = 0; n < 10; ++n)
        add(fake::good);
    auto answer = executor->inspect({manifest});
    ASSERT_EQ(answer.wait_for(long_enough), std::future_status::ready);
    const auto reply = answer.get();
    ASSERT_FALSE(reply);
    EXPECT_NE(reply.error().sentence.find("signal 9"), std::string::npos);
    ASSERT_TRUE(wait_for_all());
    for (std::uint64_t id = 0; id < 10; ++id)
        expect_baked(id);
}

TEST_F(LocalExecutorTest, AnInspectionThatMustWaitCostsNoTime) {
    start_fake("normal", 1);
    map::Digest silent;
    silent.bytes[0] = fake::silent_map;
    std::vector<std::future<Reply<worker::MapSummary>>> before_it;
    for (int n = 0; n < 3; ++n)
        before_it.push_back(executor->inspect({silent}));  // the window is full, for ever
    auto answer = executor->inspect({{}});
    const std::clock_t before = std::clock();
    EXPECT_EQ(answer.wait_for(500ms), std::future_status::timeout);
    EXPECT_LT(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC,
              0.1);  // 0.2 to 0.5 when the thread spins
    executor.reset();
    EXPECT_EQ(answer.wait_for(0s), std::future_status::ready);
}

TEST_F(LocalExecutorTest, TheDestructorAnswersPendingInspections) {
    start_fake("normal", 1);
    map::Digest silent;
    silent.bytes[0] = fake::silent_map;
    std::vector<std::future<Reply<worker::MapSummary>>> answers;
    for (int n = 0; n < 6; ++n)
        answers.push_back(executor->inspect({silent}));
    std::this_thread::sleep_for(100ms);
    executor.reset();
    for (auto& answer : answers) {
        ASSERT_EQ(answer.wait_for(0s), std::future_status::ready);
        const auto reply = answer.get();
        ASSERT_FALSE(reply);
        EXPECT_EQ(reply.error().sentence, "the server is stopping");
        EXPECT_TRUE(reply.error().may_retry);
    }
}

TEST_F(LocalExecutorTest, StopWaitsForWhatIsInFlightAndStartsNothing) {
    const test::TemporaryFolder folder;
    const std::string gate = folder.path() + "/gate";
    start({DRTV_FAKE_WORKER, "gate", gate}, 1);
    for (int n = 0; n < 20; ++n)
        add(fake::gated);
    wait_until_taken(3);  // the window
    std::thread stopping([&] { executor->stop(long_enough); });
    // A question is refused from the moment on that the stop has begun; the gate opens only then.
    while (executor->inspect({{}}).wait_for(2ms) != std::future_status::ready) {
    }
    {
        const std::lock_guard lock(mutex);
        EXPECT_TRUE(outcomes.empty());
    }
    test::write_file(gate, "open");
    stopping.join();
    EXPECT_EQ(outcomes.size(), 3u);
    EXPECT_EQ(queue.size(), 17u);
}

TEST_F(LocalExecutorTest, StopRightAfterAWakeLosesNothing) {
    for (int round = 0; round < 30; ++round) {
        start_fake("normal", 2);
        for (int n = 0; n < 8; ++n)
            add(fake::good);
        executor->wake();
        std::this_thread::sleep_for(std::chrono::microseconds(100 * round));
        executor->stop(10s);
        executor.reset();
        EXPECT_EQ(outcomes.size() + queue.size(), added) << "in flight after the stop";
        queue.clear();
        added = outcomes.size();
    }
}

TEST_F(LocalExecutorTest, StopGivesUpAfterItsPatience) {
    start_fake("normal");
    add(fake::silent);
    wait_until_taken(1);
    const auto before = std::chrono::steady_clock::now();
    executor->stop(200ms);
    EXPECT_GE(std::chrono::steady_clock::now() - before, 190ms);
    executor.reset();
    EXPECT_TRUE(outcomes.empty());  // not reported: put back
}

TEST_F(LocalExecutorTest, SectorThatHangsTheWorkerFailsAloneAndTheRestGoesOn) {
    stall_limit = 1s;  // far above what a slow machine needs to start the worker
    start_fake("normal");
    add(fake::good);
    add(fake::silent);
    for (int n = 0; n < 10; ++n)
        add(fake::good);
    ASSERT_TRUE(wait_for_all());
    for (std::uint64_t id = 0; id < added; ++id) {
        if (id == 1)
            expect_failed(id, max_attempts, "gave no sign");
        else
            expect_baked(id);
    }
}

// More than a pipe holds, to a worker that does not read.
TEST_F(LocalExecutorTest, WorkerThatDoesNotReadHoldsNobodyUp) {
    stall_limit = 200ms;
    start_fake("deaf");
    worker::AssessRequest request;
    request.sectors.resize(10000);
    auto given_up = executor->assess(request);
    ASSERT_EQ(given_up.wait_for(long_enough), std::future_status::ready);
    EXPECT_NE(given_up.get().error().sentence.find("gave no sign"), std::string::npos);

    executor.reset();
    stall_limit = std::chrono::minutes(30);
    start_fake("deaf");
    auto refused = executor->assess(request);
    executor->stop(100ms);
    ASSERT_EQ(refused.wait_for(0s), std::future_status::ready);
    EXPECT_EQ(refused.get().error().sentence, "the server is stopping");
}

}  // namespace
}  // namespace drtv::executor
