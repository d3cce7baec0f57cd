#include "bakerd/service/names.h"
#include "bakerd/service/services.h"
#include "settings/message/job_settings.h"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <thread>

namespace drtv::service {
namespace {

// Each watch holds a thread of the server.
constexpr int max_watchers = 256;
constexpr std::chrono::milliseconds watch_interval{100};  // at most ten messages a second
constexpr std::chrono::milliseconds watch_patience{
    500};  // how soon a gone client or a stopping server is noticed
constexpr std::int64_t default_page = 50, max_page = 1000;

v1::Job::State to_proto(farm::JobState state) {
    switch (state) {
        case farm::JobState::running:
            return v1::Job::RUNNING;
        case farm::JobState::succeeded:
            return v1::Job::SUCCEEDED;
        case farm::JobState::failed:
            return v1::Job::FAILED;
        case farm::JobState::cancelled:
            return v1::Job::CANCELLED;
        case farm::JobState::creating:
            break;
    }
    return v1::Job::STATE_UNSPECIFIED;
}

void set_time(std::int64_t unix_ms, google::protobuf::Timestamp& out) {
    out.set_seconds(unix_ms / 1000);
    out.set_nanos(static_cast<std::int32_t>(unix_ms % 1000) * 1'000'000);
}

void fill_cluster(const executor::ClusterState& state, v1::ClusterState& out) {
    out.set_nodes(static_cast<std::int32_t>(state.nodes));
    out.set_nodes_up(static_cast<std::int32_t>(state.nodes_up));
    out.set_tasks_waiting(static_cast<std::int64_t>(state.tasks_waiting));
    out.set_tasks_running(static_cast<std::int64_t>(state.tasks_running));
    out.set_tasks_lost(static_cast<std::int64_t>(state.tasks_lost));
    out.set_trouble(state.trouble);
}

void fill(const farm::JobView& view, v1::Job& out) {
    const farm::JobRow& row = view.row;
    out.set_name(job_name(row.id));
    out.set_map(map_name(row.manifest));
    out.mutable_settings()->set_preset(row.preset);
    settings::write_settings(row.settings, out);
    if (const auto& region = row.region) {
        out.mutable_region()->set_x0(region->x0);
        out.mutable_region()->set_y0(region->y0);
        out.mutable_region()->set_x1(region->x1);
        out.mutable_region()->set_y1(region->y1);
    }
    out.set_state(view.waiting ? v1::Job::WAITING : to_proto(row.state));
    out.set_error(row.error);
    out.set_sectors_total(row.sectors_total);
    out.set_sectors_done(row.sectors_done);
    out.set_sectors_failed(row.sectors_failed);
    out.set_sectors_cached(row.sectors_cached);
    out.set_sectors_near(row.sectors_near);
    out.set_largest_bound(static_cast<double>(row.largest_bound));
    out.set_probes(row.probes);
    out.set_rays(view.rays);
    out.set_rays_per_second(view.rays_per_second);
    out.set_seconds_left(view.seconds_left);
    set_time(row.created_ms, *out.mutable_create_time());
    if (row.ended_ms != 0)
        set_time(row.ended_ms, *out.mutable_end_time());
    for (const std::string& warning : view.warnings)
        out.add_warnings(warning);
    out.set_priority(row.priority == executor::Priority::nightly ? v1::Job::NIGHTLY : v1::Job::INTERACTIVE);
    if (view.cluster)
        fill_cluster(*view.cluster, *out.mutable_cluster());
}

v1::PlannedSector::Verdict to_proto(reuse::Verdict verdict) {
    switch (verdict) {
        case reuse::Verdict::hit:
            return v1::PlannedSector::HIT;
        case reuse::Verdict::near_hit:
            return v1::PlannedSector::NEAR_HIT;
        case reuse::Verdict::rebake:
            return v1::PlannedSector::REBAKE;
    }
    return v1::PlannedSector::VERDICT_UNSPECIFIED;
}

store::Result<farm::JobRequest> wanted_job(const v1::Job& job) {
    const auto map = map_from_name(job.map());
    if (!map)
        return tl::unexpected(map.error());
    farm::JobRequest wanted;
    wanted.manifest = *map;
    wanted.preset = job.settings().preset();
    const auto settings = settings::read_settings(job);
    if (!settings)
        return store::fail(store::ErrorCode::invalid_argument, settings.error());
    wanted.settings = *settings;
    wanted.priority =
        job.priority() == v1::Job::NIGHTLY ? executor::Priority::nightly : executor::Priority::interactive;
    if (job.has_region())
        wanted.region =
            farm::JobRegion{job.region().x0(), job.region().y0(), job.region().x1(), job.region().y1()};
    return wanted;
}

grpc::Status answer(const store::Result<farm::JobView>& view, v1::Job* response) {
    if (!view)
        return to_status(view.error());
    fill(*view, *response);
    return grpc::Status::OK;
}

}  // namespace

grpc::Status JobsService::CreateJob(grpc::ServerContext* context,
                                    const v1::CreateJobRequest* request,
                                    v1::Job* response) {
    auto wanted = wanted_job(request->job());
    if (!wanted)
        return to_status(wanted.error());
    wanted->request_id = request->request_id();
    return answer(farm_.create_job(*wanted, [context] { return context->IsCancelled(); }), response);
}

grpc::Status JobsService::PlanJob(grpc::ServerContext*,
                                  const v1::PlanJobRequest* request,
                                  v1::Plan* response) {
    const auto wanted = wanted_job(request->job());
    if (!wanted)
        return to_status(wanted.error());
    const auto view = farm_.plan_job(*wanted);
    if (!view)
        return to_status(view.error());
    for (const farm::PlannedSector& planned : view->plan.sectors) {
        v1::PlannedSector& sector = *response->add_sectors();
        sector.set_i(planned.sector.i);
        sector.set_j(planned.sector.j);
        sector.set_verdict(to_proto(planned.verdict));
        sector.set_bound(static_cast<double>(planned.bound));
        sector.set_reason(planned.reason);
        if (planned.verdict == reuse::Verdict::rebake)
            sector.set_share(static_cast<double>(planned.share));
    }
    for (const auto& [what, bounds] : view->plan.changes) {
        v1::MapChange& change = *response->add_changes();
        change.set_what(what);
        change.set_x0(static_cast<double>(bounds.low.x));
        change.set_y0(static_cast<double>(bounds.low.y));
        change.set_z0(static_cast<double>(bounds.low.z));
        change.set_x1(static_cast<double>(bounds.high.x));
        change.set_y1(static_cast<double>(bounds.high.y));
        change.set_z1(static_cast<double>(bounds.high.z));
    }
    response->set_seconds(view->seconds);
    for (const std::string& warning : view->plan.warnings)
        response->add_warnings(warning);
    return grpc::Status::OK;
}

grpc::Status JobsService::GetJob(grpc::ServerContext*, const v1::GetJobRequest* request, v1::Job* response) {
    const auto id = job_from_name(request->name());
    if (!id)
        return to_status(id.error());
    return answer(farm_.get_job(*id), response);
}

grpc::Status JobsService::ListJobs(grpc::ServerContext*,
                                   const v1::ListJobsRequest* request,
                                   v1::ListJobsResponse* response) {
    const auto page = page_of(request->page_token(),
                              request->page_size(),
                              std::numeric_limits<std::int64_t>::max(),
                              default_page,
                              max_page);
    if (!page)
        return to_status(page.error());
    const auto size = static_cast<std::size_t>(page->size);
    const auto views = farm_.list_jobs(page->from, size + 1);
    if (!views)
        return to_status(views.error());
    for (std::size_t n = 0; n < views->size() && n < size; ++n)
        fill((*views)[n], *response->add_jobs());
    if (views->size() > size)
        response->set_next_page_token(std::to_string((*views)[size - 1].row.id));
    return grpc::Status::OK;
}

grpc::Status JobsService::CancelJob(grpc::ServerContext*,
                                    const v1::CancelJobRequest* request,
                                    v1::Job* response) {
    const auto id = job_from_name(request->name());
    if (!id)
        return to_status(id.error());
    return answer(farm_.cancel_job(*id), response);
}

grpc::Status JobsService::RetryJob(grpc::ServerContext*,
                                   const v1::RetryJobRequest* request,
                                   v1::Job* response) {
    const auto id = job_from_name(request->name());
    if (!id)
        return to_status(id.error());
    return answer(farm_.retry_job(*id), response);
}

grpc::Status JobsService::WatchJob(grpc::ServerContext* context,
                                   const v1::WatchJobRequest* request,
                                   grpc::ServerWriter<v1::Job>* writer) {
    const auto id = job_from_name(request->name());
    if (!id)
        return to_status(id.error());
    struct Seat {
        std::atomic<int>& taken;
        int number;
        explicit Seat(std::atomic<int>& watchers) : taken(watchers), number(++watchers) {}
        ~Seat() { --taken; }
    } seat(watchers_);
    if (seat.number > max_watchers)
        return failed(grpc::StatusCode::RESOURCE_EXHAUSTED,
                      fmt::format("{} clients are watching already", max_watchers));
    std::optional<executor::ClusterState> cluster;
    for (std::uint64_t seen = 0;;) {
        const auto view = farm_.wait_for_change(*id, seen, watch_patience);
        if (!view)
            return to_status(view.error());
        if (context->IsCancelled())
            return grpc::Status::CANCELLED;
        if (stopping_)
            return failed(grpc::StatusCode::UNAVAILABLE, "the server is stopping");
        if (view->version == seen && view->cluster == cluster)
            continue;
        cluster = view->cluster;
        seen = view->version;
        v1::Job job;
        fill(*view, job);
        if (!writer->Write(job))
            return grpc::Status::CANCELLED;
        if (view->row.state != farm::JobState::running)
            return grpc::Status::OK;
        std::this_thread::sleep_for(watch_interval);
    }
}

}  // namespace drtv::service
