#include "client/folder_pull.h"

#include "client/folder_lock.h"
#include "client/folder_manifest.h"
#include "client/interrupt.h"
#include "client/job_end.h"
#include "client/job_text.h"
#include "client/number_text.h"
#include "client/sector_stream.h"
#include "format/cli/report.h"
#include "format/folder/sha256.h"
#include "format/folder/whole_file.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <thread>

namespace drtv::client {
namespace {

namespace fs = std::filesystem;

// How long a daemon may be away (restarting) before a pull gives up.
constexpr std::chrono::seconds patience{60};

std::string path_of(const std::string& folder, const folder::SectorPlace& place) {
    return folder + "/" + folder::sector_file_name(place.second, place.first);
}

bool is_file(const std::string& path, const std::string& sha256, std::int64_t size_bytes) {
    std::error_code code;
    const std::uintmax_t found = fs::file_size(path, code);
    if (code || std::cmp_not_equal(found, size_bytes))
        return false;
    return folder::sha256_of_file(path).value_or("") == sha256;
}

}  // namespace

cli::Result<FolderPull> FolderPull::open(ServerConnection& connection,
                                         const std::string& job,
                                         std::string folder,
                                         bool replace) {
    auto found = get_job(connection, job);
    if (!found)
        return tl::unexpected(found.error());
    v1::GetMapRequest request;
    request.set_name(found->map());
    v1::Map map;
    if (const grpc::Status status = call(*connection.maps, &v1::Maps::Stub::GetMap, request, map);
        !status.ok())
        return tl::unexpected(connection.failure(status));
    FolderPull pull(connection, std::move(*found), std::move(map), std::move(folder), replace);
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
    auto last_progress = std::chrono::steady_clock::now();
    bool told = false;
    for (;;) {
        const std::size_t pulled_before = pulled_.size();
        auto done = pull_once();
        if (done || !done.error().may_pass)
            return done;
        const auto now = std::chrono::steady_clock::now();
        if (pulled_.size() > pulled_before)
            last_progress = now;
        if (now - last_progress > patience)
            return done;
        if (!told)
            cli::note(fmt::format(
                "lost bakerd at {}; trying again for {} s", connection_.options.server, patience.count()));
        told = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
    }
}

cli::Result<void> FolderPull::pull_once() {
    const auto wanted = missing_files();
    if (!wanted)
        return tl::unexpected(wanted.error());
    if (wanted->sectors().empty())
        return {};
    if (auto begun = write_begun(wanted->sectors_size()); !begun)
        return begun;
    return stream_sectors(connection_, *wanted, folder_, [this](const v1::Sector& sector) {
        const folder::SectorPlace place(sector.coordinate().j(), sector.coordinate().i());
        here_.insert(place);
        pulled_.insert(place);
    });
}

cli::Result<void> FolderPull::write_begun(std::int64_t wanted) {
    folder::FolderManifest begun = manifest_;
    begun.unfinished += wanted;
    if (earlier_)
        begun.files.insert(earlier_->files.begin(), earlier_->files.end());
    return folder::write_whole(folder::manifest_path(folder_), folder::manifest_text(begun));
}

cli::Result<void> FolderPull::finish() {
    const auto lock = FolderLock::take(folder_);
    if (!lock)
        return tl::unexpected(lock.error());
    // Another pull may have been here since.
    if (auto read = read_earlier(); !read)
        return read;
    here_.clear();
    manifest_.files.clear();
    if (auto pulled = pull(); !pulled)
        return pulled;
    leave_or_remove_earlier_files();
    folder::remove_leftovers(folder_);
    if (auto synced = folder::sync_folder(folder_); !synced)
        return synced;
    return folder::write_whole(folder::manifest_path(folder_), folder::manifest_text(manifest_));
}

cli::Result<v1::PullSectorsRequest> FolderPull::missing_files() {
    v1::PullSectorsRequest wanted;
    wanted.set_job(job_.name());
    manifest_.unfinished = 0;
    // One look at the folder is cheaper than one at each file that is not there.
    names_there_.clear();
    std::error_code code;
    for (fs::directory_iterator entry(folder_, code), end; !code && entry != end; entry.increment(code))
        names_there_.insert(entry->path().filename().string());
    v1::ListSectorsRequest request;
    request.set_job(job_.name());
    request.set_page_size(2'000);
    for (bool more = true; more;) {
        v1::ListSectorsResponse response;
        const grpc::Status status =
            call(*connection_.sectors, &v1::Sectors::Stub::ListSectors, request, response);
        if (!status.ok())
            return tl::unexpected(connection_.failure(status));
        for (const v1::Sector& sector : response.sectors())
            note_sector(sector, wanted);
        request.set_page_token(response.next_page_token());
        more = !response.next_page_token().empty();
    }
    return wanted;
}

void FolderPull::note_sector(const v1::Sector& sector, v1::PullSectorsRequest& wanted) {
    if (sector.state() != v1::Sector::DONE) {
        ++manifest_.unfinished;
        return;
    }
    const folder::SectorPlace place(sector.coordinate().j(), sector.coordinate().i());
    manifest_.files[place] = {sector.sha256(), sector.size_bytes(), manifest_.map};
    if (here_.contains(place))
        return;
    if (has_file_of(sector))
        here_.insert(place);
    else
        *wanted.add_sectors() = sector.coordinate();
}

bool FolderPull::has_file_of(const v1::Sector& sector) const {
    const std::string name = folder::sector_file_name(sector.coordinate().i(), sector.coordinate().j());
    return names_there_.contains(name) && is_file(folder_ + "/" + name, sector.sha256(), sector.size_bytes());
}

// A job of a region says nothing of the sectors around it: their files stay, and the manifest says of which
// map.
void FolderPull::leave_or_remove_earlier_files() {
    if (!earlier_)
        return;
    const bool stays =
        folder::are_of_one_map(*earlier_, manifest_) && (job_.has_region() || manifest_.unfinished > 0);
    std::int64_t changed = 0;
    for (const auto& [place, file] : earlier_->files) {
        if (manifest_.files.contains(place))
            continue;
        const std::string path = path_of(folder_, place);
        if (!is_file(path, file.sha256, file.size_bytes)) {
            std::error_code code;
            changed += fs::exists(path, code) ? 1 : 0;
            continue;
        }
        std::error_code code;
        if (stays)
            manifest_.files[place] = file;
        else
            removed_ += fs::remove(path, code) ? 1 : 0;
    }
    if (changed > 0)
        cli::warn(
            fmt::format("{} sector files in {} are no longer part of the map, and stay: somebody changed "
                        "them since they were pulled",
                        changed,
                        folder_));
}

void FolderPull::report() const {
    const auto pulled = static_cast<std::int64_t>(pulled_.size());
    const auto unchanged = static_cast<std::int64_t>(here_.size()) - pulled;
    if (connection_.options.json) {
        nlohmann::ordered_json json;
        json["kind"] = "pull";
        json["job"] = job_number(job_);
        json["folder"] = folder_;
        json["pulled"] = pulled;
        json["unchanged"] = unchanged;
        json["removed"] = removed_;
        json["unfinished"] = manifest_.unfinished;
        std::puts(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
        return;
    }
    std::string text = fmt::format("{}: {} sector files pulled", folder_, with_thousands(pulled));
    if (unchanged > 0)
        text += fmt::format(", {} were there already", with_thousands(unchanged));
    if (removed_ > 0)
        text += fmt::format(", {} removed that the map no longer has", with_thousands(removed_));
    if (manifest_.unfinished > 0)
        text += fmt::format(", {} sectors are not done", with_thousands(manifest_.unfinished));
    std::puts(text.c_str());
}

}  // namespace drtv::client
