// Sectors sent to a cluster that fails in all the ways in which clusters fail.
#include "bakerd/executor/dispatcher.h"
#include "tests/executor/scripted_cluster.h"
#include "tests/store/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

namespace drtv::executor {
namespace {

using namespace std::chrono_literals;
using test::bytes_of;
using test::ScriptedCluster;
namespace fs = std::filesystem;

constexpr int exit_differs = 9;

class DispatcherTest : public testing::Test {
  protected:
    DispatcherTest() : blobs(store::BlobStore::open(folder.path() + "/blobs").value()) { start(); }

    // As a daemon that starts; it asks for what has not been finished.
    void start(std::size_t asked_again = 0) {
        DispatchOptions options;
        options.store_folder = folder.path();
        options.owner = "me";
        options.task_command = {"/opt/bakerd", "task"};
        options.differs_status = exit_differs;
        options.clock = [this] { return now; };
        Executor::Callbacks callbacks;
        callbacks.next = [this](Priority priority) -> std::optional<SectorTask> {
            const auto found = std::ranges::find(queue, priority, &SectorTask::priority);
            if (found == queue.end())
                return std::nullopt;
            SectorTask task = *found;
            queue.erase(found);
            return task;
        };
        callbacks.finished = [this](SectorEnd end) {
            EXPECT_TRUE(ends.emplace(end.id, std::move(end)).second) << end.id << " ended twice";
        };
        callbacks.give_up = [this](std::uint64_t id) { return unwanted.contains(id); };
        callbacks.is_recorded = [this](std::uint64_t) { return is_recording; };
        dispatcher.emplace(
            Dispatcher::open(std::move(options), cluster, *blobs, std::move(callbacks)).value());
        add(asked_again);
    }

    static worker::BakeRequest request(std::uint64_t id) {
        return {{}, {static_cast<std::int32_t>(id), 0}, {}, {}};
    }
    // Ids count from 0 after each start.
    void add(std::size_t count, double seconds = 1, Priority priority = Priority::nightly) {
        for (std::size_t n = 0; n < count; ++n, ++added)
            queue.push_back({added, request(added), priority, seconds});
    }
    void restart() {
        std::deque<std::uint64_t> left;
        for (std::uint64_t id = 0; id < added; ++id) {
            if (!ends.contains(id))
                left.push_back(id);
        }
        queue.clear();
        start();
        for (const std::uint64_t id : left)
            queue.push_back({id, request(id), Priority::nightly, 1});
    }

    // Steps until nothing is due for that long.
    void pass(std::chrono::milliseconds time) {
        const auto end = now + time;
        for (auto due = dispatcher->step(); now < end; due = dispatcher->step())
            now = std::min(std::max(due, now + 100ms), end);
    }

    worker::SectorResult result(const worker::BakeRequest& baked) {
        worker::SectorResult result;
        const Digest blob = blobs->put(bytes_of(fmt::format("sector {}", baked.sector.i))).value();
        result.blobs = {blob, blob, blob};
        result.probes = 7;
        result.seconds = 3;
        return result;
    }
    // What a task that works leaves behind.
    void answer(std::size_t task) {
        for (const worker::BakeRequest& baked : cluster.batch(task))
            answer(baked, result(baked));
        cluster.set(task, TaskState::done);
    }
    void answer(const worker::BakeRequest& baked, decltype(worker::TaskAnswer::what) what) {
        ASSERT_TRUE(answers.write(worker::answer_key(baked),
                                  {std::move(what), "node3", "logs/x/1.log", 3 << 20, load_s}));
    }
    // Of tasks from that one on, while the array is open; the queue says nothing of it.
    void answer_sectors(const ClusterArray& array, std::size_t from = 0) {
        for (std::size_t task = from; task < array.tasks; ++task) {
            const auto batch = worker::read_batch(test::file_of(array), task);
            if (!batch)
                return;  // it is closed
            for (const worker::BakeRequest& baked : batch->sectors)
                answer(baked, result(baked));
        }
    }
    void answer_all() {
        for (std::size_t task = 0; task < cluster.arrays.back().tasks; ++task)
            answer(task);
    }
    [[nodiscard]] std::set<std::int32_t> sectors_of_last_array() const {
        std::set<std::int32_t> sectors;
        for (std::size_t task = 0; task < cluster.arrays.back().tasks; ++task) {
            for (const worker::BakeRequest& baked : cluster.batch(task))
                sectors.insert(baked.sector.i);
        }
        return sectors;
    }
    [[nodiscard]] std::size_t files(const std::string& part) const {
        return test::files_below(folder.path() + "/" + part);
    }
    void expect_all_baked() const {
        EXPECT_EQ(ends.size(), added);
        for (const auto& [id, end] : ends)
            EXPECT_TRUE(end.reply) << id << ": " << end.reply.error().sentence;
    }
    [[nodiscard]] std::string sentence(std::uint64_t id) const {
        const auto found = ends.find(id);
        return found == ends.end() || found->second.reply ? "" : found->second.reply.error().sentence;
    }

