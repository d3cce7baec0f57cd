#include "client/commands.h"
#include "client/job_text.h"
#include "client/map_files.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <charconv>
#include <cstdio>
#include <random>

namespace drtv::client {
namespace {

tl::expected<v1::Region, std::string> parse_region(const std::string& text) {
    v1::Region region;
    double values[4] = {};
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (int n = 0; n < 4; ++n) {
        const auto [stopped, error] = std::from_chars(at, end, values[n]);
        const bool separated = n == 3 ? stopped == end : stopped != end && *stopped == ',';
        if (error != std::errc() || !separated)
            return tl::unexpected(fmt::format("the region '{}' is not X0,Y0,X1,Y1 in metres", text));
        at = stopped + 1;
    }
    region.set_x0(values[0]);
    region.set_y0(values[1]);
    region.set_x1(values[2]);
    region.set_y1(values[3]);
    return region;
}

tl::expected<v1::Job, std::string> wanted_job(const SubmitOptions& options) {
    v1::Job job;
    job.mutable_settings()->set_preset(options.preset);
    for (const std::string& setting : options.settings) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos || equals == 0)
            return tl::unexpected(fmt::format("--set takes key=value, not '{}'", setting));
        (*job.mutable_settings()->mutable_overrides())[setting.substr(0, equals)] =
            setting.substr(equals + 1);
    }
    if (options.exact)
        (*job.mutable_settings()->mutable_overrides())["tolerance"] = "0";
    if (!options.region.empty()) {
        const auto region = parse_region(options.region);
        if (!region)
            return tl::unexpected(region.error());
        *job.mutable_region() = *region;
    }
    return job;
}

std::string random_id() {
    std::random_device random;
    std::string id;
    for (int n = 0; n < 4; ++n)
        id += fmt::format("{:08x}", random());
    return id;
}

}  // namespace

tl::expected<v1::Job, std::string> prepare_job(Connection& connection, const SubmitOptions& options) {
    auto job = wanted_job(options);
    if (!job)
        return job;
    const auto local = collect_map(options.maps);
    if (!local)
        return tl::unexpected(local.error());
    if (!options.pull_folder.empty()) {
        // Before anything is baked: a wrong folder should not cost an hour.
        if (auto made = make_folder(options.pull_folder); !made)
            return tl::unexpected(made.error());
    }
    catch_interrupt();
    const auto map = upload_map(connection, *local);
    if (!map)
        return tl::unexpected(map.error());
    for (const std::string& warning : map->warnings())
        std::fprintf(stderr, "bake: warning: %s\n", warning.c_str());
    job->set_map(map->name());
    return job;
}

int run_submit(Connection& connection, const SubmitOptions& options) {
    const auto job = prepare_job(connection, options);
    if (!job)
        return complain(job.error());
    v1::CreateJobRequest request;
    *request.mutable_job() = *job;
    request.set_request_id(random_id());
    grpc::ClientContext context;
    v1::Job created;
    if (const grpc::Status status = connection.jobs->CreateJob(&context, request, &created); !status.ok())
        return complain(connection.sentence(status));

    const std::string number = job_number(created);
    if (created.sectors_total() == 0)
        std::fprintf(stderr, "bake: warning: the map has no ground, so there is nothing to bake\n");
    const bool wait = options.wait || !options.pull_folder.empty();
    if (!wait) {
        if (connection.options.json)
            std::puts(json_line(created).c_str());
        else
            std::printf("job %s: %s sectors%s; watch it with: bake watch %s\n",
                        number.c_str(),
                        with_thousands(created.sectors_total()).c_str(),
                        reused_text(created).c_str(),
                        number.c_str());
        for (const std::string& warning : created.warnings())
            std::fprintf(stderr, "bake: warning: %s\n", warning.c_str());
        return 0;
    }
    if (options.pull_folder.empty())
        return run_watch(connection, number);
    // Files come while the rest is still being baked.
    FolderPull pull(connection, number, options.pull_folder);
    tl::expected<void, std::string> pulled;
    std::int64_t done = 0;
    const auto pull_new = [&](const v1::Job& now) {
        if (!pulled || now.sectors_done() == done)
            return;
        done = now.sectors_done();
        pulled = pull.pull();
    };
    const int watched = run_watch(connection, number, pull_new);
    if (watched == exit_interrupted)
        return watched;
    if (pulled)
        pulled = pull.pull();
    if (!pulled)
        return complain(pulled.error());
    pull.report();
    return watched;
}

}  // namespace drtv::client
