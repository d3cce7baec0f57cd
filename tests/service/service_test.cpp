// The gRPC face as a program of another language would meet it: contract, limits, statuses, health,
// reflection.
#include "bakerd/service/server.h"
#include "tests/map/gltf_builder.h"

#include "drtv/v1/blob.grpc.pb.h"
#include "drtv/v1/error.pb.h"
#include "drtv/v1/info.grpc.pb.h"
#include "drtv/v1/job.grpc.pb.h"
#include "drtv/v1/map.grpc.pb.h"
#include "drtv/v1/sector.grpc.pb.h"

#include <drtv/version.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>

namespace drtv::service {
namespace {

namespace fs = std::filesystem;
using grpc::StatusCode;

class ServiceTest : public testing::Test {
  protected:
    ServiceTest() {
        std::signal(SIGPIPE, SIG_IGN);
        folder_ = fs::temp_directory_path() / ("drtv_service_" + std::to_string(::getpid()) + "_" +
                                               testing::UnitTest::GetInstance()->current_test_info()->name());
        farm_ = farm::Farm::open(
                    {.data_folder = folder_.string(),
                     .executor = {.worker_command = {DRTV_BINARY_DIR "/bakerd", "worker", "--blobs",
                                                     (folder_ / "blobs").string(), "--threads", "1"}}})
                    .value();
        server_ = Server::start(*farm_, "127.0.0.1:0", {}, {"a class", 7}).value();
        channel_ = grpc::CreateChannel(server_->address(), grpc::InsecureChannelCredentials());
        blobs_ = v1::Blobs::NewStub(channel_);
        maps_ = v1::Maps::NewStub(channel_);
        jobs_ = v1::Jobs::NewStub(channel_);
        sectors_ = v1::Sectors::NewStub(channel_);
    }
    ~ServiceTest() override {
        farm_->stop(std::chrono::seconds(1));
        server_.reset();
        farm_.reset();
        fs::remove_all(folder_);
    }

    static v1::Blob blob_of(const std::string& bytes) {
        v1::Blob blob;
        blob.set_sha256(
            to_hex(map::digest_of({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()})));
        blob.set_size_bytes(static_cast<std::int64_t>(bytes.size()));
        return blob;
    }

    // Sends the messages of one upload.
    grpc::Status upload(const v1::Blob& blob, std::int64_t offset, const std::vector<std::string>& parts) {
        grpc::ClientContext context;
        v1::UploadBlobResponse response;
        const auto writer = blobs_->UploadBlob(&context, &response);
        bool first = true;
        for (const std::string& part : parts) {
            v1::UploadBlobRequest request;
            if (first) {
                *request.mutable_blob() = blob;
                request.set_offset(offset);
            }
            first = false;
            request.set_data(part);
            if (!writer->Write(request))
                break;
        }
        writer->WritesDone();
        return writer->Finish();
    }

    // Bytes the server has of it; -1: all.
    std::int64_t received(const v1::Blob& blob) {
        v1::FindMissingBlobsRequest request;
        *request.add_blobs() = blob;
        grpc::ClientContext context;
        v1::FindMissingBlobsResponse response;
        EXPECT_TRUE(blobs_->FindMissingBlobs(&context, request, &response).ok());
        return response.missing_size() == 0 ? -1 : response.missing(0).received_bytes();
    }

    // A flat map of 128 x 128 m on the server; its resource name.
    std::string create_flat_map() {
        test::GltfBuilder builder;
        builder.place(test::ground(64));
        const std::string gltf = builder.gltf();
        EXPECT_TRUE(upload(blob_of(gltf), 0, {gltf}).ok());
        v1::CreateMapRequest request;
        v1::MapFile* file = request.mutable_map()->add_files();
        file->set_path("flat.gltf");
        file->set_sha256(blob_of(gltf).sha256());
        file->set_size_bytes(static_cast<std::int64_t>(gltf.size()));
        request.mutable_map()->add_roots("flat.gltf");
        grpc::ClientContext context;
        v1::Map map;
        const grpc::Status status = maps_->CreateMap(&context, request, &map);
        EXPECT_TRUE(status.ok()) << status.error_message();
        EXPECT_EQ(map.sector_count(), 4);
        return map.name();
    }

