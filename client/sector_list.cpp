#include "client/sector_list.h"

#include <grpcpp/grpcpp.h>

namespace drtv::client {

SectorPages::SectorPages(const ServerConnection& connection, const std::string& job)
    : connection_(connection) {
    request_.set_job(job);
    request_.set_page_size(2'000);
    fetch();
}

void SectorPages::fetch() {
    ahead_ = std::async(std::launch::async, [&connection = connection_, request = request_] {
        Page page;
        page.status = call(*connection.sectors, &v1::Sectors::Stub::ListSectors, request, page.response);
        return page;
    });
}

cli::Result<std::optional<v1::ListSectorsResponse>> SectorPages::next() {
    if (!ahead_.valid())
        return std::nullopt;
    Page page = ahead_.get();
    if (!page.status.ok())
        return tl::unexpected(connection_.failure(page.status));
    if (!page.response.next_page_token().empty()) {
        request_.set_page_token(page.response.next_page_token());
        fetch();
    }
    return std::move(page.response);
}

cli::Result<void> for_each_sector(const ServerConnection& connection,
                                  const std::string& job,
                                  const std::function<void(const v1::Sector&)>& visit) {
    SectorPages pages(connection, job);
    for (;;) {
        const auto page = pages.next();
        if (!page)
            return tl::unexpected(page.error());
        if (!*page)
            return {};
        for (const v1::Sector& sector : (*page)->sectors())
            visit(sector);
    }
}

}  // namespace drtv::client