    const test::TemporaryFolder folder;
    std::unique_ptr<store::BlobStore> blobs;
    ScriptedCluster cluster;
    Dispatcher::Time now = Dispatcher::Time(1000s);
    const worker::Answers answers = worker::Answers::open(folder.path()).value();

    std::deque<SectorTask> queue;
    std::uint64_t added = 0;
    std::map<std::uint64_t, SectorEnd> ends;
    bool is_recording = true;
    std::set<std::uint64_t> unwanted;
    double load_s = 0;  // of tasks' answers
    std::optional<Dispatcher> dispatcher;
};

TEST_F(DispatcherTest, SectorsBecomeBatchesAndTheirAnswersEnds) {
    add(200, 10);
    pass(2s);
    ASSERT_EQ(cluster.arrays.size(), 1u);
    const ClusterArray& array = cluster.arrays[0];
    EXPECT_EQ(sectors_of_last_array().size(), 200u);
    EXPECT_GE(array.tasks, 12u) << "2000 s on eight threads";
    EXPECT_LE(cluster.batch(0).size(), 18u) << "90 s on two threads";
    std::int32_t next = 0;
    for (std::size_t task = 0; task < array.tasks; ++task) {
        for (const worker::BakeRequest& baked : cluster.batch(task))
            EXPECT_EQ(baked.sector.i, next++) << "neighbours stay together";
    }
    EXPECT_GT(cluster.batch(0).size(), cluster.batch(array.tasks - 1).size()) << "smaller at the end";
    EXPECT_EQ(array.threads, 2);
    EXPECT_TRUE(fs::is_directory(array.log_folder));
    EXPECT_EQ(files("arrays"), 1u);
    cluster.set_all(TaskState::running);
    pass(1h);
    EXPECT_TRUE(ends.empty());
    answer(0);
    pass(2s);
    EXPECT_EQ(ends.size(), cluster.batch(0).size());
    EXPECT_EQ(ends.begin()->second.node, "node3");
    EXPECT_EQ(ends.begin()->second.log, "logs/x/1.log");
    for (std::size_t task = 1; task < array.tasks; ++task)
        answer(task);
    pass(10s);
    expect_all_baked();
    EXPECT_EQ(cluster.arrays.size(), 1u);
    EXPECT_EQ(files("arrays"), 0u);
    EXPECT_EQ(files("answers"), 200u) << "a task that runs twice finds them";
    pass(2min);
    EXPECT_EQ(files("answers"), 0u);
    EXPECT_TRUE(cluster.cancelled.empty() && cluster.cancelled_tasks.empty());
}

TEST_F(DispatcherTest, TheQueueIsAskedEveryFiveSecondsAndOnlyWhileArraysAreOpen) {
    pass(10min);
    EXPECT_EQ(cluster.lists, 0);
    add(10);
    pass(10min);
    EXPECT_GE(cluster.lists, 110);
    EXPECT_LE(cluster.lists, 121);
}

TEST_F(DispatcherTest, WhatSectorsCostIsLearntFromAFew) {
    add(1000, 0);
    pass(30s);
    ASSERT_EQ(cluster.arrays.size(), 1u);
    EXPECT_EQ(cluster.arrays[0].tasks, 4u);
    EXPECT_EQ(cluster.batch(0).size(), 4u) << "two for each thread: it loads the map once";
    EXPECT_EQ(cluster.arrays[0].memory_bytes, 0);
    answer(0);
    pass(2s);
    ASSERT_EQ(cluster.arrays.size(), 2u);
    EXPECT_EQ(cluster.batch(0).size(), 60u) << "of 3 s each, 90 s on two threads";
    EXPECT_EQ(cluster.arrays[1].memory_bytes, 256 << 20) << "its peak was 3 MiB";
}

TEST_F(DispatcherTest, ATaskThatLoadsALargeMapBakesForLonger) {
    load_s = 30;
    add(50'000, 0);
    pass(2s);
    answer(0);
    pass(2s);
    ASSERT_EQ(cluster.arrays.size(), 2u);
    EXPECT_EQ(cluster.batch(0).size(), 160u) << "of 3 s each, 240 s on two threads";
}

// So that all nodes have work when the costs are known.
TEST_F(DispatcherTest, AnArrayOfAJobThatIsNewFillsTheCluster) {
    add(50'000, 0);
    pass(2s);
    EXPECT_EQ(cluster.arrays[0].tasks, 4u);
    EXPECT_GT(queue.size(), 48'000u);
    answer(0);
    pass(2s);
    ASSERT_EQ(cluster.arrays.size(), 2u);
    EXPECT_EQ(cluster.arrays[1].tasks, 16u);
    EXPECT_EQ(cluster.batch(15).size(), 60u);
}

TEST_F(DispatcherTest, FewSectorsOfUnknownCostAreSpreadOverAllNodes) {
    add(9, 0);
    pass(2s);
    EXPECT_EQ(cluster.arrays[0].tasks, 4u);
    EXPECT_EQ(cluster.batch(0).size(), 2u);
}

// Of another map, or with other settings.
TEST_F(DispatcherTest, SectorsOfUnknownCostDoNotHoldTheOthersUp) {
    add(300, 10);
    add(60, 0);
    pass(5s);
    ASSERT_EQ(cluster.arrays.size(), 2u);
    EXPECT_EQ(sectors_of_last_array().size(), 16u) << "a pilot, of which two for each thread";
    EXPECT_EQ(*sectors_of_last_array().begin(), 300) << "of those whose cost is not known";
    EXPECT_GE(cluster.arrays[0].tasks, 16u);
    answer_all();
    pass(15s);
    EXPECT_EQ(ends.size(), 16u);
    ASSERT_EQ(cluster.arrays.size(), 3u) << "the first array is still at work";
    EXPECT_EQ(sectors_of_last_array().size(), 44u);
}

TEST_F(DispatcherTest, TheNextDaemonGoesOnWithTheArrays) {
    add(40, 10);
    pass(2s);
    cluster.set_all(TaskState::running);
    answer(0);
    pass(2s);
    const std::size_t done = ends.size();
    answer(1);
    restart();
    pass(10s);
    EXPECT_EQ(ends.size(), done + cluster.batch(1).size()) << "its answer came while nobody looked";
    answer_all();
    pass(10s);
    expect_all_baked();
    EXPECT_EQ(cluster.arrays.size(), 1u);
    EXPECT_EQ(files("arrays"), 0u);
}

// Found by a review: what a task of the earlier run had, and will not answer, is nobody's.
TEST_F(DispatcherTest, ATaskThatDiedBeforeItsSectorsWereAskedForAgainLeavesNoneBehind) {
    add(40, 10);
    pass(2s);
    cluster.set_all(TaskState::running);
    const auto batch = cluster.batch(0);
    restart();
    std::deque<SectorTask> later = std::exchange(queue, {});
    pass(10s);
    cluster.set(0, TaskState::lost);
    pass(20s);
    queue = std::move(later);
    pass(10s);
    ASSERT_EQ(cluster.arrays.size(), 2u);
    EXPECT_EQ(sectors_of_last_array().size(), batch.size());
    answer_all();
    answer_sectors(cluster.arrays[0], 1);
    pass(10s);
    expect_all_baked();
}

// Between the array's file and sbatch.
TEST_F(DispatcherTest, AnArrayThatTheClusterNeverHeardOfGoesAgain) {
    add(40, 10);
    pass(2s);
    const std::string key = cluster.arrays[0].key;
    cluster.forget_all();
    restart();
    pass(10s);
    EXPECT_EQ(cluster.arrays.size(), 1u) << "it may be on its way";
    pass(10s);
    ASSERT_EQ(cluster.arrays.size(), 2u);
    EXPECT_NE(cluster.arrays[1].key, key);
    EXPECT_FALSE(fs::exists(test::file_of(cluster.arrays[0]))) << "should it come after all, its tasks end";
    EXPECT_EQ(sectors_of_last_array().size(), 40u);
}

TEST_F(DispatcherTest, AnArrayThatWasTakenInSpiteOfAFailureIsFound) {
    cluster.refusal = Refusal{"sbatch was not done after 20000 ms", false};
    cluster.takes_refused = true;
    add(40);
    pass(10min);
    EXPECT_EQ(cluster.arrays.size(), 1u);
    cluster.refusal.reset();
    answer_all();
    pass(10s);
    expect_all_baked();
}

TEST_F(DispatcherTest, ARefusedArrayGoesAgainMoreAndMoreSlowly) {
    cluster.refusal = Refusal{"sbatch ended with status 1: Unable to contact slurm controller", false};
    add(40);
    pass(10min);
    EXPECT_GE(cluster.arrays.size(), 8u);
    EXPECT_LE(cluster.arrays.size(), 40u);
    EXPECT_TRUE(ends.empty()) << "that is no fault of the sectors";
    cluster.refusal.reset();
    pass(2min);
    answer_all();
    pass(10s);
    expect_all_baked();
    EXPECT_EQ(files("arrays"), 0u);
}

TEST_F(DispatcherTest, AnArrayThatIsTooLargeIsHalved) {
    cluster.refusal =
        Refusal{"sbatch: error: Batch job submission failed: Invalid job array specification", true};
    add(100, 100);
    pass(2s);
    const std::size_t first = cluster.arrays.back().tasks;
    pass(1min);
    ASSERT_GE(cluster.arrays.size(), 2u);
    EXPECT_EQ(cluster.arrays[1].tasks, first / 2);
    pass(10min);
    EXPECT_EQ(cluster.arrays.back().tasks, 1u);
    cluster.refusal.reset();
    // It grows again.
    std::size_t largest = 0;
    for (int n = 0; n < 40 && ends.size() < added; ++n) {
        pass(2min);
        for (const ClusterArray& array : cluster.arrays)
            answer_sectors(array);
        largest = std::max(largest, cluster.arrays.back().tasks);
    }
    pass(10s);
    expect_all_baked();
    EXPECT_GE(largest, first / 4);
}

TEST_F(DispatcherTest, ASilentQueueMeansNothing) {
    add(40);
    pass(2s);
    cluster.set_all(TaskState::running);
    pass(10s);
    cluster.is_silent = true;
    pass(2h);
    EXPECT_EQ(cluster.arrays.size(), 1u);
    answer(0);
    pass(5s);
    EXPECT_EQ(ends.size(), cluster.batch(0).size()) << "answers count without it";
}

TEST_F(DispatcherTest, AnArrayThatTheControllerLostGoesAgain) {
    add(40);
    pass(2s);
    cluster.set_all(TaskState::running);
    answer(0);
    pass(10s);
    const std::size_t done = ends.size();
    cluster.forget_all();
    pass(20s);
    ASSERT_EQ(cluster.arrays.size(), 2u);
    EXPECT_EQ(sectors_of_last_array().size(), 40 - done);
    // Not for ever.
    for (int n = 0; n < 20; ++n) {
        cluster.forget_all();
        pass(1min);
    }
    EXPECT_EQ(cluster.arrays.size(), 10u);
    EXPECT_EQ(ends.size(), added);
    EXPECT_NE(sentence(39).find("the cluster lost its tasks"), std::string::npos) << sentence(39);
}

TEST_F(DispatcherTest, ANumberThatWasGivenTwiceDoesNotEndATask) {
    add(40);
    pass(2s);
    cluster.set_all(TaskState::running);
    // The older array of this name is remembered as failed.
    ClusterTask other = cluster.tasks.begin()->second;
    other.state = TaskState::done;
    other.exit_status = 1;
    other.job = "7";
    cluster.tasks[{other.key, 1000 + other.number}] = other;
    pass(10min);
    EXPECT_EQ(cluster.arrays.size(), 1u);
}

TEST_F(DispatcherTest, TheSectorsOfATaskThatFailedGoAloneAndFailAtLast) {
    add(40, 10);
    pass(2s);
    const auto batch = cluster.batch(1);
    ASSERT_GE(batch.size(), 3u);
    const auto guilty = static_cast<std::uint64_t>(batch[2].sector.i);
    test::write_file(cluster.arrays[0].log_folder + "/1.log", "one line\n2026-11-28 error it burnt\n");
    for (std::size_t task = 0; task < cluster.arrays[0].tasks; ++task) {
        if (task != 1)
            answer(task);
    }
    answer(batch[0], result(batch[0]));
    cluster.set(1, TaskState::done, 134);
    pass(20s);
    ASSERT_EQ(cluster.arrays.size(), 2u);
    EXPECT_EQ(cluster.arrays[1].tasks, batch.size() - 1) << "each alone";
    for (std::size_t task = 0; task < cluster.arrays[1].tasks; ++task) {
        if (cluster.batch(task)[0].sector == batch[2].sector)
            cluster.set(task, TaskState::done, 134);
        else
            answer(task);
    }
    pass(20s);
    ASSERT_EQ(cluster.arrays.size(), 3u);
    EXPECT_EQ(ends.size(), 39u);
    cluster.set_all(TaskState::done, 134);
    test::write_file(cluster.arrays[2].log_folder + "/0.log", "2026-11-28 error it burnt\n");
    pass(20s);
    EXPECT_EQ(cluster.arrays.size(), 3u);
    ASSERT_EQ(ends.size(), 40u);
    const std::string why = sentence(guilty);
    for (const char* part : {"node1", "SOME STATE", "134", "it burnt", "tried 3 times"})
        EXPECT_NE(why.find(part), std::string::npos) << why;
    EXPECT_EQ(ends.at(guilty).failed_attempts, 3);
    EXPECT_EQ(ends.at(guilty).node, "node1");
    EXPECT_EQ(ends.at(guilty).log, fmt::format("logs/{}/0.log", cluster.arrays[2].key));
}

TEST_F(DispatcherTest, AFailureThatATaskAnsweredIsFinal) {
    add(1);
    pass(2s);
    answer(cluster.batch(0)[0], worker::RequestFailure{"no such map", false});
    pass(10s);
    EXPECT_EQ(sentence(0), "no such map");
    EXPECT_EQ(cluster.arrays.size(), 1u);
}

TEST_F(DispatcherTest, AnAnswerMayComeAfterTheEndOfItsTask) {
    add(4);
    pass(2s);
    const auto late = cluster.batch(0);
    cluster.set_all(TaskState::done);
    pass(50s);
    EXPECT_EQ(cluster.arrays.size(), 1u) << "over NFS a folder may look as it was for a minute";
    answer_all();
    pass(10s);
    expect_all_baked();
}

TEST_F(DispatcherTest, ANodeOfAnotherBuildIsLeftOut) {
    add(40);
    pass(2s);
    test::write_file(cluster.arrays[0].log_folder + "/0.log",
                     "bakerd: the array was made by a build of abc\n");
    cluster.set(0, TaskState::done, exit_differs);
    const std::size_t sectors = cluster.batch(0).size();
    pass(20s);
    ASSERT_EQ(cluster.arrays.size(), 2u);
    EXPECT_EQ(cluster.arrays[1].excluded_nodes, std::set<std::string>{"node1"});
    EXPECT_EQ(sectors_of_last_array().size(), sectors);
    EXPECT_LT(cluster.arrays[1].tasks, sectors) << "no fault of theirs: they need not go alone";
    // When none is left, waiting helps nobody.
    for (ClusterNode& node : cluster.cluster.nodes)
        node.is_up = node.name == "node1";
    pass(1min);
    add(1, 1, Priority::interactive);
    pass(5s);
    EXPECT_EQ(ends.size(), 0u) << "the others may come back";
    cluster.cluster.nodes.resize(1);
    pass(1min);
    add(3);
    pass(5s);
    EXPECT_NE(sentence(42).find("no node may bake"), std::string::npos) << sentence(42);
    EXPECT_NE(sentence(42).find("build of abc"), std::string::npos) << sentence(42);
    // It was mended.
    pass(15min);
    add(1, 1, Priority::interactive);
    pass(5s);
    EXPECT_EQ(cluster.arrays.size(), 4u);
}

// It draws all tasks that wait, and bakes none.
TEST_F(DispatcherTest, ANodeThatEndsAllTasksAtOnceIsLeftOut) {
    add(400, 10);
    pass(2s);
    cluster.set_all(TaskState::done, 127);
    pass(20s);
    ASSERT_EQ(cluster.arrays.size(), 2u);
    EXPECT_EQ(cluster.arrays[1].excluded_nodes, std::set<std::string>{"node1"});
    EXPECT_EQ(sectors_of_last_array().size(), 400u);
    EXPECT_LT(cluster.arrays[1].tasks, 100u) << "only those of the first two tasks go alone";
    answer_all();
    pass(10s);
    expect_all_baked();
}

TEST_F(DispatcherTest, LostPreemptedAndCancelledTasksGoAgainTogether) {
    for (const TaskState state : {TaskState::lost, TaskState::cancelled}) {
        add(20);
        pass(2s);
        const std::size_t arrays = cluster.arrays.size();
        const std::size_t tasks = cluster.arrays.back().tasks;
        cluster.set_all(state);
        pass(20s);
        ASSERT_EQ(cluster.arrays.size(), arrays + 1);
        EXPECT_EQ(cluster.arrays.back().tasks, tasks);
        answer_all();
        pass(20s);
        expect_all_baked();
    }
}

TEST_F(DispatcherTest, WhoCancelsByHandThreeTimesMeansIt) {
    add(20);
    for (int n = 0; n < 5; ++n) {
        pass(20s);
        cluster.set_all(TaskState::cancelled);
    }
    EXPECT_EQ(cluster.arrays.size(), 3u);
    EXPECT_EQ(ends.size(), 20u);
}

TEST_F(DispatcherTest, MoreMemoryIsAskedForAfterTooLittle) {
    add(1);
    pass(2s);
    cluster.set_all(TaskState::out_of_memory);
    pass(20s);
    ASSERT_EQ(cluster.arrays.size(), 2u);
    const std::int64_t second = cluster.arrays[1].memory_bytes;
    EXPECT_GT(second, std::int64_t{1} << 30);
    cluster.set_all(TaskState::out_of_memory);
    pass(20s);
    ASSERT_EQ(cluster.arrays.size(), 3u);
    EXPECT_GT(cluster.arrays[2].memory_bytes, second);
    EXPECT_LE(cluster.arrays[2].memory_bytes, std::int64_t{8} << 30) << "no node has more";
}

TEST_F(DispatcherTest, TasksOfADeadNodeAreLetGoAndHeldOnesThreeTimes) {
    add(20);
    pass(2s);
    cluster.set_all(TaskState::running);
    pass(10s);
    cluster.set(0, TaskState::delayed);
    pass(1min);
    EXPECT_EQ(std::ranges::count(cluster.nudged, cluster.arrays[0].key + " 0"), 0)
        << "its node lives, and would drop it";
    cluster.cluster.nodes[0].is_up = false;
    cluster.set(1, TaskState::held);
    pass(1min);
    const std::string& key = cluster.arrays[0].key;
    EXPECT_GE(std::ranges::count(cluster.nudged, key + " 0"), 10);
    EXPECT_EQ(dispatcher->state().tasks_lost, 2u);
    EXPECT_NE(dispatcher->state().trouble.find("a task is held"), std::string::npos)
        << dispatcher->state().trouble;
    EXPECT_EQ(dispatcher->state().nodes_up, 3u);
    EXPECT_EQ(dispatcher->state().tasks_running, cluster.arrays[0].tasks - 2);
    EXPECT_EQ(std::ranges::count(cluster.nudged, key + " 1"), 3) << "who holds it again means it";
    EXPECT_EQ(std::ranges::count(cluster.nudged, key + " 2"), 0);
}

TEST_F(DispatcherTest, WhatNobodyWantsIsCancelled) {
    add(40, 10);
    pass(2s);
    cluster.set_all(TaskState::running);
    const auto batch = cluster.batch(0);
    for (const worker::BakeRequest& baked : batch)
        unwanted.insert(static_cast<std::uint64_t>(baked.sector.i));
    pass(20s);
    EXPECT_EQ(cluster.cancelled_tasks, std::vector<std::string>{cluster.arrays[0].key + " 0"});
    for (std::uint64_t id = 0; id < added; ++id)
        unwanted.insert(id);
    pass(10s);
    EXPECT_EQ(cluster.cancelled, std::vector<std::string>{cluster.arrays[0].key});
    EXPECT_TRUE(ends.empty());
    EXPECT_EQ(files("arrays"), 0u);
}

TEST_F(DispatcherTest, InteractiveSectorsDoNotWaitForTheNight) {
    add(60'000, 90);
    pass(10s);
    EXPECT_EQ(cluster.arrays.size(), 2u);
    EXPECT_EQ(cluster.arrays[0].tasks, 16u) << "four nodes";
    EXPECT_GT(queue.size(), 50'000u) << "what is not taken up yet may be overtaken";
    add(9, 10, Priority::interactive);
    pass(2s);
    ASSERT_EQ(cluster.arrays.size(), 3u);
    EXPECT_EQ(cluster.arrays[2].priority, Priority::interactive);
    EXPECT_EQ(sectors_of_last_array().size(), 9u);
    EXPECT_GE(cluster.arrays[2].tasks, 4u) << "on all nodes";
    answer_all();
    pass(2s);
    EXPECT_EQ(ends.size(), 9u);
}

TEST_F(DispatcherTest, ARefusedNightDoesNotHoldAnArtistUp) {
    cluster.refusal = Refusal{"sbatch: error: AssocMaxSubmitJobLimit", true};
    add(1000, 100);
    pass(3min);
    cluster.refusal.reset();
    const std::size_t before = cluster.arrays.size();
    add(8, 1, Priority::interactive);
    pass(2s);
    ASSERT_GT(cluster.arrays.size(), before);
    EXPECT_EQ(cluster.arrays[before].priority, Priority::interactive);
    EXPECT_EQ(sectors_of_last_array().size(), 8u);
}

// They are listed every few seconds: those of an array that runs for an hour would be many.
TEST_F(DispatcherTest, AnswersOfTasksThatAreDoneLeaveBeforeTheirArrayEnds) {
    add(1000, 100);
    pass(2s);
    const std::size_t sectors = cluster.batch(0).size();
    answer(0);
    answer(cluster.batch(1).front(), result(cluster.batch(1).front()));
    pass(30s);
    EXPECT_EQ(files("answers"), sectors + 1);
    is_recording = false;
    pass(1min);
    EXPECT_EQ(files("answers"), sectors + 1) << "the database has not taken them";
    is_recording = true;
    pass(5s);
    EXPECT_EQ(files("answers"), 1u) << "a task that runs twice finds it";
    EXPECT_GE(files("arrays"), 1u);

    // The next daemon does not take that task for lost.
    restart();
    cluster.set_all(TaskState::running);
    cluster.set(0, TaskState::done);
    pass(2min);
    EXPECT_EQ(dispatcher->state().tasks_lost, 0u);
}

TEST_F(DispatcherTest, ARefusalIsForgottenWithWhatWasRefused) {
    cluster.refusal = Refusal{"sbatch: error: AssocMaxSubmitJobLimit", false};
    add(4);
    pass(1min);
    EXPECT_EQ(dispatcher->state().trouble, "sbatch: error: AssocMaxSubmitJobLimit");
    for (std::uint64_t id = 0; id < added; ++id)
        unwanted.insert(id);
    pass(1min);
    EXPECT_EQ(dispatcher->state().trouble, "");
}

// By nodes that are shut down, and by sites that watch over memory.
TEST_F(DispatcherTest, TasksThatAreEndedByTermAgainAndAgainAreTriedAlone) {
    add(4);
    for (int n = 0; n < 3; ++n) {
        pass(20s);
        cluster.set_all(TaskState::lost, 128 + SIGTERM);
    }
    pass(20s);
    EXPECT_EQ(cluster.arrays.back().tasks, 4u);
}

TEST_F(DispatcherTest, AnAnswerWhoseFilesWereEvictedIsBakedAgain) {
    add(1);
    pass(2s);
    const worker::BakeRequest baked = cluster.batch(0)[0];
    worker::SectorResult gone = result(baked);
    gone.blobs.file = map::digest_of(bytes_of("nowhere"));
    answer(baked, gone);
    cluster.set_all(TaskState::done);
    pass(5s);
    EXPECT_TRUE(ends.empty());
    ASSERT_EQ(cluster.arrays.size(), 2u);
    answer(0);
    pass(5s);
    expect_all_baked();
}

TEST_F(DispatcherTest, AnAnswerThatIsThereAlreadyServes) {
    answer(request(0), result(request(0)));
    add(1);
    pass(5s);
    expect_all_baked();
    EXPECT_TRUE(cluster.arrays.empty());
}

TEST_F(DispatcherTest, ADamagedAnswerIsBakedAgain) {
    const std::string hex = to_hex(worker::answer_key(request(0)));
    fs::create_directories(folder.path() + "/answers/" + hex.substr(0, 2));
    test::write_file(folder.path() + "/answers/" + hex.substr(0, 2) + "/" + hex, "{\"id\":");
    add(1);
    pass(5s);
    ASSERT_EQ(cluster.arrays.size(), 1u);
    answer(0);
    pass(5s);
    expect_all_baked();
}

TEST_F(DispatcherTest, AnArrayThatCannotBeReadNowIsLeftAlone) {
    add(4);
    pass(2s);
    const std::string file = test::file_of(cluster.arrays.back());
    fs::rename(file, folder.path() + "/away");
    fs::create_directory(file);
    DispatchOptions options;
    options.store_folder = folder.path();
    options.owner = "me";
    const auto opened = Dispatcher::open(std::move(options), cluster, *blobs, {});
    ASSERT_FALSE(opened);
    EXPECT_NE(opened.error().message.find(file), std::string::npos) << opened.error().message;
    EXPECT_TRUE(cluster.cancelled.empty());
    EXPECT_TRUE(fs::exists(file));
}

TEST_F(DispatcherTest, ArraysOfAnotherBuildAreCancelled) {
    const ArrayFolder arrays = ArrayFolder::open(folder.path(), "me").value();
    ASSERT_TRUE(arrays.write("drtv-old", {{1, "old", "vax"}, {{request(0)}}}));
    test::write_file(arrays.path_of("drtv-broken"), "x");
    restart();
    pass(5s);
    std::ranges::sort(cluster.cancelled);
    EXPECT_EQ(cluster.cancelled, (std::vector<std::string>{"drtv-broken", "drtv-old"}));
    EXPECT_EQ(files("arrays"), 0u);
}

TEST_F(DispatcherTest, TwoThatWantTheSameAreServedByOneTask) {
    add(1);
    queue.push_back({1, request(0), Priority::nightly, 1});
    ++added;
    pass(2s);
    EXPECT_EQ(sectors_of_last_array().size(), 1u);
    queue.push_back({2, request(0), Priority::nightly, 1});
    ++added;
    pass(2s);
    answer(0);
    pass(5s);
    expect_all_baked();
    EXPECT_EQ(cluster.arrays.size(), 1u);
}

TEST_F(DispatcherTest, AStoreThatIsFullIsWaitedFor) {
    const std::string arrays = folder.path() + "/arrays/me";
    fs::remove_all(arrays);
    test::write_file(arrays, "");
    add(3);
    pass(1min);
    EXPECT_TRUE(cluster.arrays.empty());
    EXPECT_TRUE(ends.empty());
    fs::remove(arrays);
    fs::create_directories(arrays + "/tmp");
    pass(2min);
    ASSERT_FALSE(cluster.arrays.empty());
    answer_all();
    pass(5s);
    expect_all_baked();
}

}  // namespace
}  // namespace drtv::executor
