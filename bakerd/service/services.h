// The services of proto/drtv/v1, each over the farm. Handlers run on gRPC's threads.
#pragma once

#include "bakerd/farm/farm.h"
#include "bakerd/service/server.h"

#include "drtv/v1/blob.grpc.pb.h"
#include "drtv/v1/cache.grpc.pb.h"
#include "drtv/v1/info.grpc.pb.h"
#include "drtv/v1/job.grpc.pb.h"
#include "drtv/v1/map.grpc.pb.h"
#include "drtv/v1/sector.grpc.pb.h"

#include <atomic>
#include <utility>

namespace drtv::service {

class BlobsService final : public v1::Blobs::Service {
  public:
    explicit BlobsService(farm::Farm& farm) : farm_(farm) {}
    grpc::Status FindMissingBlobs(grpc::ServerContext* context,
                                  const v1::FindMissingBlobsRequest* request,
                                  v1::FindMissingBlobsResponse* response) override;
    grpc::Status UploadBlob(grpc::ServerContext* context,
                            grpc::ServerReader<v1::UploadBlobRequest>* reader,
                            v1::UploadBlobResponse* response) override;

  private:
    farm::Farm& farm_;
};

class MapsService final : public v1::Maps::Service {
  public:
    explicit MapsService(farm::Farm& farm) : farm_(farm) {}
    grpc::Status CreateMap(grpc::ServerContext* context,
                           const v1::CreateMapRequest* request,
                           v1::Map* response) override;
    grpc::Status GetMap(grpc::ServerContext* context,
                        const v1::GetMapRequest* request,
                        v1::Map* response) override;

  private:
    farm::Farm& farm_;
};

class JobsService final : public v1::Jobs::Service {
  public:
    // `stopping` ends watches when the server does.
    JobsService(farm::Farm& farm, const std::atomic<bool>& stopping) : farm_(farm), stopping_(stopping) {}
    grpc::Status CreateJob(grpc::ServerContext* context,
                           const v1::CreateJobRequest* request,
                           v1::Job* response) override;
    grpc::Status PlanJob(grpc::ServerContext* context,
                         const v1::PlanJobRequest* request,
                         v1::Plan* response) override;
    grpc::Status GetJob(grpc::ServerContext* context,
                        const v1::GetJobRequest* request,
                        v1::Job* response) override;
    grpc::Status ListJobs(grpc::ServerContext* context,
                          const v1::ListJobsRequest* request,
                          v1::ListJobsResponse* response) override;
    grpc::Status CancelJob(grpc::ServerContext* context,
                           const v1::CancelJobRequest* request,
                           v1::Job* response) override;
    grpc::Status RetryJob(grpc::ServerContext* context,
                          const v1::RetryJobRequest* request,
                          v1::Job* response) override;
    grpc::Status RaiseJob(grpc::ServerContext* context,
                          const v1::RaiseJobRequest* request,
                          v1::Job* response) override;
    grpc::Status HoldJob(grpc::ServerContext* context,
                         const v1::HoldJobRequest* request,
                         v1::Job* response) override;
    grpc::Status ReleaseJob(grpc::ServerContext* context,
                            const v1::ReleaseJobRequest* request,
                            v1::Job* response) override;
    grpc::Status WatchJob(grpc::ServerContext* context,
                          const v1::WatchJobRequest* request,
                          grpc::ServerWriter<v1::Job>* writer) override;

  private:
    farm::Farm& farm_;
    const std::atomic<bool>& stopping_;
    std::atomic<int> watchers_{0};
};

class SectorsService final : public v1::Sectors::Service {
  public:
    explicit SectorsService(farm::Farm& farm) : farm_(farm) {}
    grpc::Status ListSectors(grpc::ServerContext* context,
                             const v1::ListSectorsRequest* request,
                             v1::ListSectorsResponse* response) override;
    grpc::Status PullSectors(grpc::ServerContext* context,
                             const v1::PullSectorsRequest* request,
                             grpc::ServerWriter<v1::PullSectorsResponse>* writer) override;
    grpc::Status GetSectorLog(grpc::ServerContext* context,
                              const v1::GetSectorLogRequest* request,
                              v1::SectorLog* response) override;

  private:
    farm::Farm& farm_;
};

class InfoService final : public v1::Info::Service {
  public:
    explicit InfoService(BuildInfo build) : build_(std::move(build)) {}
    grpc::Status GetServerInfo(grpc::ServerContext* context,
                               const v1::GetServerInfoRequest* request,
                               v1::ServerInfo* response) override;

  private:
    const BuildInfo build_;
};

class CacheService final : public v1::Cache::Service {
  public:
    explicit CacheService(farm::Farm& farm) : farm_(farm) {}
    grpc::Status GetCache(grpc::ServerContext* context,
                          const v1::GetCacheRequest* request,
                          v1::CacheState* response) override;
    grpc::Status ClearCache(grpc::ServerContext* context,
                            const v1::ClearCacheRequest* request,
                            v1::CacheState* response) override;

  private:
    farm::Farm& farm_;
};

// Bytes of data in one message, upload and download.
inline constexpr std::size_t max_chunk_bytes = std::size_t{1} << 20;

}  // namespace drtv::service
