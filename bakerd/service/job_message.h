// A job as the contract has it.
#pragma once

#include "bakerd/farm/job_book.h"

#include "drtv/v1/job.pb.h"

namespace drtv::service {

void fill_job(const farm::JobView& view, v1::Job& out);

}  // namespace drtv::service
