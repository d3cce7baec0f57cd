#include "client/sector_stream.h"

#include "client/interrupt.h"
#include "client/progress.h"
#include "format/folder/manifest.h"
#include "format/folder/sha256.h"
#include "format/folder/whole_file.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <array>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace drtv::client {
namespace {

constexpr auto interrupted_pull = "interrupted; the same command goes on where this one ended";

struct ArrivedFile {
    v1::Sector sector;
    std::string bytes;
};

// Checks and writes files while the next ones arrive: a disk is slow in making files, and the line should not
// wait for it.
class Writers {
  public:
    Writers(std::string folder, int total, const std::function<void(const v1::Sector&)>& written)
        : folder_(std::move(folder)), total_(total), written_(written) {
        for (std::jthread& thread : threads_)
            thread = std::jthread([this] { run(); });
    }

    // False once a file could not be written.
    bool push(ArrivedFile file) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return waiting_.size() < max_waiting || !result_; });
        waiting_.push_back(std::move(file));
        if (waiting_.size() >= batch)
            changed_.notify_all();
        return result_.has_value();
    }

    // Waits until all is written.
    cli::Result<void> finish() {
        {
            const std::lock_guard lock(mutex_);
            ended_ = true;
        }
        changed_.notify_all();
        for (std::jthread& thread : threads_)
            thread.join();
        return result_;
    }

    // REQUIRES: finished.
    [[nodiscard]] int count() const { return count_; }

  private:
    static constexpr std::size_t max_waiting = 64;
    static constexpr std::size_t batch = 16;

    void run() {
        std::unique_lock lock(mutex_);
        for (;;) {
            changed_.wait(lock, [this] { return ended_ || waiting_.size() >= batch; });
            if (waiting_.empty() || !result_)
                return;
            std::vector<ArrivedFile> files;
            while (!waiting_.empty() && files.size() < batch) {
                files.push_back(std::move(waiting_.front()));
                waiting_.pop_front();
            }
            changed_.notify_all();
            lock.unlock();
            cli::Result<void> done;
            std::size_t written = 0;
            for (; written < files.size(); ++written) {
                done = write(files[written]);
                if (!done)
                    break;
            }
            lock.lock();
            for (std::size_t n = 0; n < written; ++n)
                tell(files[n].sector);
            if (done)
                continue;
            if (result_)
                result_ = done;
            changed_.notify_all();
        }
    }

    [[nodiscard]] cli::Result<void> write(const ArrivedFile& file) const {
        const v1::SectorCoordinate& place = file.sector.coordinate();
        const std::string path = folder::sector_file_path(folder_, {place.j(), place.i()});
        if (folder::sha256_of_text(file.bytes) != file.sector.sha256())
            return cli::fail(cli::exit_unreadable,
                             fmt::format("{} arrived damaged; nothing was written", path));
        return folder::put_whole(path, file.bytes);
    }

    void tell(const v1::Sector& sector) {
        written_(sector);
        ++count_;
        const double share = static_cast<double>(count_) / total_;
        progress_.show(share, fmt::format("pulled {}/{} sector files", count_, total_));
    }

    const std::string folder_;
    const int total_;
    const std::function<void(const v1::Sector&)>& written_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<ArrivedFile> waiting_;  // guarded by mutex_, and so is the rest
    bool ended_ = false;
    cli::Result<void> result_;
    Progress progress_;
    int count_ = 0;
    std::array<std::jthread, 2> threads_;
};

}  // namespace

cli::Result<void> stream_sectors(ServerConnection& connection,
                                 const v1::PullSectorsRequest& wanted,
                                 const std::string& folder,
                                 const std::function<void(const v1::Sector&)>& written) {
    grpc::ClientContext context;
    const InterruptGuard guard(context, interrupted_pull);
    const auto reader = connection.sectors->PullSectors(&context, wanted);
    Writers writers(folder, wanted.sectors_size(), written);
    v1::PullSectorsResponse message;
    ArrivedFile file;
    bool goes_on = true;
    while (goes_on && !interrupted() && reader->Read(&message)) {
        if (message.has_sector()) {
            file.sector = message.sector();
            file.bytes.clear();
        }
        file.bytes += message.data();
        if (static_cast<std::int64_t>(file.bytes.size()) >= file.sector.size_bytes())
            goes_on = writers.push(std::move(file));
    }
    if (!goes_on || interrupted())
        context.TryCancel();
    const grpc::Status status = reader->Finish();
    auto result = writers.finish();
    if (result && status.ok() && !interrupted() && writers.count() < wanted.sectors_size())
        result = cli::fail(cli::exit_server,
                           fmt::format("bakerd sent {} of {} files", writers.count(), wanted.sectors_size()));
    if (interrupted())
        return cli::fail(cli::exit_interrupted, interrupted_pull);
    if (result && !status.ok())
        return tl::unexpected(connection.failure(status));
    return result;
}

}  // namespace drtv::client
