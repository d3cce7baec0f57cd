#include "client/sector_list.h"

#include <grpcpp/grpcpp.h>

namespace drtv::client {

cli::Result<void> for_each_sector(const ServerConnection& connection,
                                  const std::string& job,
                                  const std::function<void(const v1::Sector&)>& visit) {
    v1::ListSectorsRequest request;
    request.set_job(job);
    request.set_page_size(2'000);
    for (;;) {
        v1::ListSectorsResponse response;
        const grpc::Status status =
            call(*connection.sectors, &v1::Sectors::Stub::ListSectors, request, response);
        if (!status.ok())
            return tl::unexpected(connection.failure(status));
        for (const v1::Sector& sector : response.sectors())
            visit(sector);
        if (response.next_page_token().empty())
            return {};
        request.set_page_token(response.next_page_token());
    }
}

}  // namespace drtv::client
