#include "bakerd/doctor.h"

#include "bakerd/executor/run_command.h"
#include "bakerd/executor/slurm.h"
#include "bakerd/executor/slurm_text.h"
#include "bakerd/store/durable_file.h"
#include "bakerd/store/owner.h"
#include "bakerd/store/text_bytes.h"
#include "bakerd/worker/build_id.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace drtv {
namespace {

constexpr double gib = 1024.0 * 1024.0 * 1024.0;

class Findings {
  public:
    static void good(const std::string& what, const std::string& sentence) { print("ok", what, sentence); }
    static void doubtful(const std::string& what, const std::string& sentence) {
        print("warning", what, sentence);
    }
    void bad(const std::string& what, const std::string& sentence) {
        print("FAULT", what, sentence);
        ++faults_;
    }

    [[nodiscard]] int faults() const { return faults_; }

  private:
    static void print(const char* verdict, const std::string& what, const std::string& sentence) {
        std::printf("%-8s%-9s%s\n", verdict, what.c_str(), sentence.c_str());
    }

    int faults_ = 0;
};

// Seconds that the store's clock is ahead of this machine's, by a file that was just written there.
double clock_ahead_s(const struct stat& written) {
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    return static_cast<double>(written.st_mtim.tv_sec - now.tv_sec) +
           1e-9 * static_cast<double>(written.st_mtim.tv_nsec - now.tv_nsec);
}

void examine_store(const std::string& store, Findings& findings) {
    const auto owner = store::read_mark(store + "/owner");
    if (!owner || owner->empty()) {
        findings.bad("store",
                     fmt::format("{} is no daemon's store: is it mounted here, and has bakerd serve "
                                 "--executor slurm run with it?",
                                 store));
        return;
    }
    const std::string path = fmt::format("{}/answers/tmp/doctor.{}", store, ::getpid());
    const std::string words = "bakerd doctor was here\n";
    const auto written = store::write_durably(store + "/answers/tmp", path, store::bytes_of_text(words));
    const auto read = written ? store::read_all(path) : tl::unexpected(written.error());
    struct stat status {};
    const bool is_there = ::stat(path.c_str(), &status) == 0;
    ::unlink(path.c_str());
    if (!read || !is_there || read->size() != words.size()) {
        findings.bad(
            "store",
            read ? fmt::format("{} does not read back what was written", store) : read.error().message);
        return;
    }
    struct statvfs space {};
    const double free_gib =
        ::statvfs(store.c_str(), &space) == 0
            ? static_cast<double>(space.f_bavail) * static_cast<double>(space.f_frsize) / gib
            : 0;
    const std::string room = fmt::format("{} can be written and read; {:.1f} GiB are free", store, free_gib);
    if (free_gib < 1)
        findings.doubtful("store", room);
    else
        findings.good("store", room);
    const double ahead_s = clock_ahead_s(status);
    if (ahead_s > 5 || ahead_s < -5)
        findings.doubtful(
            "clock",
            fmt::format("the store's clock is {:.0f} s {} this node's: logs will not fit together",
                        ahead_s < 0 ? -ahead_s : ahead_s,
                        ahead_s < 0 ? "behind" : "ahead of"));
    else
        findings.good("clock", "within 5 s of the store's");
}

void examine_build(const std::string& store, Findings& findings) {
    const auto mark = store::read_mark(store + "/build");
    const auto daemon = mark ? worker::build_of(*mark) : std::nullopt;
    const worker::BuildId here = worker::this_build();
    if (!daemon) {
        findings.bad(
            "build",
            fmt::format("{}/build does not say which bakerd the daemon is: has it been started?", store));
        return;
    }
    if (const std::string differs = worker::difference(*daemon, here); !differs.empty()) {
        findings.bad("build", differs);
        return;
    }
    findings.good(
        "build",
        fmt::format(
            "baker version {}, {}, class {}: the daemon's", here.baker_version, here.commit, here.isa_class));
    if (here.commit == "unknown" || here.commit.ends_with("-dirty"))
        findings.doubtful(
            "build",
            fmt::format("its commit is \"{}\": two builds of different sources may be called the same",
                        here.commit));
}

void examine_slurm(const std::string& partition, Findings& findings) {
    executor::SlurmOptions options;
    options.partition = partition;
    const auto view = executor::Slurm(options).view();
    if (!view) {
        findings.bad("slurm", view.error());
        return;
    }
    std::size_t up = 0;
    for (const executor::ClusterNode& node : view->nodes)
        up += static_cast<std::size_t>(node.is_up);
    const std::string nodes =
        fmt::format("{} of {} nodes can bake; arrays have up to {} tasks, a task has threads: {}",
                    up,
                    view->nodes.size(),
                    view->max_tasks,
                    view->task_threads);
    if (up == 0)
        findings.bad("slurm", nodes);
    else
        findings.good("slurm", nodes);
    const char* name = std::getenv("SLURMD_NODENAME");
    const double here_gib =
        static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE)) / gib;
    for (const executor::ClusterNode& node : view->nodes) {
        if (!node.is_up)
            findings.doubtful("node", fmt::format("{} is {}", node.name, node.reason));
        if (name == nullptr || node.name != name)
            continue;
        const double told_gib = static_cast<double>(node.memory_bytes) / gib;
        const std::string memory =
            fmt::format("{:.1f} GiB here, of which Slurm knows {:.1f}", here_gib, told_gib);
        if (told_gib < 0.5)
            findings.doubtful("memory",
                              memory + ": without RealMemory in slurm.conf tasks cannot ask for any");
        else
            findings.good("memory", memory);
    }
    if (name == nullptr)
        findings.doubtful("node",
                          "this is no task of Slurm: run it on a node, as srun bakerd doctor --store ...");
    const auto config = executor::run_command({"scontrol", "show", "config"}, std::chrono::seconds(20));
    if (!config)
        return;
    const auto timeout_s = executor::configured(*config, "SlurmdTimeout");
    if (timeout_s && *timeout_s > 120)
        findings.doubtful(
            "slurm", fmt::format("SlurmdTimeout is {} s: so long tasks of a dead node wait", *timeout_s));
    const auto age_s = executor::configured(*config, "MinJobAge");
    if (age_s && *age_s < 30)
        findings.doubtful(
            "slurm",
            fmt::format("MinJobAge is {} s: tasks are forgotten before the daemon learns how they ended",
                        *age_s));
}

}  // namespace

cli::Result<cli::ExitCode> examine_node(const DoctorOptions& options) {
    Findings findings;
    examine_store(options.store, findings);
    examine_build(options.store, findings);
    examine_slurm(options.partition, findings);
    if (findings.faults() == 0)
        return cli::exit_done;
    return cli::fail(cli::exit_invalid, "tasks cannot bake here: see the lines above that begin with FAULT");
}

}  // namespace drtv
