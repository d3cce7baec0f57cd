// Programs in the place of Slurm's, which answer what Slurm does when it is ill.
#include "bakerd/executor/slurm.h"
#include "bakerd/executor/batches.h"
#include "bakerd/executor/run_command.h"
#include "bakerd/executor/slurm_text.h"
#include "tests/store/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

namespace drtv::executor {
namespace {

using namespace std::chrono_literals;

TEST(RunCommand, GivesItsOutputOrASentence) {
    EXPECT_EQ(run_command({"/bin/sh", "-c", "echo one; cat"}, 60s).value(), "one\n");
    const std::string large = run_command({"/bin/sh", "-c", "seq 1 200000; seq 1 200000 >&2"}, 60s).value();
    EXPECT_EQ(large.size(), 1288895u);
    const auto failed = run_command({"/bin/sh", "-c", "echo why >&2; exit 3"}, 60s);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error(), "/bin/sh ended with status 3: why");
    EXPECT_EQ(run_command({"/bin/sh", "-c", "kill -9 $$"}, 60s).error(),
              "/bin/sh was ended by signal 9 (Killed)");
    EXPECT_EQ(run_command({"/no/such"}, 60s).error(), "cannot start /no/such: No such file or directory");
}

// With what it started, which holds its output open.
TEST(RunCommand, EndsWhatTakesTooLong) {
    const test::TemporaryFolder folder;
    const std::string mark = folder.path() + "/mark";
    const auto begin = std::chrono::steady_clock::now();
    const auto late =
        run_command({"/bin/sh", "-c", fmt::format("(sleep 3; touch {}) & sleep 100", mark)}, 300ms);
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error(), "/bin/sh was not done after 300 ms");
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 60s);
    std::this_thread::sleep_for(3500ms);
    EXPECT_FALSE(std::filesystem::exists(mark));
    // One that closed its output and lives on.
    EXPECT_FALSE(run_command({"/bin/sh", "-c", "exec >/dev/null 2>&1; sleep 100"}, 300ms));
}

TEST(CutBatches, FillTheTimeOfABatch) {
    const std::vector<double> seconds(100, 2.0);
    BatchRule rule;
    rule.batch_s = 10;
    rule.threads = 2;
    rule.slots = 3;
    rule.is_last = false;
    const auto ends = cut_batches(seconds, rule);
    ASSERT_EQ(ends.size(), 10u);
    for (std::size_t n = 0; n < ends.size(); ++n)
        EXPECT_EQ(ends[n], 10 * (n + 1));
    rule.max_batches = 4;
    EXPECT_EQ(cut_batches(seconds, rule).back(), 40u) << "the rest waits";
}

TEST(CutBatches, BecomeSmallerTowardsTheEnd) {
    const std::vector<double> seconds(1000, 1.0);
    BatchRule rule;
    rule.batch_s = 60;
    rule.least_s = 5;
    rule.slots = 4;
    const auto ends = cut_batches(seconds, rule);
    EXPECT_EQ(ends.front(), 60u);
    EXPECT_EQ(ends.back(), 1000u);
    std::size_t last = 1000;
    for (std::size_t n = 0, begin = 0; n < ends.size(); begin = ends[n++]) {
        EXPECT_LE(ends[n] - begin, last);
        last = ends[n] - begin;
    }
    EXPECT_LE(last, 5u);
}

TEST(CutBatches, GiveEachThreadASectorAndNoSectorTwice) {
    BatchRule rule;
    rule.threads = 4;
    rule.slots = 100;
    const std::vector<double> seconds(10, 1000.0);
    EXPECT_EQ(cut_batches(seconds, rule), (std::vector<std::size_t>{4, 8, 10}));
    EXPECT_TRUE(cut_batches({}, rule).empty());
    rule.max_batches = 0;
    EXPECT_TRUE(cut_batches(seconds, rule).empty());
}

