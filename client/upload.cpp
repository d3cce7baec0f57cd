#include "client/upload.h"

#include "client/interrupt.h"
#include "client/number_text.h"
#include "client/progress.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <thread>
#include <vector>

namespace drtv::client {
namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 20;
// Another client may be uploading the same blob, or the line may break: the rest is tried again, this long
// after anything of it arrived.
constexpr std::chrono::seconds upload_patience{60};
constexpr std::chrono::milliseconds upload_pause{200};
constexpr auto interrupted_upload = "interrupted; what was uploaded stays with the server";

struct Transfer {
    std::int64_t sent = 0;
    std::int64_t total = 0;
    Progress progress;

    void show() {
        const double share = total == 0 ? 1 : static_cast<double>(sent) / static_cast<double>(total);
        const double sent_mb = in_megabytes(sent);
        const double total_mb = in_megabytes(total);
        progress.show(share, fmt::format("uploading {:.1f} of {:.1f} MB", sent_mb, total_mb));
    }
};

bool is_passing(const grpc::Status& status) {
    const grpc::StatusCode code = status.error_code();
    return code == grpc::StatusCode::ABORTED || code == grpc::StatusCode::UNAVAILABLE;
}

grpc::Status find_missing(ServerConnection& connection,
                          const std::vector<const MapContentFile*>& files,
                          v1::FindMissingBlobsResponse& response) {
    v1::FindMissingBlobsRequest request;
    for (const MapContentFile* file : files) {
        v1::Blob* blob = request.add_blobs();
        blob->set_sha256(file->sha256);
        blob->set_size_bytes(file->size_bytes);
    }
    return call(*connection.blobs, &v1::Blobs::Stub::FindMissingBlobs, request, response);
}

cli::Result<grpc::Status> send_blob(ServerConnection& connection,
                                    const MapContentFile& file,
                                    std::int64_t offset,
                                    Transfer& transfer) {
    std::ifstream input(file.disk_path, std::ios::binary);
    input.seekg(offset);
    if (!input)
        return cli::fail(cli::exit_unreadable,
                         fmt::format("cannot read {}: {}", file.disk_path, std::strerror(errno)));
    grpc::ClientContext context;
    const InterruptGuard guard(context, interrupted_upload);
    v1::UploadBlobResponse response;
    const auto writer = connection.blobs->UploadBlob(&context, &response);
    v1::UploadBlobRequest request;
    request.mutable_blob()->set_sha256(file.sha256);
    request.mutable_blob()->set_size_bytes(file.size_bytes);
    request.set_offset(offset);
    std::string buffer(chunk_bytes, '\0');
    const auto buffer_size = static_cast<std::streamsize>(buffer.size());
    bool first = true;
    while (input.read(buffer.data(), buffer_size) || input.gcount() > 0 || first) {
        request.set_data(buffer.data(), static_cast<std::size_t>(input.gcount()));
        if (!writer->Write(request))
            break;  // Finish says why
        transfer.sent += input.gcount();
        transfer.show();
        request.clear_blob();
        request.clear_offset();
        first = false;
    }
    writer->WritesDone();
    return writer->Finish();
}

cli::Result<void> upload_file(ServerConnection& connection, const MapContentFile& file, Transfer& transfer) {
    const std::int64_t sent_before = transfer.sent;
    std::int64_t known_bytes = -1;
    auto last_progress = std::chrono::steady_clock::now();
    grpc::Status status;
    for (bool first = true; !interrupted(); first = false) {
        if (!first)
            std::this_thread::sleep_for(upload_pause);
        v1::FindMissingBlobsResponse missing;
        status = find_missing(connection, {&file}, missing);
        if (status.ok() && missing.missing_size() == 0) {
            transfer.sent = sent_before + file.size_bytes;
            return {};
        }
        if (status.ok()) {
            const std::int64_t received_bytes = missing.missing(0).received_bytes();
            if (received_bytes != known_bytes)
                last_progress = std::chrono::steady_clock::now();
            known_bytes = received_bytes;
            const std::int64_t offset = received_bytes <= file.size_bytes ? received_bytes : 0;
            transfer.sent = sent_before + offset;
            transfer.show();
            const auto sent = send_blob(connection, file, offset, transfer);
            if (!sent)
                return tl::unexpected(sent.error());
            status = *sent;
            if (status.ok())
                return {};
        }
        // Another client that sends the same file brings it here as well; a daemon that restarts is away for
        // a moment.
        if (!is_passing(status) || std::chrono::steady_clock::now() - last_progress > upload_patience)
            break;
    }
    if (interrupted())
        return cli::fail(cli::exit_interrupted, interrupted_upload);
    // It changed while it was uploaded.
    const cli::Failure failure = connection.failure(status, cli::exit_unreadable);
    return cli::fail(failure.code, fmt::format("cannot upload {}: {}", file.disk_path, failure.sentence));
}

cli::Result<void> upload_missing(ServerConnection& connection,
                                 const MapContents& map,
                                 const v1::FindMissingBlobsResponse& missing) {
    Transfer transfer;
    for (const auto& wanted : missing.missing())
        transfer.total += wanted.blob().size_bytes();
    for (const auto& wanted : missing.missing()) {
        const auto file = std::ranges::find(map.files, wanted.blob().sha256(), &MapContentFile::sha256);
        if (auto uploaded = upload_file(connection, *file, transfer); !uploaded)
            return uploaded;
    }
    return {};
}

v1::CreateMapRequest creation_of(const MapContents& map) {
    v1::CreateMapRequest request;
    for (const MapContentFile& file : map.files) {
        v1::MapFile* added = request.mutable_map()->add_files();
        added->set_path(file.map_path);
        added->set_sha256(file.sha256);
        added->set_size_bytes(file.size_bytes);
    }
    for (const std::string& root : map.roots)
        request.mutable_map()->add_roots(root);
    return request;
}

}  // namespace

cli::Result<v1::Map> upload_map(ServerConnection& connection, const MapContents& map) {
    std::vector<const MapContentFile*> all;
    for (const MapContentFile& file : map.files)
        all.push_back(&file);
    v1::FindMissingBlobsResponse missing;
    if (const grpc::Status status = find_missing(connection, all, missing); !status.ok())
        return tl::unexpected(connection.failure(status));
    if (auto uploaded = upload_missing(connection, map, missing); !uploaded)
        return tl::unexpected(uploaded.error());
    v1::Map created;
    const grpc::Status status = call(*connection.maps, &v1::Maps::Stub::CreateMap, creation_of(map), created);
    if (!status.ok())
        return tl::unexpected(connection.failure(status, cli::exit_invalid));
    return created;
}

}  // namespace drtv::client