    grpc::Status create_job(const std::string& map, const std::string& request_id, v1::Job& job,
                            const std::string& preset = "draft") {
        v1::CreateJobRequest request;
        request.mutable_job()->set_map(map);
        request.mutable_job()->mutable_settings()->set_preset(preset);
        request.mutable_job()->mutable_settings()->set_rays(16);
        request.set_request_id(request_id);
        grpc::ClientContext context;
        return jobs_->CreateJob(&context, request, &job);
    }

    fs::path folder_;
    std::unique_ptr<farm::Farm> farm_;
    std::unique_ptr<Server> server_;
    std::shared_ptr<grpc::Channel> channel_;
    std::unique_ptr<v1::Blobs::Stub> blobs_;
    std::unique_ptr<v1::Maps::Stub> maps_;
    std::unique_ptr<v1::Jobs::Stub> jobs_;
    std::unique_ptr<v1::Sectors::Stub> sectors_;
};

TEST_F(ServiceTest, SettingsAreCheckedAndGivenBackWhole) {
    v1::CreateJobRequest request;
    request.mutable_job()->set_map(create_flat_map());
    v1::BakeSettings& settings = *request.mutable_job()->mutable_settings();
    settings.set_preset("draft");
    const auto create = [&](v1::Job& job) {
        grpc::ClientContext context;
        return jobs_->CreateJob(&context, request, &job);
    };
    v1::Job job;
    settings.set_rays(8);
    const grpc::Status refused = create(job);
    EXPECT_EQ(refused.error_code(), StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(refused.error_message(), "rays must be a number from 16 to 65536, not 8");
    v1::ErrorDetails details;
    EXPECT_TRUE(details.ParseFromString(refused.error_details()));
    EXPECT_FALSE(details.server_version().empty());
    settings.set_rays(16);
    request.mutable_job()->set_tolerance(1);
    EXPECT_EQ(create(job).error_code(), StatusCode::INVALID_ARGUMENT);
    request.mutable_job()->set_tolerance(0);
    ASSERT_TRUE(create(job).ok());
    EXPECT_EQ(job.settings().rays(), 16u);
    EXPECT_TRUE(job.settings().has_bounces() && job.settings().has_lprt() && job.has_tolerance());
    EXPECT_EQ(job.tolerance(), 0);
}

TEST_F(ServiceTest, UploadGoesOnWhereItBroke) {
    const std::string bytes(1500000, 'x'), first = bytes.substr(0, 600000), rest = bytes.substr(600000);
    const v1::Blob blob = blob_of(bytes);
    EXPECT_EQ(received(blob), 0);
    EXPECT_EQ(upload(blob, 0, {first}).error_code(),
              StatusCode::INVALID_ARGUMENT);  // ends too early, and is kept
    EXPECT_EQ(received(blob), 600000);
    EXPECT_EQ(upload(blob, 5, {rest}).error_code(), StatusCode::ABORTED);
    EXPECT_TRUE(upload(blob, 600000, {rest}).ok());
    EXPECT_EQ(received(blob), -1);
}

TEST_F(ServiceTest, WrongUploadsAreRefusedAndLeaveNothing) {
    const v1::Blob blob = blob_of("right");
    EXPECT_EQ(upload(blob, 0, {"wrong"}).error_code(), StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(upload(blob, 0, {"right and more"}).error_code(), StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(received(blob), 0);
    v1::Blob malformed = blob;
    malformed.set_sha256("../../etc/passwd");
    EXPECT_EQ(upload(malformed, 0, {"right"}).error_code(), StatusCode::INVALID_ARGUMENT);
    const std::string large((std::size_t{1} << 20) + 1, 'x');
    EXPECT_EQ(upload(blob_of(large), 0, {large}).error_code(),
              StatusCode::INVALID_ARGUMENT);  // over 1 MiB a message
}

TEST_F(ServiceTest, SameRequestIdGivesTheSameJob) {
    const std::string map = create_flat_map();
    v1::Job first, again, other;
    ASSERT_TRUE(create_job(map, "one", first).ok());
    ASSERT_TRUE(create_job(map, "one", again).ok());
    ASSERT_TRUE(create_job(map, "two", other).ok());
    EXPECT_EQ(first.name(), again.name());
    EXPECT_NE(first.name(), other.name());
    v1::Job refused;
    EXPECT_EQ(create_job(map, "three", refused, "ultra").error_code(), StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(create_job("maps/" + std::string(64, '0'), "four", refused).error_code(),
              StatusCode::NOT_FOUND);
    EXPECT_EQ(create_job("flat", "five", refused).error_code(), StatusCode::INVALID_ARGUMENT);
}

TEST_F(ServiceTest, WatchEndsWithTheJobAndPullGivesItsFiles) {
    v1::Job job;
    ASSERT_TRUE(create_job(create_flat_map(), "", job).ok());
    v1::WatchJobRequest watch;
    watch.set_name(job.name());
    grpc::ClientContext watch_context;
    const auto reader = jobs_->WatchJob(&watch_context, watch);
    while (reader->Read(&job)) {
    }
    ASSERT_TRUE(reader->Finish().ok());
    EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
    EXPECT_EQ(job.sectors_done(), 4);

    v1::PullSectorsRequest pull;
    pull.set_job(job.name());
    grpc::ClientContext pull_context;
    const auto files = sectors_->PullSectors(&pull_context, pull);
    v1::PullSectorsResponse message;
    std::map<std::string, std::string> bytes_of;  // by digest
    std::string digest;
    while (files->Read(&message)) {
        if (message.has_sector())
            digest = message.sector().sha256();
        bytes_of[digest] += message.data();
    }
    ASSERT_TRUE(files->Finish().ok());
    for (const auto& [sha256, bytes] : bytes_of)
        EXPECT_EQ(blob_of(bytes).sha256(), sha256);
    EXPECT_EQ(bytes_of.size(), 4u);

    // The same files in packs, to a client that takes them.
    pull.set_takes_packs(true);
    grpc::ClientContext packed_context;
    const auto packs = sectors_->PullSectors(&packed_context, pull);
    std::map<std::string, std::string> packed;
    int messages = 0;
    for (; packs->Read(&message); ++messages) {
        EXPECT_FALSE(message.has_sector());
        for (const v1::PackedFile& file : message.pack())
            packed[file.sha256()] = file.data();
    }
    ASSERT_TRUE(packs->Finish().ok());
    EXPECT_EQ(messages, 1);
    EXPECT_EQ(packed, bytes_of);
}

TEST_F(ServiceTest, ListsComeInPages) {
    const std::string map = create_flat_map();
    for (int n = 0; n < 5; ++n) {
        v1::Job job;
        ASSERT_TRUE(create_job(map, "", job).ok());
    }
    v1::ListJobsRequest request;
    request.set_page_size(2);
    std::vector<std::string> names;
    for (;;) {
        grpc::ClientContext context;
        v1::ListJobsResponse page;
        ASSERT_TRUE(jobs_->ListJobs(&context, request, &page).ok());
        EXPECT_LE(page.jobs_size(), 2);
        for (const v1::Job& job : page.jobs())
            names.push_back(job.name());
        if (page.next_page_token().empty())
            break;
        request.set_page_token(page.next_page_token());
    }
    EXPECT_EQ(names, (std::vector<std::string>{"jobs/5", "jobs/4", "jobs/3", "jobs/2", "jobs/1"}));
    request.set_page_token("second");
    grpc::ClientContext context;
    v1::ListJobsResponse page;
    EXPECT_EQ(jobs_->ListJobs(&context, request, &page).error_code(), StatusCode::INVALID_ARGUMENT);
}

// The health protocol's messages are one field each: no generated code is needed to speak it.
TEST_F(ServiceTest, SaysWhatItIs) {
    const auto info = v1::Info::NewStub(channel_);
    grpc::ClientContext context;
    v1::ServerInfo told;
    ASSERT_TRUE(info->GetServerInfo(&context, {}, &told).ok());
    EXPECT_EQ(told.version(), DRTV_VERSION);
    EXPECT_EQ(told.instruction_set(), "a class");
    EXPECT_EQ(told.baker_version(), 7u);
    EXPECT_EQ(told.format_version(), "1." + std::to_string(DRTV_FORMAT_MINOR));
}

TEST_F(ServiceTest, HealthIsServing) {
    grpc::GenericStub stub(channel_);
    grpc::ClientContext context;
    grpc::CompletionQueue queue;
    grpc::ByteBuffer request, response;
    const grpc::Slice nothing("");
    request = grpc::ByteBuffer(&nothing, 1);
    const auto call = stub.PrepareUnaryCall(&context, "/grpc.health.v1.Health/Check", request, &queue);
    call->StartCall();
    grpc::Status status;
    call->Finish(&response, &status, nullptr);
    void* tag = nullptr;
    bool ok = false;
    ASSERT_TRUE(queue.Next(&tag, &ok) && ok);
    ASSERT_TRUE(status.ok()) << status.error_message();
    std::vector<grpc::Slice> slices;
    ASSERT_TRUE(response.Dump(&slices).ok());
    std::string bytes;
    for (const grpc::Slice& slice : slices)
        bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
    EXPECT_EQ(bytes, std::string("\x08\x01"));  // status: SERVING
}

TEST_F(ServiceTest, ReflectionNamesTheServices) {
    grpc::GenericStub stub(channel_);
    grpc::ClientContext context;
    grpc::CompletionQueue queue;
    const auto call =
        stub.PrepareCall(&context, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", &queue);
    void* tag = nullptr;
    bool ok = false;
    const auto step = [&] { return queue.Next(&tag, &ok) && ok; };
    call->StartCall(nullptr);
    ASSERT_TRUE(step());
    const grpc::Slice list_services(std::string("\x3a\x01*"));  // field 7, "*"
    call->WriteLast(grpc::ByteBuffer(&list_services, 1), grpc::WriteOptions(), nullptr);
    ASSERT_TRUE(step());
    grpc::ByteBuffer response;
    call->Read(&response, nullptr);
    ASSERT_TRUE(step());
    std::vector<grpc::Slice> slices;
    ASSERT_TRUE(response.Dump(&slices).ok());
    std::string bytes;
    for (const grpc::Slice& slice : slices)
        bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
    for (const char* name :
         {"drtv.v1.Blobs", "drtv.v1.Maps", "drtv.v1.Jobs", "drtv.v1.Sectors", "grpc.health.v1.Health"})
        EXPECT_NE(bytes.find(name), std::string::npos) << name;
    grpc::Status status;
    call->Finish(&status, nullptr);
    static_cast<void>(queue.Next(&tag, &ok));
}

TEST_F(ServiceTest, StoppingAnswersWatchersAndLaterCalls) {
    const std::string map = create_flat_map();
    server_->stop();
    v1::Job job;
    EXPECT_EQ(create_job(map, "", job).error_code(), StatusCode::UNAVAILABLE);
}

TEST(Server, TakenPortAndHalfTlsAreToldInASentence) {
    const fs::path folder = fs::temp_directory_path() / ("drtv_port_" + std::to_string(::getpid()));
    auto farm =
        farm::Farm::open({.data_folder = folder.string(), .executor = {.worker_command = {"/bin/false"}}})
            .value();
    const auto first = Server::start(*farm, "127.0.0.1:0", {}, {}).value();
    const auto second = Server::start(*farm, first->address(), {}, {});
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().find(first->address()), std::string::npos);
    EXPECT_NE(Server::start(*farm, "127.0.0.1:0", {.certificate = "cert.pem", .key = "", .client_ca = ""}, {})
                  .error()
                  .find("all three"),
              std::string::npos);
    EXPECT_NE(Server::start(*farm, "127.0.0.1:0",
                            {.certificate = "/nowhere/a", .key = "/nowhere/b", .client_ca = "/nowhere/c"}, {})
                  .error()
                  .find("/nowhere/a"),
              std::string::npos);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace drtv::service