TEST(ParseTask, ReadsWhatSlurmWrites) {
    const auto running = parse_task("drtv-1|17|4|RUNNING|None|node2|0|");
    ASSERT_TRUE(running);
    EXPECT_EQ(std::tuple(running->key, running->job, running->number, running->state, running->node),
              std::tuple("drtv-1", "17", 4u, TaskState::running, "node2"));
    EXPECT_EQ(running->words, "RUNNING");
    const auto failed = parse_task("k|17|4|FAILED|NonZeroExitCode|node2|2304|");
    ASSERT_TRUE(failed);
    EXPECT_EQ(std::tuple(failed->state, failed->exit_status), std::tuple(TaskState::done, 9));
    EXPECT_EQ(parse_task("k|17|4|FAILED|None|node2|9|")->exit_status, 128 + 9);
    EXPECT_EQ(parse_task("k|17|4|FAILED|None|node2|15|")->state, TaskState::lost) << "its node is shut down";
    const auto state = [](const std::string& words) {
        return parse_task("k|17|4|" + words + "|n/a|0|").value().state;
    };
    EXPECT_EQ(state("PENDING|Resources"), TaskState::waiting);
    EXPECT_EQ(state("PENDING|BeginTime"), TaskState::delayed);
    EXPECT_EQ(state("PENDING|launch failed requeued held"), TaskState::held);
    EXPECT_EQ(state("PENDING|JobHeldUser"), TaskState::held);
    EXPECT_EQ(state("REQUEUE_HOLD|JobHoldMaxRequeue"), TaskState::held);
    EXPECT_EQ(state("COMPLETING|None"), TaskState::running);
    EXPECT_EQ(state("CANCELLED|None"), TaskState::cancelled);
    EXPECT_EQ(state("NODE_FAIL|None"), TaskState::lost);
    EXPECT_EQ(state("PREEMPTED|None"), TaskState::lost);
    EXPECT_EQ(state("TIMEOUT|TimeLimit"), TaskState::overtime);
    EXPECT_EQ(state("OUT_OF_MEMORY|OutOfMemory"), TaskState::out_of_memory);
    for (const char* row :
         {"", "k", "slurm_load_jobs error: Unexpected message received", "k|17|N/A|RUNNING|None|n|0|",
          "|17|4|RUNNING|None|n|0|", "k||4|RUNNING|None|n|0|", "k|17|4||None|n|0|", "k|17|4|RUNNING|None|n|",
          "k|17|4|running?|None|n|0|", "k|17|4|RUNNING|None|n|x|"})
        EXPECT_FALSE(parse_task(row)) << row;
}

TEST(Quote, ComesThroughAShellAsItWas) {
    const std::string ugly = "a b'c\"$HOME;`id`\\\n*";
    EXPECT_EQ(run_command({"/bin/sh", "-c", "printf %s " + quote(ugly)}, 60s).value(), ugly);
}

// The programs write down how they were called.
class SlurmTest : public testing::Test {
  protected:
    SlurmTest() {
        const char* path = std::getenv("PATH");
        old_path = path != nullptr ? path : "";
        ::setenv("PATH", (folder.path() + ":" + old_path).c_str(), 1);
        for (const char* name : {"sbatch", "squeue", "scancel", "scontrol", "sinfo"})
            program(name, "");
    }
    ~SlurmTest() override { ::setenv("PATH", old_path.c_str(), 1); }

    void program(const std::string& name, const std::string& body) const {
        const std::string path = folder.path() + "/" + name;
        test::write_file(path, fmt::format("#!/bin/sh\nprintf '%s\\n' {} \"$@\" >> {}/calls\n{}\n", name,
                                           folder.path(), body));
        ::chmod(path.c_str(), 0755);
    }
    [[nodiscard]] std::string calls() const {
        std::ifstream file(folder.path() + "/calls");
        std::ostringstream text;
        text << file.rdbuf();
        return "\n" + text.str();
    }
    [[nodiscard]] bool called_with(const std::string& line) const {
        return calls().find("\n" + line + "\n") != std::string::npos;
    }
    static ClusterArray array() {
        ClusterArray array;
        array.key = "drtv-1";
        array.tasks = 12;
        array.threads = 3;
        array.command = {"/opt/my bakerd", "task"};
        array.log_folder = "/store/logs/drtv-1";
        return array;
    }

