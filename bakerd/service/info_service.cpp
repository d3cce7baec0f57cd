#include "bakerd/service/services.h"

#include <drtv/version.h>

namespace drtv::service {

grpc::Status InfoService::GetServerInfo(grpc::ServerContext*,
                                        const v1::GetServerInfoRequest*,
                                        v1::ServerInfo* response) {
    response->set_version(DRTV_VERSION);
    response->set_instruction_set(build_.instruction_set);
    response->set_baker_version(build_.baker_version);
    response->set_format_version("1." + std::to_string(DRTV_FORMAT_MINOR));
    return grpc::Status::OK;
}

}  // namespace drtv::service
