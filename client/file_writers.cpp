#include "client/file_writers.h"

#include "format/folder/manifest.h"
#include "format/folder/sha256.h"
#include "format/folder/whole_file.h"

#include <fmt/format.h>

#include <utility>

namespace drtv::client {

FileWriters::FileWriters(std::string folder, std::int64_t total) : folder_(std::move(folder)), total_(total) {
    for (std::jthread& thread : threads_)
        thread = std::jthread([this] { run(); });
}

FileWriters::~FileWriters() {
    static_cast<void>(finish());
}

cli::Result<void> FileWriters::push(ArrivedFile file) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return waiting_.size() < max_waiting || !result_; });
    waiting_.push_back(std::move(file));
    if (waiting_.size() >= batch)
        changed_.notify_all();
    return result_;
}

cli::Result<void> FileWriters::finish() {
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    changed_.notify_all();
    for (std::jthread& thread : threads_) {
        if (thread.joinable())
            thread.join();
    }
    return result_;
}

void FileWriters::run() {
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
            written_.push_back(files[n].coordinate);
        show_progress();
        if (done)
            continue;
        if (result_)
            result_ = done;
        changed_.notify_all();
    }
}

cli::Result<void> FileWriters::write(const ArrivedFile& file) const {
    const std::string path = folder::sector_file_path(folder_, {file.coordinate.j(), file.coordinate.i()});
    if (folder::sha256_of_text(file.bytes) != file.sha256)
        return cli::fail(cli::exit_unreadable, fmt::format("{} arrived damaged; nothing was written", path));
    return folder::put_whole(path, file.bytes);
}

void FileWriters::show_progress() {
    progress_.show(static_cast<double>(written_.size()) / static_cast<double>(total_),
                   fmt::format("pulled {}/{} sector files", written_.size(), total_));
}

}  // namespace drtv::client
