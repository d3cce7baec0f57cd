#include "client/commands.h"
#include "client/job_text.h"
#include "client/map_files.h"
#include "client/progress.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace drtv::client {
namespace {

namespace fs = std::filesystem;

std::string file_name(const v1::SectorCoordinate& sector) { return fmt::format("sector_{}_{}.drtv", sector.i(), sector.j()); }

// The file appears whole or not at all.
tl::expected<void, std::string> write_whole(const std::string& path, const std::string& bytes) {
    const std::string temporary = fmt::format("{}.part{}", path, ::getpid());
    const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    bool written = fd >= 0;
    for (std::size_t at = 0; written && at < bytes.size();) {
        const ssize_t n = ::write(fd, bytes.data() + at, bytes.size() - at);
        if (n < 0 && errno == EINTR) continue;
        written = n > 0;
        if (n > 0) at += static_cast<std::size_t>(n);
    }
    const int write_error = errno;
    if (fd >= 0 && ::close(fd) != 0) written = false;
    if (written && ::rename(temporary.c_str(), path.c_str()) == 0) return {};
    const int error = written || fd < 0 ? errno : write_error;
    if (fd >= 0) ::unlink(temporary.c_str());
    return tl::unexpected(fmt::format("cannot write {}: {}", path, std::strerror(error)));
}

struct Listed {
    v1::PullSectorsRequest wanted;
    std::int64_t done = 0, unfinished = 0;
};

// The finished sectors whose files are not in the folder yet, byte for byte.
tl::expected<Listed, std::string> list_wanted(Connection& connection, const std::string& job, const std::string& folder) {
    Listed listed;
    listed.wanted.set_job(job);
    v1::ListSectorsRequest request;
    request.set_job(job);
    for (;;) {
        grpc::ClientContext context;
        v1::ListSectorsResponse response;
        if (const grpc::Status status = connection.sectors->ListSectors(&context, request, &response); !status.ok()) return tl::unexpected(connection.sentence(status));
        for (const v1::Sector& sector : response.sectors()) {
            if (sector.state() != v1::Sector::DONE) {
                ++listed.unfinished;
                continue;
            }
            ++listed.done;
            const std::string path = folder + "/" + file_name(sector.coordinate());
            std::error_code code;
            const bool same_size = static_cast<std::int64_t>(fs::file_size(path, code)) == sector.size_bytes() && !code;
            if (same_size && sha256_of_file(path).value_or("") == sector.sha256()) continue;
            *listed.wanted.add_sectors() = sector.coordinate();
        }
        if (response.next_page_token().empty()) return listed;
        request.set_page_token(response.next_page_token());
    }
}

class Puller {
  public:
    Puller(Connection& connection, std::string folder) : connection_(connection), folder_(std::move(folder)) {}

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
            if (static_cast<std::int64_t>(bytes_.size()) >= sector_.size_bytes()) result = keep(request.sectors_size());
        }
        if (!result) {
            context.TryCancel();
            return result;
        }
        if (const grpc::Status status = reader->Finish(); !status.ok()) return tl::unexpected(connection_.sentence(status));
        return {};
    }

  private:
    tl::expected<void, std::string> keep(int total) {
        const std::string path = folder_ + "/" + file_name(sector_.coordinate());
        if (sha256_of_text(bytes_) != sector_.sha256()) return tl::unexpected(fmt::format("{} arrived damaged; nothing was written", path));
        if (auto written = write_whole(path, bytes_); !written) return written;
        ++kept_;
        progress_.show(static_cast<double>(kept_) / total, fmt::format("pulled {}/{} sector files", kept_, total));
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
    if (!code && fs::is_directory(folder, code)) return {};
    return tl::unexpected(fmt::format("cannot make the folder '{}': {}", folder, code ? code.message() : "it is a file"));
}

int run_pull(Connection& connection, const std::string& argument, const std::string& folder) {
    if (auto made = make_folder(folder); !made) return complain(made.error());
    const std::string job = job_resource(argument);
    const auto listed = list_wanted(connection, job, folder);
    if (!listed) return complain(listed.error());
    const int wanted = listed->wanted.sectors_size();
    if (wanted > 0) {
        Puller puller(connection, folder);
        if (auto pulled = puller.run(listed->wanted); !pulled) return complain(pulled.error());
    }
    const std::int64_t unchanged = listed->done - wanted;
    if (connection.options.json) {
        std::puts(nlohmann::ordered_json({{"job", job.substr(job.find('/') + 1)}, {"folder", folder}, {"pulled", wanted}, {"unchanged", unchanged}, {"unfinished", listed->unfinished}}).dump().c_str());
        return 0;
    }
    std::string text = fmt::format("{}: {} sector files pulled", folder, with_thousands(wanted));
    if (unchanged > 0) text += fmt::format(", {} were there already", with_thousands(unchanged));
    if (listed->unfinished > 0) text += fmt::format(", {} sectors are not done", with_thousands(listed->unfinished));
    std::puts(text.c_str());
    return 0;
}

}  // namespace drtv::client
