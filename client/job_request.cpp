#include "client/job_request.h"

#include "client/folder_manifest.h"
#include "client/map_contents.h"
#include "client/map_text.h"
#include "client/upload.h"
#include "client/user_name.h"
#include "format/cli/report.h"
#include "format/folder/whole_file.h"
#include "format/spelling/suggestion.h"
#include "settings/message/job_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <set>
#include <system_error>
#include <utility>

namespace drtv::client {
namespace {

constexpr const char* blanks = " \t";

cli::Result<v1::Region> parse_region(const std::string& text) {
    v1::Region region;
    std::array<double, 4> values{};
    std::size_t at = 0;
    for (std::size_t n = 0; n < values.size(); ++n) {
        const std::size_t start = std::min(text.find_first_not_of(blanks, at), text.size());
        const char* const end = text.data() + text.size();
        const auto [stopped, error] = std::from_chars(text.data() + start, end, values[n]);
        const auto behind = static_cast<std::size_t>(stopped - text.data());
        at = std::min(text.find_first_not_of(blanks, behind), text.size());
        const bool is_last = n + 1 == values.size();
        const bool separated = is_last ? at == text.size() : at != text.size() && text[at] == ',';
        if (error != std::errc() || !separated)
            return cli::fail(cli::exit_usage,
                             fmt::format("the region '{}' is not X0,Y0,X1,Y1 in metres", text));
        ++at;
    }
    region.set_x0(values[0]);
    region.set_y0(values[1]);
    region.set_x1(values[2]);
    region.set_y1(values[3]);
    return region;
}

// Why `word` is none of the words, which are what `of` says.
std::string unknown(const std::string& of, const std::string& word, const std::vector<std::string>& words) {
    return spelling::with_hint(fmt::format("there is no {} \"{}\"", of, word),
                               spelling::suggestion(word, words),
                               "bake submit --help lists them");
}

std::vector<std::string> setting_names() {
    std::vector<std::string> names;
    for (const settings::Setting& setting : settings::table())
        names.emplace_back(setting.name);
    return names;
}

// "key=value" of `--set`; gives the key.
cli::Result<std::string> set_setting(v1::Job& job, const std::string& argument) {
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
    return key;
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
    job.set_priority(options.priority == "nightly" ? v1::Job::NIGHTLY : v1::Job::INTERACTIVE);
    job.set_owner(user_name());
    job.set_label(options.label);
    std::set<std::string> keys;
    for (const std::string& setting : options.settings) {
        const auto key = set_setting(job, setting);
        if (!key)
            return tl::unexpected(key.error());
        if (!keys.insert(*key).second)
            cli::warn(fmt::format("{} is set twice; the last one counts: {}", *key, setting));
    }
    if (options.exact) {
        if (keys.contains("tolerance") && job.tolerance() > 0)
            return cli::fail(cli::exit_usage,
                             "--exact is --set tolerance=0, and --set says another tolerance: leave one out");
        job.set_tolerance(0);
    }
    if (!options.region.empty()) {
        const auto region = parse_region(options.region);
        if (!region)
            return tl::unexpected(region.error());
        *job.mutable_region() = *region;
    }
    return job;
}

}  // namespace

cli::Result<PreparedJob> prepare_job(ServerConnection& connection, const SubmitOptions& options) {
    auto job = wanted_job(options);
    if (!job)
        return tl::unexpected(job.error());
    const auto local = collect_map(options.maps);
    if (!local)
        return tl::unexpected(local.error());
    for (const std::string& document : local->repeated)
        cli::note(fmt::format("{} is named twice; it is in the map once", document));
    if (!options.pull_folder.empty()) {
        // Before anything is baked: a wrong folder should not cost an hour.
        if (auto made = folder::make_folder(options.pull_folder); !made)
            return tl::unexpected(made.error());
    }
    if (auto checked = check_server(connection); !checked)
        return tl::unexpected(checked.error());
    auto map = upload_map(connection, *local);
    if (!map)
        return tl::unexpected(map.error());
    if (map->sector_count() == 0) {
        const bool is_empty = map->survey().triangles() == 0;
        return cli::fail(
            cli::exit_invalid,
            is_empty ? "the map has no ground, so there is nothing to bake: no mesh is in it; was only "
                       "the selection exported, or nothing of it visible?"
                     : "the map has no ground, so there is nothing to bake");
    }
    std::puts((connection.options.json ? map_json_line(*map) : map_text(*map)).c_str());
    for (const std::string& warning : map->warnings())
        cli::warn(warning);
    if (!options.pull_folder.empty()) {
        if (auto known = earlier_manifest(options.pull_folder, *map, options.replace); !known)
            return tl::unexpected(known.error());
    }
    job->set_map(map->name());
    return PreparedJob{std::move(*map), std::move(*job)};
}

}  // namespace drtv::client
