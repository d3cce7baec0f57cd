// Settings in the contract's messages. Each setting has a field of its name and type: a bake's in
// BakeSettings, a job's in Job.
#pragma once

#include "drtv/v1/job.pb.h"
#include "settings/table.h"

#include <string>

#include <tl/expected.hpp>

namespace drtv::settings {

// REQUIRES: check(setting, value).
void set_field(v1::Job& job, const Setting& setting, double value);

// Those of the job's preset, but for the fields that are set. A sentence where the preset is unknown or a
// value is out of range.
[[nodiscard]] tl::expected<JobSettings, std::string> read_settings(const v1::Job& job);

// Sets every field.
void write_settings(const JobSettings& settings, v1::Job& job);

}  // namespace drtv::settings
