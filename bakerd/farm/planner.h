// What a job would do: its sectors, and what of them is there.
#pragma once

#include "bakerd/executor/executor.h"
#include "bakerd/farm/job_request.h"
#include "bakerd/farm/maps.h"
#include "bakerd/farm/plan.h"
#include "bakerd/store/blob_store.h"
#include "bakerd/store/error.h"

namespace drtv::farm {

struct PlannedJob {
    Digest inventory;  // of the map
    Plan plan;
};

// Thread-safe.
class Planner {
  public:
    // REQUIRES: all outlive it.
    Planner(Maps& maps, ResultCache& cache, store::BlobStore& blobs, executor::Executor& executor)
        : maps_(maps), cache_(cache), blobs_(blobs), executor_(executor) {}

    // Asks the worker about results of other maps. What the plan reuses stays while `pin` lives.
    [[nodiscard]] store::Result<PlannedJob> plan(const JobRequest& request, CachePin& pin);

  private:
    [[nodiscard]] executor::Reply<worker::Assessments> ask(worker::AssessRequest question);

    Maps& maps_;
    ResultCache& cache_;
    store::BlobStore& blobs_;
    executor::Executor& executor_;
};

// That baking what a plan asks for will take on so many threads; 0: not known.
[[nodiscard]] double seconds_to_bake(const Plan& plan, int threads);

}  // namespace drtv::farm
