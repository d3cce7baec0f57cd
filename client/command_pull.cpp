#include "client/commands.h"
#include "client/job_text.h"
#include "client/map_files.h"
#include "client/progress.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>

namespace drtv::client {
namespace {

namespace fs = std::filesystem;

std::string file_name(const v1::SectorCoordinate& sector) {
    return fmt::format("sector_{}_{}.drtv", sector.i(), sector.j());
}

class Puller {
  public:
    Puller(Connection& connection, std::string folder)
        : connection_(connection), folder_(std::move(folder)) {}

    tl::expected<void, std::string> run(const v1::PullSectorsRequest& request) {
        grpc::ClientContext context;
        const auto reader = connection_.sectors->PullSectors(&context, request);
        v1::PullSectorsResponse message;
        tl::expected<void, std::string> result;
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
            return tl::unexpected(connection_.sentence(status));
        return {};
    }

  private:
    tl::expected<void, std::string> keep(int total) {
        const std::string path = folder_ + "/" + file_name(sector_.coordinate());
        if (sha256_of_text(bytes_) != sector_.sha256())
            return tl::unexpected(fmt::format("{} arrived damaged; nothing was written", path));
        if (auto written = write_whole(path, bytes_); !written)
            return written;
        ++kept_;
        progress_.show(static_cast<double>(kept_) / total,
                       fmt::format("pulled {}/{} sector files", kept_, total));
        return {};
    }

    Connection& connection_;
    const std::string folder_;
    Progress progress_;
    v1::Sector sector_;
    std::string bytes_;
    int kept_ = 0;
};

}  // namespace

tl::expected<void, std::string> make_folder(const std::string& folder) {
    std::error_code code;
    fs::create_directories(folder, code);
    if (!code && fs::is_directory(folder, code))
        return {};
    return tl::unexpected(
        fmt::format("cannot make the folder '{}': {}", folder, code ? code.message() : "it is a file"));
}

FolderPull::FolderPull(Connection& connection, const std::string& job, std::string folder)
    : connection_(connection), job_(job_resource(job)), folder_(std::move(folder)) {}

tl::expected<void, std::string> FolderPull::pull() {
    v1::PullSectorsRequest wanted;
    wanted.set_job(job_);
    unfinished_ = 0;
    v1::ListSectorsRequest request;
    request.set_job(job_);
    for (bool more = true; more;) {
        grpc::ClientContext context;
        v1::ListSectorsResponse response;
        if (const grpc::Status status = connection_.sectors->ListSectors(&context, request, &response);
            !status.ok())
            return tl::unexpected(connection_.sentence(status));
        for (const v1::Sector& sector : response.sectors()) {
            if (sector.state() != v1::Sector::DONE) {
                ++unfinished_;
                continue;
            }
            if (!here_.insert({sector.coordinate().i(), sector.coordinate().j()}).second)
                continue;
            const std::string path = folder_ + "/" + file_name(sector.coordinate());
            std::error_code code;
            const bool same_size =
                static_cast<std::int64_t>(fs::file_size(path, code)) == sector.size_bytes() && !code;
            if (same_size && sha256_of_file(path).value_or("") == sector.sha256())
                ++unchanged_;
            else
                *wanted.add_sectors() = sector.coordinate();
        }
        request.set_page_token(response.next_page_token());
        more = !response.next_page_token().empty();
    }
    if (wanted.sectors().empty())
        return {};
    Puller puller(connection_, folder_);
    if (auto pulled = puller.run(wanted); !pulled)
        return pulled;
    pulled_ += wanted.sectors_size();
    return {};
}

void FolderPull::report() const {
    if (connection_.options.json) {
        std::puts(nlohmann::ordered_json({{"job", job_.substr(job_.find('/') + 1)},
                                          {"folder", folder_},
                                          {"pulled", pulled_},
                                          {"unchanged", unchanged_},
                                          {"unfinished", unfinished_}})
                      .dump()
                      .c_str());
        return;
    }
    std::string text = fmt::format("{}: {} sector files pulled", folder_, with_thousands(pulled_));
    if (unchanged_ > 0)
        text += fmt::format(", {} were there already", with_thousands(unchanged_));
    if (unfinished_ > 0)
        text += fmt::format(", {} sectors are not done", with_thousands(unfinished_));
    std::puts(text.c_str());
}

int run_pull(Connection& connection, const std::string& job, const std::string& folder) {
    if (auto made = make_folder(folder); !made)
        return complain(made.error());
    FolderPull pull(connection, job, folder);
    if (auto pulled = pull.pull(); !pulled)
        return complain(pulled.error());
    pull.report();
    return 0;
}

}  // namespace drtv::client
