#include "client/commands.h"
#include "client/job_text.h"
#include "client/progress.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

namespace drtv::client {
namespace {

// How long a daemon may be away (restarting) before a watch gives up.
constexpr std::chrono::seconds reconnect_patience{60};

std::atomic<bool> interrupt_seen{false};

void on_interrupt(int) {
    interrupt_seen = true;
}

std::string progress_text(const v1::Job& job) {
    std::string text = fmt::format("{}/{} sectors  {} probes",
                                   with_thousands(job.sectors_done()),
                                   with_thousands(job.sectors_total()),
                                   with_thousands(job.probes()));
    if (job.rays_per_second() > 0)
        text += fmt::format(
            "  {:.2f} Mrays/s  {} left", job.rays_per_second() * 1e-6, duration_text(job.seconds_left()));
    if (job.sectors_failed() > 0)
        text += fmt::format("  {} failed", job.sectors_failed());
    return text;
}

// Cancels a call as soon as ctrl-C is seen, because reading from a stream waits for the next message.
class InterruptGuard {
  public:
    explicit InterruptGuard(grpc::ClientContext& context)
        : thread_([this, &context] {
              while (!ended_) {
                  if (interrupted())
                      context.TryCancel();
                  std::this_thread::sleep_for(std::chrono::milliseconds(50));
              }
          }) {}
    ~InterruptGuard() {
        ended_ = true;
        thread_.join();
    }
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

  private:
    std::atomic<bool> ended_{false};
    std::thread thread_;
};

grpc::Status follow(Connection& connection,
                    const std::string& name,
                    Progress& progress,
                    const std::function<void(const v1::Job&)>& progressed,
                    v1::Job& last) {
    v1::WatchJobRequest request;
    request.set_name(name);
    grpc::ClientContext context;
    const InterruptGuard guard(context);
    const auto reader = connection.jobs->WatchJob(&context, request);
    v1::Job job;
    while (reader->Read(&job)) {
        last = job;
        if (progressed)
            progressed(job);
        if (connection.options.json) {
            std::puts(json_line(job).c_str());
            std::fflush(stdout);
        } else {
            progress.show(job.sectors_total() == 0
                              ? 1
                              : static_cast<double>(job.sectors_done() + job.sectors_failed()) /
                                    static_cast<double>(job.sectors_total()),
                          progress_text(job));
        }
    }
    return reader->Finish();
}

}  // namespace

void catch_interrupt() {
    std::signal(SIGINT, on_interrupt);
}
bool interrupted() {
    return interrupt_seen;
}

int run_watch(Connection& connection,
              const std::string& argument,
              const std::function<void(const v1::Job&)>& progressed) {
    catch_interrupt();
    const std::string name = job_resource(argument), number = name.substr(name.find('/') + 1);
    Progress progress;
    v1::Job job;
    auto last_contact = std::chrono::steady_clock::now();
    bool told = false;
    for (;;) {
        const std::string state_before = job.SerializeAsString();
        const grpc::Status status = follow(connection, name, progress, progressed, job);
        progress.clear();
        if (interrupted()) {
            std::fprintf(stderr,
                         "bake: job %s goes on without this client; come back with: bake watch %s\n",
                         number.c_str(),
                         number.c_str());
            return exit_interrupted;
        }
        if (has_ended(job))
            break;
        if (status.error_code() != grpc::StatusCode::UNAVAILABLE)
            return complain(connection.sentence(status));
        if (job.SerializeAsString() != state_before)
            last_contact = std::chrono::steady_clock::now();
        if (job.name().empty() || std::chrono::steady_clock::now() - last_contact > reconnect_patience)
            return complain(connection.sentence(status));
        if (!told)
            std::fprintf(stderr,
                         "bake: lost bakerd at %s; trying again for %lld s\n",
                         connection.options.server.c_str(),
                         static_cast<long long>(reconnect_patience.count()));
        told = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
    }
    if (!connection.options.json)
        std::puts(one_line(job).c_str());
    for (const std::string& warning : job.warnings())
        std::fprintf(stderr, "bake: warning: %s\n", warning.c_str());
    if (job.state() == v1::Job::SUCCEEDED && job.sectors_total() > 0 && job.probes() == 0) {
        std::fprintf(stderr,
                     "bake: warning: no probe was placed: no column of the 4 m lattice meets ground with 1.5 "
                     "m of air above it\n");
    }
    if (job.state() == v1::Job::FAILED)
        return complain(job.error());
    return job.state() == v1::Job::SUCCEEDED ? 0 : 1;
}

}  // namespace drtv::client
