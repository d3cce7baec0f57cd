#include "bakerd/service/names.h"
#include "bakerd/service/services.h"

namespace drtv::service {
namespace {

grpc::Status answer(const store::Result<farm::CacheView>& view, v1::CacheState* response) {
    if (!view)
        return to_status(view.error());
    response->set_results(view->counts.results);
    response->set_size_bytes(view->counts.bytes);
    response->set_limit_bytes(view->limit_bytes);
    response->set_hits(view->counts.hits);
    response->set_near_hits(view->counts.near_hits);
    response->set_baked(view->counts.baked);
    return grpc::Status::OK;
}

}  // namespace

grpc::Status CacheService::GetCache(grpc::ServerContext*,
                                    const v1::GetCacheRequest*,
                                    v1::CacheState* response) {
    return answer(farm_.cache(), response);
}

grpc::Status CacheService::ClearCache(grpc::ServerContext*,
                                      const v1::ClearCacheRequest*,
                                      v1::CacheState* response) {
    return answer(farm_.clear_cache(), response);
}

}  // namespace drtv::service
