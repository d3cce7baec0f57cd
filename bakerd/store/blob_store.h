// Blobs by SHA-256 in a folder: inputs and results. A blob appears whole or not at all (temporary file,
// fsync, rename, fsync of the folder); losing one costs work, never correctness. Thread-safe, and safe
// between processes.
#pragma once

#include "bakerd/map/digest.h"
#include "bakerd/store/error.h"
#include "bakerd/store/file_descriptor.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace drtv::store {

using map::Digest;

class BlobStore {
  public:
    // `folder` must exist; its parts are made when needed.
    [[nodiscard]] static Result<std::unique_ptr<BlobStore>> open(const std::string& folder);

    // Of uploads and of blobs that were being written (sweep.h).
    void remove_leftovers() const;

    [[nodiscard]] Result<Digest> put(std::span<const std::uint8_t> bytes);

    // Checks the digest of what it reads: a damaged blob is removed and reported as data_loss, never
    // returned. not_found: there is none; unavailable: it may be there, and cannot be read now.
    [[nodiscard]] Result<std::vector<std::uint8_t>> get(const Digest& digest);

    // False where it is certain that there is none: a store that cannot be reached may have it.
    [[nodiscard]] bool has(const Digest& digest) const;

    // Nothing happens when there is none.
    void remove(const Digest& digest) const;

    // Bytes of an unfinished upload, 0 if there is none.
    [[nodiscard]] std::int64_t received_bytes(const Digest& digest) const;

    // One client's upload of one blob: a lock on it while it lives. What was appended survives, so that a
    // later upload can go on.
    class Upload {
      public:
        Upload(Upload&& other) noexcept;
        ~Upload();
        [[nodiscard]] Result<void> append(std::span<const std::uint8_t> bytes);
        // The blob stands in the store; or invalid_argument says what was wrong: bytes of another digest are
        // thrown away, an upload that ended early is kept to go on.
        [[nodiscard]] Result<void> finish();

      private:
        friend class BlobStore;
        Upload(BlobStore& store,
               const Digest& digest,
               std::int64_t size,
               FileDescriptor file,
               std::int64_t received)
            : store_(&store), digest_(digest), size_(size), received_(received), file_(std::move(file)) {}
        BlobStore* store_;
        Digest digest_;
        std::int64_t size_;
        std::int64_t received_;
        FileDescriptor file_;
    };
    // aborted: another upload of it is under way, or `offset` is not received_bytes (0 starts anew).
    [[nodiscard]] Result<Upload> upload(const Digest& digest, std::int64_t size, std::int64_t offset);

  private:
    explicit BlobStore(std::string folder) : folder_(std::move(folder)) {}
    [[nodiscard]] std::string path_of(const Digest& digest) const;
    [[nodiscard]] std::string part_path(const Digest& digest) const;

    const std::string folder_;
    mutable std::mutex mutex_;
    std::set<Digest> uploading_;  // guarded by mutex_
};

}  // namespace drtv::store
