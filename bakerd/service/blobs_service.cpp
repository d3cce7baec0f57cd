#include "bakerd/service/names.h"
#include "bakerd/service/services.h"
#include "bakerd/store/text_bytes.h"
#include "map_files/limits.h"

#include <fmt/format.h>

namespace drtv::service {
namespace {

constexpr int max_blobs_a_request = 100000;

store::Result<map::Digest> checked(const v1::Blob& blob) {
    if (blob.size_bytes() < 0 || blob.size_bytes() > map_files::max_file_bytes) {
        return store::fail(store::ErrorCode::invalid_argument,
                           fmt::format("a blob of {} bytes is over the limit of 2 GiB", blob.size_bytes()));
    }
    return digest_from_text(blob.sha256());
}

}  // namespace

grpc::Status BlobsService::FindMissingBlobs(grpc::ServerContext*,
                                            const v1::FindMissingBlobsRequest* request,
                                            v1::FindMissingBlobsResponse* response) {
    if (request->blobs_size() > max_blobs_a_request)
        return failed(
            grpc::StatusCode::INVALID_ARGUMENT,
            fmt::format(
                "{} blobs in one request, the limit is {}", request->blobs_size(), max_blobs_a_request));
    for (const v1::Blob& blob : request->blobs()) {
        const auto digest = checked(blob);
        if (!digest)
            return to_status(digest.error());
        if (farm_.blobs().has(*digest))
            continue;
        auto* missing = response->add_missing();
        *missing->mutable_blob() = blob;
        missing->set_received_bytes(farm_.blobs().received_bytes(*digest));
    }
    return grpc::Status::OK;
}

grpc::Status BlobsService::UploadBlob(grpc::ServerContext*,
                                      grpc::ServerReader<v1::UploadBlobRequest>* reader,
                                      v1::UploadBlobResponse* response) {
    v1::UploadBlobRequest request;
    if (!reader->Read(&request))
        return failed(grpc::StatusCode::INVALID_ARGUMENT, "the upload has no first message");
    const v1::Blob blob = request.blob();
    const auto digest = checked(blob);
    if (!digest)
        return to_status(digest.error());
    if (request.offset() < 0 || request.offset() > blob.size_bytes())
        return failed(
            grpc::StatusCode::INVALID_ARGUMENT,
            fmt::format(
                "the offset {} lies outside the blob of {} bytes", request.offset(), blob.size_bytes()));
    *response->mutable_blob() = blob;
    if (farm_.blobs().has(*digest))
        return grpc::Status::OK;
    auto upload = farm_.blobs().upload(*digest, blob.size_bytes(), request.offset());
    if (!upload)
        return to_status(upload.error());
    do {
        if (request.data().size() > max_chunk_bytes)
            return failed(
                grpc::StatusCode::INVALID_ARGUMENT,
                fmt::format("a message of {} data bytes, the limit is 1 MiB", request.data().size()));
        if (auto appended = upload->append(store::bytes_of_text(request.data())); !appended)
            return to_status(appended.error());
    } while (reader->Read(&request));
    if (auto finished = upload->finish(); !finished)
        return to_status(finished.error());
    return grpc::Status::OK;
}

}  // namespace drtv::service