    const test::TemporaryFolder folder;
    std::string old_path;
    SlurmOptions options;
};

TEST_F(SlurmTest, AnArrayIsSubmittedByName) {
    program("sbatch", "echo 17");
    ASSERT_TRUE(Slurm(options).submit(array()));
    for (const char* argument :
         {"--parsable", "--job-name=drtv-1", "--dependency=singleton", "--requeue", "--array=0-11",
          "--output=/store/logs/drtv-1/%a.log", "--cpus-per-task=3", "--wrap=exec '/opt/my bakerd' 'task'"})
        EXPECT_TRUE(called_with(argument)) << argument << calls();
    for (const char* argument : {"--account", "--partition", "--mem", "nice", "--exclude", "--time"})
        EXPECT_EQ(calls().find(argument), std::string::npos) << argument;
}

TEST_F(SlurmTest, WhatIsConfiguredIsAskedFor) {
    program("sbatch", "echo '17;other'");
    options.account = "film";
    options.partition = "night";
    options.qos = "low";
    options.constraint = "avx2";
    options.time_limit_min = 30;
    options.throttle = 5;
    options.arguments = {"--exclusive", "--comment=a b"};
    ClusterArray wanted = array();
    wanted.priority = Priority::nightly;
    wanted.memory_bytes = (std::int64_t{3} << 30) + 1;
    wanted.excluded_nodes = {"node1", "node7"};
    ASSERT_TRUE(Slurm(options).submit(wanted));
    for (const char* argument : {"--account=film", "--partition=night", "--qos=low", "--constraint=avx2",
                                 "--time=30", "--array=0-11%5", "--exclusive", "--comment=a b", "--mem=3073M",
                                 "--exclude=node1,node7", "jobid=17", "nice=100000"})
        EXPECT_TRUE(called_with(argument)) << argument << calls();
}

TEST_F(SlurmTest, AnSbatchThatHangsDiesOrAnswersNonsenseIsASentence) {
    options.time_limit = 300ms;
    const auto refusal = [&](const std::string& body) {
        program("sbatch", body);
        const auto taken = Slurm(options).submit(array());
        return taken ? Refusal{} : taken.error();
    };
    EXPECT_EQ(refusal("sleep 100").sentence, "sbatch was not done after 300 ms");
    options.time_limit = 60s;
    EXPECT_EQ(refusal("kill -9 $$").sentence, "sbatch was ended by signal 9 (Killed)");
    EXPECT_EQ(refusal("echo Submitted batch job").sentence,
              "sbatch gave no job's number, but \"Submitted batch job\\n\"");
    EXPECT_EQ(refusal("").sentence, "sbatch gave no job's number, but \"\"");
    const Refusal invalid = refusal(
        "echo 'sbatch: error: Batch job submission failed: Invalid job array specification' >&2; exit 1");
    EXPECT_TRUE(invalid.is_too_large) << invalid.sentence;
    EXPECT_TRUE(refusal("echo 'sbatch: error: AssocMaxSubmitJobLimit' >&2; exit 1").is_too_large);
    EXPECT_FALSE(refusal("echo 'sbatch: error: invalid partition specified: x' >&2; exit 1").is_too_large);
}

TEST_F(SlurmTest, AListIsWholeOrASentence) {
    const std::vector<std::string> keys = {"k", "l"};
    program("squeue", "echo 'k|17|4|RUNNING|None|node2|0|'; echo 'l|18|0|PENDING|BeginTime|n/a|0|'");
    const auto tasks = Slurm(options).list(keys);
    ASSERT_TRUE(tasks) << tasks.error();
    ASSERT_EQ(tasks->size(), 2u);
    EXPECT_EQ((*tasks)[1].state, TaskState::delayed);
    EXPECT_TRUE(called_with("--name=k,l")) << calls();
    program("squeue", "echo 'k|17|4|RUNNING|None|node2|0|'; echo 'l|18|0|PEN'");
    EXPECT_EQ(Slurm(options).list(keys).error(), "squeue gave a row that is none: l|18|0|PEN");
    program("squeue", "echo 'slurm_load_jobs error: Unable to contact slurm controller' >&2; exit 1");
    EXPECT_NE(Slurm(options).list(keys).error().find("Unable to contact"), std::string::npos);
    program("squeue", "echo \"k|17|4|RUNNING|None|node2|0${SQUEUE_ACCOUNT}|\"");
    ::setenv("SQUEUE_ACCOUNT", "other", 1);
    EXPECT_TRUE(Slurm(options).list(keys)) << "a user's own filters are no matter";
    ::unsetenv("SQUEUE_ACCOUNT");
    program("squeue", "");
    EXPECT_TRUE(Slurm(options).list(keys).value().empty());
}

