// A farm that bakes, event by event: how its time grows and shrinks with nodes, and what they ask of the
// store, the network, the daemon and Slurm. Batches are cut by the daemon's own rule
// (bakerd/executor/batches.h); sectors cost what was measured.
//   simulate_farm COSTS --sectors 25600 --nodes 4 [--threads 16] [...]
#include "bakerd/executor/batches.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <fstream>
#include <functional>
#include <map>
#include <queue>
#include <string>
#include <vector>

namespace {

namespace executor = drtv::executor;
using executor::BatchRule;
using executor::cut_batches;

constexpr double max_batch_s = 24 * 3600;

struct Farm {
    std::string costs;
    std::size_t sectors = 25600;
    std::size_t nodes = 4;
    int threads = 16;             // of a node, and of a task
    double batch_s = 90;          // that a task should take
    double launch_s = 0.45;       // from a free slot to a task's first instruction
    double launches_per_s = 60;   // that the controller can begin
    std::size_t map_sectors = 0;  // of a map, before the next map's begin; 0: all are of one
    double load_s = 1;            // for a map, of which a task's threads wait
    double map_mb = 100;          // that a task reads for it
    double network_mb_s = 1100;   // of the store
    double files_per_s = 2000;    // that the store can make durable
    double daemon_per_s = 2500;   // answers that the daemon can record
    double look_s = 1.5;          // between looks for answers
    double slowdown = 1;          // of sectors, where cores are fewer than threads
};

struct Cost {
    double seconds = 0;
    double mb = 0;  // written
};

struct Report {
    double seconds = 0;
    double busy_s = 0;  // of threads, in sectors alone
    std::size_t tasks = 0, arrays = 0, loads = 0;
    double written_mb = 0, read_mb = 0, files = 0;
    double recorded_s = 0;  // when the daemon has recorded the last answer
};

std::vector<Cost> read_costs(const std::string& path) {
    std::ifstream file(path);
    std::vector<Cost> costs;
    const nlohmann::json json = nlohmann::json::parse(file);
    for (const auto& sector : json.at("sectors"))
        costs.push_back({sector.at(0).get<double>(), sector.at(1).get<double>() / 1e6});
    return costs;
}

// A server that does one thing after another, as the store makes files durable.
class Server {
  public:
    explicit Server(double per_s) : per_s_(per_s) {}
    // When `count` of them that come at `now` are done.
    double serve(double now, double count) {
        free_ = std::max(free_, now) + count / per_s_;
        return free_;
    }

  private:
    double per_s_;
    double free_ = 0;
};

class Simulation {
  public:
    Simulation(const Farm& farm, std::vector<Cost> costs)
        : farm_(farm),
          costs_(std::move(costs)),
          launches_(farm.launches_per_s),
          network_(farm.network_mb_s),
          store_(farm.files_per_s),
          daemon_(farm.daemon_per_s),
          slots_(farm.nodes) {}

    Report run() {
        for (std::size_t slot = 0; slot < farm_.nodes; ++slot)
            idle_.push_back(slot);
        // Before anything is known of the costs.
        BatchRule rule;
        rule.batch_s = executor::pilot_batch_s(farm_.sectors, farm_.nodes, farm_.threads);
        rule.threads = farm_.threads;
        rule.max_batches = farm_.nodes;
        rule.is_last = false;
        submit(0, cut_batches(std::vector<double>(farm_.sectors, 1.0), rule));
        while (!events_.empty()) {
            const Event event = events_.top();
            events_.pop();
            (this->*event.what)(event);
        }
        report_.seconds = end_ + farm_.look_s / 2;
        return report_;
    }

  private:
    struct Event {
        double time = 0;
        void (Simulation::*what)(const Event&) = nullptr;
        std::size_t slot = 0;
        std::size_t sector = 0;

        bool operator>(const Event& other) const { return time > other.time; }
    };
    struct Task {
        std::size_t next = 0, end = 0, array = 0;
    };
    struct Slot {
        Task task;
        int threads = 0;                       // at work
        std::map<std::size_t, double> maps{};  // of the task, and when they are loaded
    };

    [[nodiscard]] const Cost& cost(std::size_t sector) const { return costs_[sector % costs_.size()]; }

    // Tasks of the next sectors, whose runs end there.
    void submit(double now, const std::vector<std::size_t>& ends) {
        open_.push_back(0);
        ++report_.arrays;
        const std::size_t first = taken_;
        for (const std::size_t end : ends) {
            const std::size_t to = std::min(first + end, farm_.sectors);
            if (to == taken_)
                break;
            waiting_.push_back({taken_, to, open_.size() - 1});
            ++open_.back();
            taken_ = to;
        }
        start_tasks(now);
    }

    void submit_next(double now) {
        while (taken_ < farm_.sectors &&
               std::ranges::count_if(open_, [](std::size_t tasks) { return tasks > 0; }) < 2) {
            const double mean_s = baked_s_ / static_cast<double>(baked_) * farm_.slowdown;
            BatchRule rule;
            rule.threads = farm_.threads;
            rule.slots = farm_.nodes;
            rule.batch_s = executor::long_batch_s(farm_.batch_s, load_seen_s_, max_batch_s);
            rule.least_s = executor::least_batch_s(rule.batch_s, load_seen_s_);
            const std::size_t tasks = executor::tasks_of_array(farm_.nodes);
            const double fill = static_cast<double>(tasks) * rule.batch_s * farm_.threads / mean_s;
            const std::size_t left = farm_.sectors - taken_;
            rule.is_last = static_cast<double>(left) <= fill;
            rule.max_batches = rule.is_last ? 1000 : tasks;
            const std::vector<double> seconds(rule.is_last ? left : static_cast<std::size_t>(fill) + 1,
                                              mean_s);
            submit(now, cut_batches(seconds, rule));
        }
    }

