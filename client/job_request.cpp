#include "client/job_request.h"

#include "client/interrupt.h"
#include "client/map_contents.h"
#include "client/upload.h"
#include "client/whole_file.h"
#include "format/cli/report.h"
#include "format/cli/suggestion.h"
#include "settings/message/job_settings.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <system_error>

namespace drtv::client {
namespace {

cli::Result<v1::Region> parse_region(const std::string& text) {
    v1::Region region;
    std::array<double, 4> values{};
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (std::size_t n = 0; n < values.size(); ++n) {
        const auto [stopped, error] = std::from_chars(at, end, values[n]);
        const bool is_last = n + 1 == values.size();
        const bool separated = is_last ? stopped == end : stopped != end && *stopped == ',';
        if (error != std::errc() || !separated)
            return cli::fail(cli::exit_usage,
                             fmt::format("the region '{}' is not X0,Y0,X1,Y1 in metres", text));
        at = stopped + 1;
    }
    region.set_x0(values[0]);
    region.set_y0(values[1]);
    region.set_x1(values[2]);
    region.set_y1(values[3]);
    return region;
}

// Why `word` is none of the words, which are what `of` says.
std::string unknown(const std::string& of, const std::string& word, const std::vector<std::string>& words) {
    return cli::with_hint(fmt::format("there is no {} \"{}\"", of, word),
                          cli::suggestion(word, words),
                          "bake submit --help lists them");
}

std::vector<std::string> setting_names() {
    std::vector<std::string> names;
    for (const settings::Setting& setting : settings::table())
        names.emplace_back(setting.name);
    return names;
}

// "key=value" of `--set`.
cli::Result<void> set_setting(v1::Job& job, const std::string& argument) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos || equals == 0)
        return cli::fail(cli::exit_usage, fmt::format("--set takes key=value, not '{}'", argument));
    const std::string key = argument.substr(0, equals);
    const settings::Setting* setting = settings::find_setting(key);
    if (setting == nullptr)
        return cli::fail(cli::exit_usage, unknown("setting", key, setting_names()));
    const auto value = settings::parse(*setting, argument.substr(equals + 1));
    if (!value)
        return cli::fail(cli::exit_usage, value.error());
    settings::set_field(job, *setting, *value);
    return {};
}

cli::Result<v1::Job> wanted_job(const SubmitOptions& options) {
    if (!settings::preset(options.preset)) {
        return cli::fail(
            cli::exit_usage,
            unknown(
                "preset", options.preset, {settings::preset_names.begin(), settings::preset_names.end()}));
    }
    v1::Job job;
    job.mutable_settings()->set_preset(options.preset);
    for (const std::string& setting : options.settings) {
        if (auto set = set_setting(job, setting); !set)
            return tl::unexpected(set.error());
    }
    if (options.exact)
        job.set_tolerance(0);
    if (!options.region.empty()) {
        const auto region = parse_region(options.region);
        if (!region)
            return tl::unexpected(region.error());
        *job.mutable_region() = *region;
    }
    return job;
}

}  // namespace

cli::Result<v1::Job> prepare_job(ServerConnection& connection, const SubmitOptions& options) {
    auto job = wanted_job(options);
    if (!job)
        return job;
    const auto local = collect_map(options.maps);
    if (!local)
        return tl::unexpected(local.error());
    for (const std::string& document : local->repeated)
        cli::note(fmt::format("{} is named twice; it is in the map once", document));
    if (!options.pull_folder.empty()) {
        // Before anything is baked: a wrong folder should not cost an hour.
        if (auto made = make_folder(options.pull_folder); !made)
            return tl::unexpected(made.error());
    }
    catch_interrupt();
    const auto map = upload_map(connection, *local);
    if (!map)
        return tl::unexpected(map.error());
    if (map->sector_count() == 0)
        return cli::fail(cli::exit_invalid, "the map has no ground, so there is nothing to bake");
    for (const std::string& warning : map->warnings())
        cli::warn(warning);
    job->set_map(map->name());
    return job;
}

}  // namespace drtv::client