TEST_F(SlurmTest, TheClusterIsSeenAsItIs) {
    program("scontrol",
            "echo 'MaxArraySize            = 501'; echo 'SchedulerParameters = a=1,max_array_tasks=300'");
    program(
        "sinfo",
        "echo 'node1|64|2000|idle|night*|none'; echo 'node1|64|2000|idle|all|none'; echo "
        "'node2|8+|4000|drained|night*|Duplicate jobid'; echo 'node3|8|4000|idle*|night*|Not responding'; "
        "echo 'node4|8|4000|idle|all|none'");
    const auto view = Slurm(options).view();
    ASSERT_TRUE(view) << view.error();
    EXPECT_EQ(view->max_tasks, 300u);
    EXPECT_EQ(view->task_threads, 8);
    ASSERT_EQ(view->nodes.size(), 3u) << "node1 is in two partitions, node4 not in the default one";
    EXPECT_EQ(std::tuple(view->nodes[0].is_up, view->nodes[0].threads, view->nodes[0].memory_bytes),
              std::tuple(true, 64, std::int64_t{2000} << 20));
    EXPECT_EQ(std::tuple(view->nodes[1].is_up, view->nodes[1].reason),
              std::tuple(false, "drained: Duplicate jobid"));
    EXPECT_FALSE(view->nodes[2].is_up);
    Slurm(options).mend(*view);
    EXPECT_FALSE(called_with("state=resume"));
    options.resumes_nodes = true;
    Slurm(options).mend(*view);
    EXPECT_TRUE(called_with("nodename=node2") && called_with("state=resume")) << calls();
    EXPECT_FALSE(called_with("nodename=node3"));
    options.threads = 4;
    EXPECT_EQ(Slurm(options).view()->task_threads, 4);
    options.partition = "all";
    program("sinfo", "echo 'node4|8|4000|idle|all|none'");
    EXPECT_EQ(Slurm(options).view()->nodes.size(), 1u);
    EXPECT_TRUE(called_with("--partition=all")) << calls();
    // It may be named elsewhere.
    options.partition = "";
    options.arguments = {"-p", "night"};
    ASSERT_TRUE(Slurm(options).view());
    EXPECT_TRUE(called_with("--partition=night")) << calls();
    options.arguments = {"--comment=x"};
    ::setenv("SBATCH_PARTITION", "site", 1);
    ASSERT_TRUE(Slurm(options).view());
    ::unsetenv("SBATCH_PARTITION");
    EXPECT_TRUE(called_with("--partition=site")) << calls();
    program("scontrol", "exit 1");
    EXPECT_FALSE(Slurm(options).view());
}

TEST_F(SlurmTest, TasksAreCancelledByNameAndNumber) {
    Slurm slurm(options);
    slurm.cancel("drtv-1");
    EXPECT_TRUE(called_with("--name=drtv-1")) << calls();
    ClusterTask task;
    task.key = "drtv-2";
    task.job = "17";
    task.number = 4;
    slurm.cancel(std::vector<ClusterTask>{task});
    EXPECT_TRUE(called_with("--name=drtv-2") && called_with("17_4")) << calls();
    task.state = TaskState::delayed;
    slurm.nudge(std::vector<ClusterTask>{task});
    EXPECT_TRUE(called_with("jobid=17_4") && called_with("StartTime=now")) << calls();
    task.state = TaskState::held;
    slurm.nudge(std::vector<ClusterTask>{task});
    EXPECT_TRUE(called_with("release")) << calls();
}

}  // namespace
}  // namespace drtv::executor
