// The files of a pull on their way to the client.
#pragma once

#include "bakerd/farm/farm.h"
#include "drtv/v1/sector.grpc.pb.h"

#include <cstdint>
#include <string>

namespace drtv::service {

class FileSender {
  public:
    // In packs, small files share a message: one message costs as much as some 20 KiB of a file.
    FileSender(store::BlobStore& blobs, grpc::ServerWriter<v1::PullSectorsResponse>& writer, bool in_packs)
        : blobs_(blobs), writer_(writer), in_packs_(in_packs) {}

    // Of a sector that is done. A file that is gone or damaged is left to finish(). False once the client has
    // left.
    [[nodiscard]] bool send(const farm::JobSectorView& view);

    // DATA_LOSS when a file could not be sent.
    [[nodiscard]] grpc::Status finish();

  private:
    [[nodiscard]] bool send_alone(const farm::JobSectorView& view, const std::vector<std::uint8_t>& bytes);
    [[nodiscard]] bool send_pack();

    store::BlobStore& blobs_;
    grpc::ServerWriter<v1::PullSectorsResponse>& writer_;
    const bool in_packs_;
    v1::PullSectorsResponse pack_;
    std::size_t pack_bytes_ = 0;
    std::int64_t lost_ = 0;
    bool is_unreadable_ = false;  // a file may be there, and cannot be read
    std::string first_loss_;
};

}  // namespace drtv::service
