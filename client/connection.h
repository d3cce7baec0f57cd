// The way to the daemon: one channel, the five services, statuses told as sentences.
#pragma once

#include "drtv/v1/blob.grpc.pb.h"
#include "drtv/v1/cache.grpc.pb.h"
#include "drtv/v1/job.grpc.pb.h"
#include "drtv/v1/map.grpc.pb.h"
#include "drtv/v1/sector.grpc.pb.h"

#include <memory>
#include <string>

#include <tl/expected.hpp>

namespace drtv::client {

struct ConnectionOptions {
    std::string server = "127.0.0.1:7447";
    // PEM files; all or none.
    std::string tls_ca;
    std::string tls_certificate;
    std::string tls_key;
    bool json = false;  // one object a line on standard output
};

struct Connection {
    ConnectionOptions options;
    std::unique_ptr<v1::Blobs::Stub> blobs;
    std::unique_ptr<v1::Maps::Stub> maps;
    std::unique_ptr<v1::Jobs::Stub> jobs;
    std::unique_ptr<v1::Sectors::Stub> sectors;
    std::unique_ptr<v1::Cache::Stub> cache;

    // "cannot reach bakerd at 127.0.0.1:7447: is it running?" or the server's own sentence.
    [[nodiscard]] std::string sentence(const grpc::Status& status) const;
};

[[nodiscard]] tl::expected<Connection, std::string> connect(const ConnectionOptions& options);

// "bake: <sentence>" to standard error; gives exit status 1.
int complain(const std::string& sentence);

// "bake: warning: <sentence>" to standard error.
void warn(const std::string& sentence);

// "12" or "jobs/12" -> "jobs/12".
[[nodiscard]] std::string job_resource(const std::string& argument);

}  // namespace drtv::client
