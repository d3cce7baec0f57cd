#include "client/job_request.h"

#include "client/interrupt.h"
#include "client/map_files.h"
#include "client/upload.h"
#include "client/whole_file.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <system_error>

namespace drtv::client {
namespace {

tl::expected<v1::Region, std::string> parse_region(const std::string& text) {
    v1::Region region;
    std::array<double, 4> values{};
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (std::size_t n = 0; n < values.size(); ++n) {
        const auto [stopped, error] = std::from_chars(at, end, values[n]);
        const bool is_last = n + 1 == values.size();
        const bool separated = is_last ? stopped == end : stopped != end && *stopped == ',';
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
    auto& overrides = *job.mutable_settings()->mutable_overrides();
    for (const std::string& setting : options.settings) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos || equals == 0)
            return tl::unexpected(fmt::format("--set takes key=value, not '{}'", setting));
        overrides[setting.substr(0, equals)] = setting.substr(equals + 1);
    }
    if (options.exact)
        overrides["tolerance"] = "0";
    if (!options.region.empty()) {
        const auto region = parse_region(options.region);
        if (!region)
            return tl::unexpected(region.error());
        *job.mutable_region() = *region;
    }
    return job;
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
        warn(warning);
    job->set_map(map->name());
    return job;
}

}  // namespace drtv::client
