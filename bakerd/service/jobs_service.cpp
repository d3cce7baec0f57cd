#include "bakerd/service/job_message.h"
#include "bakerd/service/names.h"
#include "bakerd/service/services.h"
#include "settings/message/job_settings.h"

#include <fmt/format.h>
#include <grpc/grpc_security_constants.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <thread>
#include <utility>

namespace drtv::service {
namespace {

// Each watch holds a thread of the server.
constexpr int max_watchers = 256;
constexpr std::chrono::milliseconds watch_interval{100};  // at most ten messages a second
constexpr std::chrono::milliseconds watch_patience{
    500};  // how soon a gone client or a stopping server is noticed
constexpr std::int64_t default_page = 50, max_page = 1000;

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
    fill_job(*view, *response);
    return grpc::Status::OK;
}

template <class Do>
grpc::Status with_job(const std::string& name, v1::Job* response, const Do& act) {
    const auto id = job_from_name(name);
    return id ? answer(act(*id), response) : to_status(id.error());
}

// Both are shown to people.
store::Result<void> check_text(const std::string& what, const std::string& text) {
    constexpr std::size_t max_bytes = 128;
    const bool has_control = std::ranges::any_of(
        text, [](char letter) { return static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f; });
    if (text.size() <= max_bytes && !has_control)
        return {};
    return store::fail(
        store::ErrorCode::invalid_argument,
        fmt::format("the {} is longer than {} bytes, or has control characters", what, max_bytes));
}

// Whose jobs this client's are.
std::string owner_of(const grpc::ServerContext& context, const std::string& said) {
    const auto identity = context.auth_context();
    if (!identity->IsPeerAuthenticated())
        return said;
    const auto uris = identity->FindPropertyValues(GRPC_PEER_URI_PROPERTY_NAME);
    return uris.empty() ? said : std::string(uris.front().data(), uris.front().size());
}

}  // namespace

grpc::Status JobsService::CreateJob(grpc::ServerContext* context,
                                    const v1::CreateJobRequest* request,
                                    v1::Job* response) {
    auto wanted = wanted_job(request->job());
    if (!wanted)
        return to_status(wanted.error());
    for (const auto& [what, text] :
         {std::pair("owner", &request->job().owner()), {"label", &request->job().label()}}) {
        if (auto checked = check_text(what, *text); !checked)
            return to_status(checked.error());
    }
    wanted->request_id = request->request_id();
    wanted->owner = owner_of(*context, request->job().owner());
    wanted->label = request->job().label();
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

grpc::Status JobsService::ListJobs(grpc::ServerContext* context,
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
    std::optional<std::string> owner;
    if (!request->owner().empty())
        owner = owner_of(*context, request->owner());
    const auto views = farm_.list_jobs(page->from, size + 1, owner);
    if (!views)
        return to_status(views.error());
    for (std::size_t n = 0; n < views->size() && n < size; ++n)
        fill_job((*views)[n], *response->add_jobs());
    if (views->size() > size)
        response->set_next_page_token(std::to_string((*views)[size - 1].row.id));
    return grpc::Status::OK;
}

grpc::Status JobsService::CancelJob(grpc::ServerContext*,
                                    const v1::CancelJobRequest* request,
                                    v1::Job* response) {
    return with_job(request->name(), response, [this](std::int64_t id) { return farm_.cancel_job(id); });
}

grpc::Status JobsService::RaiseJob(grpc::ServerContext*,
                                   const v1::RaiseJobRequest* request,
                                   v1::Job* response) {
    return with_job(request->name(), response, [this](std::int64_t id) { return farm_.raise_job(id); });
}

grpc::Status JobsService::HoldJob(grpc::ServerContext*,
                                  const v1::HoldJobRequest* request,
                                  v1::Job* response) {
    return with_job(request->name(), response, [this](std::int64_t id) { return farm_.hold_job(id, true); });
}

grpc::Status JobsService::ReleaseJob(grpc::ServerContext*,
                                     const v1::ReleaseJobRequest* request,
                                     v1::Job* response) {
    return with_job(request->name(), response, [this](std::int64_t id) { return farm_.hold_job(id, false); });
}

grpc::Status JobsService::RetryJob(grpc::ServerContext*,
                                   const v1::RetryJobRequest* request,
                                   v1::Job* response) {
    return with_job(request->name(), response, [this](std::int64_t id) { return farm_.retry_job(id); });
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
        fill_job(*view, job);
        if (!writer->Write(job))
            return grpc::Status::CANCELLED;
        if (view->row.state != farm::JobState::running)
            return grpc::Status::OK;
        std::this_thread::sleep_for(watch_interval);
    }
}

}  // namespace drtv::service