    void start_tasks(double now) {
        while (!idle_.empty() && !waiting_.empty()) {
            const std::size_t slot = idle_.back();
            idle_.pop_back();
            slots_[slot].task = waiting_.front();
            waiting_.pop_front();
            ++report_.tasks;
            slots_[slot].maps.clear();
            slots_[slot].threads = farm_.threads;
            const double begun = launches_.serve(now, 1) + farm_.launch_s;
            for (int thread = 0; thread < farm_.threads; ++thread)
                events_.push({begun, &Simulation::next_sector, slot, 0});
        }
    }

    // When the task has the sector's map.
    double load(Slot& slot, double now, std::size_t sector) {
        const std::size_t map = farm_.map_sectors == 0 ? 0 : sector / farm_.map_sectors;
        const auto [loaded, is_new] = slot.maps.try_emplace(map, 0);
        if (is_new) {
            loaded->second = network_.serve(now, farm_.map_mb) + farm_.load_s;
            ++report_.loads;
            report_.read_mb += farm_.map_mb;
            if (slot.maps.size() == 1)
                load_seen_s_ = loaded->second - now;
        }
        return std::max(now, loaded->second);
    }

    void next_sector(const Event& event) {
        Slot& slot = slots_[event.slot];
        if (slot.task.next < slot.task.end) {
            const std::size_t sector = slot.task.next++;
            events_.push({load(slot, event.time, sector) + cost(sector).seconds * farm_.slowdown,
                          &Simulation::write, event.slot, sector});
            return;
        }
        if (--slot.threads > 0)
            return;
        end_ = std::max(end_, event.time);
        // The daemon sees the last answer when it looks next.
        if (--open_[slot.task.array] == 0)
            events_.push({event.time + farm_.look_s, &Simulation::look, 0, 0});
        idle_.push_back(event.slot);
        start_tasks(event.time);
    }

    // Its file, its footprint and its answer; each is synced before the thread goes on.
    void write(const Event& event) {
        const Cost& written = cost(event.sector);
        const double done = std::max(network_.serve(event.time, written.mb), store_.serve(event.time, 3));
        events_.push({done, &Simulation::next_sector, event.slot, 0});
        report_.busy_s += written.seconds * farm_.slowdown;
        report_.written_mb += written.mb;
        report_.files += 3;
        report_.recorded_s = daemon_.serve(done, 1);
        baked_s_ += written.seconds;
        if (++baked_ == 1)
            events_.push({done + farm_.look_s, &Simulation::look, 0, 0});
    }

    void look(const Event& event) { submit_next(event.time); }

    const Farm& farm_;
    const std::vector<Cost> costs_;
    Server launches_, network_, store_, daemon_;
    std::vector<Slot> slots_;
    std::vector<std::size_t> idle_;
    std::deque<Task> waiting_;
    std::vector<std::size_t> open_;  // tasks left, by array
    std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
    std::size_t taken_ = 0, baked_ = 0;
    double baked_s_ = 0, end_ = 0;
    double load_seen_s_ = 0;  // of the task that was last to load
    Report report_;
};

}  // namespace

int main(int argc, char** argv) {
    Farm farm;
    CLI::App app{"Simulates a farm."};
    app.add_option("COSTS", farm.costs, "JSON: sectors: [[seconds, bytes], ...]")
        ->required()
        ->check(CLI::ExistingFile);
    app.add_option("--sectors", farm.sectors);
    app.add_option("--nodes", farm.nodes);
    app.add_option("--threads", farm.threads);
    app.add_option("--batch", farm.batch_s);
    app.add_option("--launch", farm.launch_s);
    app.add_option("--launches-per-s", farm.launches_per_s);
    app.add_option("--map-sectors", farm.map_sectors);
    app.add_option("--load", farm.load_s);
    app.add_option("--map-mb", farm.map_mb);
    app.add_option("--network-mb-s", farm.network_mb_s);
    app.add_option("--files-per-s", farm.files_per_s);
    app.add_option("--daemon-per-s", farm.daemon_per_s);
    app.add_option("--slowdown", farm.slowdown);
    CLI11_PARSE(app, argc, argv);
    const Report report = Simulation(farm, read_costs(farm.costs)).run();
    const double cores = static_cast<double>(farm.nodes) * farm.threads;
    std::printf(
        "{\"nodes\": %zu, \"sectors\": %zu, \"seconds\": %.1f, \"efficiency\": %.4f, \"core_seconds\": %.0f, "
        "\"tasks\": %zu, \"loads\": %zu, "
        "\"arrays\": %zu, \"read_gb\": %.1f, \"written_gb\": %.1f, \"network_mb_s\": %.1f, \"files_per_s\": "
        "%.0f, "
        "\"answers_per_s\": %.0f, \"tasks_per_s\": %.2f, \"recorded_s\": %.1f}\n",
        farm.nodes, farm.sectors, report.seconds, report.busy_s / (report.seconds * cores), report.busy_s,
        report.tasks, report.loads, report.arrays, report.read_mb / 1e3, report.written_mb / 1e3,
        (report.read_mb + report.written_mb) / report.seconds, report.files / report.seconds,
        static_cast<double>(farm.sectors) / report.seconds,
        static_cast<double>(report.tasks) / report.seconds, report.recorded_s);
    return 0;
}
