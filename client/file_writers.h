// Sector files that have arrived, on their way to the disk.
#pragma once

#include "client/progress.h"
#include "drtv/v1/sector.pb.h"
#include "format/cli/failure.h"

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace drtv::client {

struct ArrivedFile {
    v1::SectorCoordinate coordinate;
    std::string sha256;
    std::string bytes;
};

// Checks and writes files while the next ones arrive: a disk is slow in making files, and the line should not
// wait for it.
class FileWriters {
  public:
    // `total`: how many there will be, for the progress bar.
    FileWriters(std::string folder, std::int64_t total);

    // As finish().
    ~FileWriters();
    FileWriters(const FileWriters&) = delete;
    FileWriters& operator=(const FileWriters&) = delete;

    // To be written, each whole. Fails once one could not be.
    [[nodiscard]] cli::Result<void> push(ArrivedFile file);

    // Waits until all is written. Fails as push does.
    [[nodiscard]] cli::Result<void> finish();

    // REQUIRES: finished.
    [[nodiscard]] const std::vector<v1::SectorCoordinate>& written() const { return written_; }

  private:
    static constexpr std::size_t max_waiting = 64;
    static constexpr std::size_t batch = 16;

    void run();
    [[nodiscard]] cli::Result<void> write(const ArrivedFile& file) const;
    void show_progress();

    const std::string folder_;
    const std::int64_t total_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<ArrivedFile> waiting_;  // guarded by mutex_, and so is the rest
    bool ended_ = false;
    cli::Result<void> result_;
    Progress progress_;
    std::vector<v1::SectorCoordinate> written_;
    std::array<std::jthread, 2> threads_;
};

}  // namespace drtv::client
