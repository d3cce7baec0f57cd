// What the farm knows of a job's sector, as a message.
#pragma once

#include "bakerd/farm/farm.h"
#include "drtv/v1/sector.pb.h"

namespace drtv::service {

void fill_sector(const farm::JobSectorView& view, v1::Sector& out);

}  // namespace drtv::service
