#include "bakerd/service/file_sender.h"

#include "bakerd/service/names.h"
#include "bakerd/service/sector_message.h"
#include "bakerd/service/services.h"

#include <fmt/format.h>

#include <algorithm>

namespace drtv::service {
namespace {

constexpr std::size_t max_pack_bytes = max_chunk_bytes / 4, max_packed_file_bytes = max_pack_bytes / 2;

// Where the server keeps it says nothing to a client.
const char* what_is_wrong(store::ErrorCode code) {
    if (code == store::ErrorCode::not_found)
        return "is no longer kept";
    return code == store::ErrorCode::unavailable ? "cannot be read now" : "is damaged";
}

}  // namespace

bool FileSender::send(const farm::JobSectorView& view) {
    const auto bytes = blobs_.get(view.row.file);
    if (!bytes) {
        is_unreadable_ = is_unreadable_ || bytes.error().code == store::ErrorCode::unavailable;
        if (++lost_ == 1)
            first_loss_ = fmt::format("the file of sector ({}, {}) {}",
                                      view.row.sector.i,
                                      view.row.sector.j,
                                      what_is_wrong(bytes.error().code));
        return true;
    }
    if (!in_packs_ || bytes->size() > max_packed_file_bytes)
        return send_alone(view, *bytes);
    if (pack_bytes_ + bytes->size() > max_pack_bytes && !send_pack())
        return false;
    v1::PackedFile& file = *pack_.add_pack();
    file.mutable_coordinate()->set_i(view.row.sector.i);
    file.mutable_coordinate()->set_j(view.row.sector.j);
    file.set_sha256(to_hex(view.row.file));
    file.set_data(bytes->data(), bytes->size());
    pack_bytes_ += bytes->size();
    return true;
}

bool FileSender::send_alone(const farm::JobSectorView& view, const std::vector<std::uint8_t>& bytes) {
    v1::PullSectorsResponse message;
    fill_sector(view, *message.mutable_sector());
    // The first bytes come with the sector.
    for (std::size_t at = 0; at < bytes.size(); at += max_chunk_bytes) {
        message.set_data(bytes.data() + at, std::min(max_chunk_bytes, bytes.size() - at));
        if (!writer_.Write(message))
            return false;
        message.clear_sector();
    }
    return true;
}

// Nothing is held back with gRPC's own buffer hint: beyond 64 KiB it could hold a line still for 10 s.
bool FileSender::send_pack() {
    const bool is_sent = pack_.pack().empty() || writer_.Write(pack_);
    pack_.clear_pack();
    pack_bytes_ = 0;
    return is_sent;
}

grpc::Status FileSender::finish() {
    if (!send_pack())
        return grpc::Status::CANCELLED;
    if (lost_ == 0)
        return grpc::Status::OK;
    const std::string more = lost_ > 1 ? fmt::format(" (and {} more)", lost_ - 1) : "";
    if (is_unreadable_)
        return failed(grpc::StatusCode::UNAVAILABLE,
                      fmt::format("{}{}: the server's store is in trouble", first_loss_, more));
    return failed(
        grpc::StatusCode::DATA_LOSS,
        fmt::format(
            "{}{}; submit the map again to bake {} again", first_loss_, more, lost_ > 1 ? "them" : "it"));
}

}  // namespace drtv::service
