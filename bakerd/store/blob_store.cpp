#include "bakerd/store/blob_store.h"

#include "bakerd/store/durable_file.h"
#include "bakerd/store/sweep.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

namespace drtv::store {

namespace fs = std::filesystem;

Result<std::unique_ptr<BlobStore>> BlobStore::open(const std::string& folder) {
    for (const char* part : {"objects", "tmp", "uploads"}) {
        if (auto made = make_folder(folder + "/" + part); !made)
            return tl::unexpected(made.error());
    }
    return std::unique_ptr<BlobStore>(new BlobStore(folder));
}

void BlobStore::remove_leftovers() const {
    store::remove_leftovers(folder_ + "/tmp");
}

std::string BlobStore::path_of(const Digest& digest) const {
    const std::string hex = to_hex(digest);
    return fmt::format("{}/objects/{}/{}", folder_, hex.substr(0, 2), hex);
}

std::string BlobStore::part_path(const Digest& digest) const {
    return fmt::format("{}/uploads/{}.part", folder_, to_hex(digest));
}

bool BlobStore::has(const Digest& digest) const {
    return ::access(path_of(digest).c_str(), F_OK) == 0 || (errno != ENOENT && errno != ENOTDIR);
}

Result<Digest> BlobStore::put(std::span<const std::uint8_t> bytes) {
    const Digest digest = map::digest_of(bytes);
    if (has(digest))
        return digest;
    if (auto written = write_durably(folder_ + "/tmp", path_of(digest), bytes); !written)
        return tl::unexpected(written.error());
    return digest;
}

Result<std::vector<std::uint8_t>> BlobStore::get(const Digest& digest) {
    const std::string path = path_of(digest);
    auto bytes = read_all(path);
    if (!bytes)
        return fail(has(digest) ? ErrorCode::unavailable : ErrorCode::not_found, bytes.error().message);
    if (map::digest_of(*bytes) != digest) {
        ::unlink(path.c_str());
        return fail(ErrorCode::data_loss,
                    fmt::format("the stored blob {} is damaged; it was removed", to_hex(digest)));
    }
    return bytes;
}

void BlobStore::remove(const Digest& digest) const {
    ::unlink(path_of(digest).c_str());
}

std::int64_t BlobStore::received_bytes(const Digest& digest) const {
    struct stat status {};
    return ::stat(part_path(digest).c_str(), &status) == 0 ? static_cast<std::int64_t>(status.st_size) : 0;
}

Result<BlobStore::Upload> BlobStore::upload(const Digest& digest, std::int64_t size, std::int64_t offset) {
    const std::lock_guard lock(mutex_);
    if (uploading_.contains(digest))
        return fail(ErrorCode::aborted,
                    fmt::format("the blob {} is being uploaded by another client", to_hex(digest)));
    const std::int64_t received = received_bytes(digest);
    if (offset != 0 && offset != received)
        return fail(
            ErrorCode::aborted,
            fmt::format("the upload of {} must go on at {}, not {}", to_hex(digest), received, offset));
    const std::string path = part_path(digest);
    const int start_anew = offset == 0 ? O_TRUNC : 0;
    FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | start_anew, 0666));
    if (!file.is_open())
        return file_error("write", path);
    uploading_.insert(digest);
    return Upload(*this, digest, size, std::move(file), offset);
}

BlobStore::Upload::Upload(Upload&& other) noexcept
    : store_(std::exchange(other.store_, nullptr)),
      digest_(other.digest_),
      size_(other.size_),
      received_(other.received_),
      file_(std::move(other.file_)) {}

BlobStore::Upload::~Upload() {
    if (store_ == nullptr)
        return;
    file_.reset(-1);
    const std::lock_guard lock(store_->mutex_);
    store_->uploading_.erase(digest_);
}

Result<void> BlobStore::Upload::append(std::span<const std::uint8_t> bytes) {
    if (static_cast<std::int64_t>(bytes.size()) > size_ - received_) {
        ::unlink(store_->part_path(digest_).c_str());
        return fail(ErrorCode::invalid_argument,
                    fmt::format("the upload of {} is longer than its {} bytes", to_hex(digest_), size_));
    }
    if (!write_all(file_.get(), bytes))
        return file_error("write", store_->part_path(digest_));
    received_ += static_cast<std::int64_t>(bytes.size());
    return {};
}

Result<void> BlobStore::Upload::finish() {
    const std::string part = store_->part_path(digest_);
    if (received_ != size_)
        return fail(
            ErrorCode::invalid_argument,
            fmt::format("the upload of {} ended after {} of {} bytes", to_hex(digest_), received_, size_));
    if (::fsync(file_.get()) != 0 || ::close(file_.release()) != 0)
        return file_error("write", part);
    const auto bytes = read_all(part);
    if (!bytes)
        return tl::unexpected(bytes.error());
    if (map::digest_of(*bytes) != digest_) {
        ::unlink(part.c_str());
        return fail(ErrorCode::invalid_argument,
                    fmt::format("the uploaded bytes do not have the digest {}", to_hex(digest_)));
    }
    return rename_durably(part, store_->path_of(digest_));
}

}  // namespace drtv::store
