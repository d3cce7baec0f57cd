#include "client/folder_pull.h"

#include "client/earlier_files.h"
#include "client/folder_lock.h"
#include "client/folder_manifest.h"
#include "client/job_text.h"
#include "client/number_text.h"
#include "client/pull_report.h"
#include "client/reconnection.h"
#include "client/sector_list.h"
#include "client/sector_stream.h"
#include "format/cli/report.h"
#include "format/folder/whole_file.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

namespace drtv::client {
namespace {

namespace fs = std::filesystem;

folder::SectorPlace place_of(const v1::SectorCoordinate& coordinate) {
    return {coordinate.j(), coordinate.i()};
}

}  // namespace

cli::Result<FolderPull> FolderPull::open(
    ServerConnection& connection, v1::Job job, v1::Map map, std::string folder, bool replace) {
    FolderPull pull(connection, std::move(job), std::move(map), std::move(folder), replace);
    if (auto read = pull.read_earlier(); !read)
        return tl::unexpected(read.error());
    pull.manifest_ = manifest_of(pull.map_, pull.job_, connection.server);
    return pull;
}

cli::Result<void> FolderPull::read_earlier() {
    auto earlier = earlier_manifest(folder_, map_, replace_);
    if (!earlier)
        return tl::unexpected(earlier.error());
    earlier_ = std::move(*earlier);
    return {};
}

cli::Result<void> FolderPull::pull() {
    Reconnection reconnection(connection_.options.server);
    for (;;) {
        const std::size_t pulled_before = pulled_.size();
        auto done = pull_new();
        if (done || !done.error().may_pass || !reconnection.try_again(pulled_.size() > pulled_before))
            return done;
    }
}

cli::Result<void> FolderPull::pull_new() {
    const auto missing = missing_files();
    if (!missing)
        return tl::unexpected(missing.error());
    if (missing->empty())
        return {};
    if (auto begun = begin(); !begun)
        return begun;
    FileWriters writers(folder_, static_cast<std::int64_t>(missing->size()));
    auto pulled = stream(*missing, writers);
    auto written = writers.finish();
    for (const v1::SectorCoordinate& coordinate : writers.written()) {
        here_.insert(place_of(coordinate));
        pulled_.insert(place_of(coordinate));
    }
    return written ? pulled : written;
}

// One look at the folder is cheaper than one at each file that is not there.
void FolderPull::look_at_folder() {
    names_there_.clear();
    std::error_code code;
    for (fs::directory_iterator entry(folder_, code), end; !code && entry != end; entry.increment(code))
        names_there_.insert(entry->path().filename().string());
}

bool FolderPull::all_are_there() {
    look_at_folder();
    const std::size_t gone = std::erase_if(here_, [this](const folder::SectorPlace& place) {
        return !names_there_.contains(folder::sector_file_name(place.second, place.first));
    });
    return gone == 0;
}

cli::Result<std::vector<v1::SectorCoordinate>> FolderPull::missing_files() {
    look_at_folder();
    manifest_.unfinished = 0;
    std::vector<v1::SectorCoordinate> missing;
    auto listed = for_each_sector(connection_, job_.name(), [&](const v1::Sector& sector) {
        if (is_missing(sector))
            missing.push_back(sector.coordinate());
    });
    if (!listed)
        return tl::unexpected(listed.error());
    return missing;
}

// In parts, so that no request grows with the map.
cli::Result<void> FolderPull::stream(std::span<const v1::SectorCoordinate> missing, FileWriters& writers) {
    constexpr std::size_t part = 2'000;
    std::optional<LostFiles> lost;
    int lost_later = 0;
    while (!missing.empty()) {
        v1::PullSectorsRequest wanted;
        wanted.set_job(job_.name());
        wanted.set_takes_packs(true);
        const auto now = missing.first(std::min(part, missing.size()));
        wanted.mutable_sectors()->Assign(now.begin(), now.end());
        missing = missing.subspan(now.size());
        const auto lost_here = stream_sectors(connection_, wanted, writers);
        if (!lost_here)
            return tl::unexpected(lost_here.error());
        if (!lost)
            lost = *lost_here;
        else if (*lost_here)
            lost_later += (*lost_here)->count;
    }
    if (!lost)
        return {};
    if (lost_later > 0)
        lost->failure.sentence += fmt::format(
            " ({} lost too)", counted(lost_later, "file of later sectors is", "files of later sectors are"));
    return tl::unexpected(lost->failure);
}

cli::Result<void> FolderPull::begin() {
    if (has_begun_)
        return {};
    if (lock_)
        return write_begun();
    const auto lock = FolderLock::take(folder_);
    if (!lock)
        return tl::unexpected(lock.error());
    return write_begun();
}

cli::Result<void> FolderPull::write_begun() {
    // Another pull may have come to its end since.
    if (auto read = read_earlier(); !read)
        return read;
    has_begun_ = true;
    folder::FolderManifest begun = manifest_;
    begun.pulling = true;
    if (earlier_)
        begun.files.insert(earlier_->files.begin(), earlier_->files.end());
    return folder::write_whole(folder::manifest_path(folder_), folder::manifest_text(begun));
}

cli::Result<void> FolderPull::finish() {
    auto lock = FolderLock::take(folder_);
    if (!lock)
        return tl::unexpected(lock.error());
    lock_.emplace(std::move(*lock));
    auto done = complete();
    lock_.reset();
    return done;
}

cli::Result<void> FolderPull::complete() {
    // Another pull may have been here since.
    if (auto read = read_earlier(); !read)
        return read;
    here_.clear();
    manifest_.files.clear();
    if (auto pulled = pull(); !pulled)
        return pulled;
    if (!all_are_there()) {
        if (auto pulled = pull(); !pulled)
            return pulled;
        if (!all_are_there())
            return cli::fail(
                cli::exit_unreadable,
                fmt::format("somebody removes sector files from {} while they are pulled", folder_));
    }
    if (earlier_) {
        // A job of a region says nothing of the sectors around it.
        const bool stay =
            folder::are_of_one_map(*earlier_, manifest_) && (job_.has_region() || manifest_.unfinished > 0);
        removed_ += settle_earlier_files(folder_, *earlier_, stay, manifest_);
    }
    warn_of_strangers(folder_, manifest_);
    folder::remove_leftovers(folder_);
    if (auto synced = folder::sync_folder(folder_); !synced)
        return synced;
    return folder::write_whole(folder::manifest_path(folder_), folder::manifest_text(manifest_));
}

bool FolderPull::is_missing(const v1::Sector& sector) {
    if (sector.state() != v1::Sector::DONE) {
        ++manifest_.unfinished;
        return false;
    }
    const folder::SectorPlace place = place_of(sector.coordinate());
    const folder::ListedFile listed{sector.sha256(), sector.size_bytes(), manifest_.map};
    manifest_.files[place] = listed;
    if (here_.contains(place))
        return false;
    if (!has_file(place, listed))
        return true;
    here_.insert(place);
    return false;
}

bool FolderPull::has_file(const folder::SectorPlace& place, const folder::ListedFile& listed) const {
    return names_there_.contains(folder::sector_file_name(place.second, place.first)) &&
           folder::difference_from_list(folder::sector_file_path(folder_, place), listed).empty();
}

void FolderPull::report() const {
    const auto pulled = static_cast<std::int64_t>(pulled_.size());
    print_pull({.job = job_number(job_),
                .folder = folder_,
                .pulled = pulled,
                .unchanged = static_cast<std::int64_t>(here_.size()) - pulled,
                .removed = removed_,
                .unfinished = manifest_.unfinished},
               connection_.options.json);
}

}  // namespace drtv::client
