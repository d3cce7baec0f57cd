#include "bakerd/service/job_message.h"

#include "bakerd/service/names.h"
#include "settings/message/job_settings.h"

namespace drtv::service {
namespace {

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

v1::Job::State state_of(const farm::JobView& view) {
    if (view.row.state == farm::JobState::running && view.row.held)
        return v1::Job::HELD;
    return view.waiting ? v1::Job::WAITING : to_proto(view.row.state);
}

}  // namespace

void fill_job(const farm::JobView& view, v1::Job& out) {
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
    out.set_state(state_of(view));
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
    out.set_owner(row.owner);
    out.set_label(row.label);
    out.set_jobs_ahead(view.jobs_ahead);
    out.set_seconds_to_start(view.seconds_to_start);
    if (view.cluster)
        fill_cluster(*view.cluster, *out.mutable_cluster());
}

}  // namespace drtv::service
