// The sectors of a job, as the server knows them.
#pragma once

#include "client/connection.h"

#include <functional>
#include <future>
#include <optional>
#include <string>

namespace drtv::client {

// A job's sectors page by page, in the order of (j, i). The next page is fetched while the caller works on
// one. REQUIRES: the connection outlives it.
class SectorPages {
  public:
    // `job` is the resource's name.
    SectorPages(const ServerConnection& connection, const std::string& job);

    // Nothing after the last page.
    [[nodiscard]] cli::Result<std::optional<v1::ListSectorsResponse>> next();

  private:
    struct Page {
        grpc::Status status;
        v1::ListSectorsResponse response;
    };
    void fetch();

    const ServerConnection& connection_;
    v1::ListSectorsRequest request_;
    std::future<Page> ahead_;  // none: the last page has been given
};

// Visits them in the order of (j, i); `job` is its resource's name.
[[nodiscard]] cli::Result<void> for_each_sector(const ServerConnection& connection,
                                                const std::string& job,
                                                const std::function<void(const v1::Sector&)>& visit);

}  // namespace drtv::client
