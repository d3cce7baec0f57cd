#include "client/folder_pull.h"

#include "client/number_text.h"
#include "client/progress.h"
#include "client/sha256.h"
#include "client/whole_file.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <system_error>

namespace drtv::client {
namespace {

std::string file_name(const v1::SectorCoordinate& sector) {
    return fmt::format("sector_{}_{}.drtv", sector.i(), sector.j());
}

class Puller {
  public:
    Puller(ServerConnection& connection, std::string folder)
        : connection_(connection), folder_(std::move(folder)) {}

    cli::Result<void> run(const v1::PullSectorsRequest& request) {
        grpc::ClientContext context;
        const auto reader = connection_.sectors->PullSectors(&context, request);
        v1::PullSectorsResponse message;
        cli::Result<void> result;
        while (result && reader->Read(&message)) {
            if (message.has_sector()) {
                sector_ = message.sector();
                bytes_.clear();
            }
            bytes_ += message.data();
            if (static_cast<std::int64_t>(bytes_.size()) >= sector_.size_bytes())
                result = keep(request.sectors_size());
        }
        if (!result) {
            context.TryCancel();
            return result;
        }
        if (const grpc::Status status = reader->Finish(); !status.ok())
            return tl::unexpected(connection_.failure(status));
        return {};
    }

  private:
    cli::Result<void> keep(int total) {
        const std::string path = folder_ + "/" + file_name(sector_.coordinate());
        if (sha256_of_text(bytes_) != sector_.sha256())
            return cli::fail(cli::exit_unreadable,
                             fmt::format("{} arrived damaged; nothing was written", path));
        if (auto written = write_whole(path, bytes_); !written)
            return written;
        ++kept_;
        const double share = static_cast<double>(kept_) / total;
        progress_.show(share, fmt::format("pulled {}/{} sector files", kept_, total));
        return {};
    }

    ServerConnection& connection_;
    const std::string folder_;
    Progress progress_;
    v1::Sector sector_;
    std::string bytes_;
    int kept_ = 0;
};

}  // namespace

FolderPull::FolderPull(ServerConnection& connection, const std::string& job, std::string folder)
    : connection_(connection), job_(job_resource(job)), folder_(std::move(folder)) {}

cli::Result<void> FolderPull::pull() {
    v1::PullSectorsRequest wanted;
    wanted.set_job(job_);
    if (auto chosen = choose(wanted); !chosen)
        return chosen;
    if (wanted.sectors().empty())
        return {};
    Puller puller(connection_, folder_);
    if (auto pulled = puller.run(wanted); !pulled)
        return pulled;
    pulled_ += wanted.sectors_size();
    return {};
}

cli::Result<void> FolderPull::choose(v1::PullSectorsRequest& wanted) {
    unfinished_ = 0;
    v1::ListSectorsRequest request;
    request.set_job(job_);
    for (bool more = true; more;) {
        grpc::ClientContext context;
        v1::ListSectorsResponse response;
        const grpc::Status status = connection_.sectors->ListSectors(&context, request, &response);
        if (!status.ok())
            return tl::unexpected(connection_.failure(status));
        for (const v1::Sector& sector : response.sectors()) {
            if (sector.state() != v1::Sector::DONE) {
                ++unfinished_;
                continue;
            }
            const v1::SectorCoordinate& coordinate = sector.coordinate();
            const bool is_new = here_.insert({coordinate.i(), coordinate.j()}).second;
            if (!is_new)
                continue;
            if (has_file_of(sector))
                ++unchanged_;
            else
                *wanted.add_sectors() = coordinate;
        }
        request.set_page_token(response.next_page_token());
        more = !response.next_page_token().empty();
    }
    return {};
}

bool FolderPull::has_file_of(const v1::Sector& sector) const {
    const std::string path = folder_ + "/" + file_name(sector.coordinate());
    std::error_code code;
    const auto size_bytes = static_cast<std::int64_t>(std::filesystem::file_size(path, code));
    if (code || size_bytes != sector.size_bytes())
        return false;
    return sha256_of_file(path).value_or("") == sector.sha256();
}

void FolderPull::report() const {
    if (connection_.options.json) {
        nlohmann::ordered_json json;
        json["kind"] = "pull";
        json["job"] = job_.substr(job_.find('/') + 1);
        json["folder"] = folder_;
        json["pulled"] = pulled_;
        json["unchanged"] = unchanged_;
        json["unfinished"] = unfinished_;
        std::puts(json.dump().c_str());
        return;
    }
    std::string text = fmt::format("{}: {} sector files pulled", folder_, with_thousands(pulled_));
    if (unchanged_ > 0)
        text += fmt::format(", {} were there already", with_thousands(unchanged_));
    if (unfinished_ > 0)
        text += fmt::format(", {} sectors are not done", with_thousands(unfinished_));
    std::puts(text.c_str());
}

}  // namespace drtv::client
