// Answers requests. It keeps the last maps imported and their scenes warm, so that the next edit starts at
// once.
#pragma once

#include "bakerd/store/blob_store.h"
#include "bakerd/trace/device.h"
#include "bakerd/worker/loaded_maps.h"
#include "bakerd/worker/requests.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <tl/expected.hpp>

namespace drtv::worker {

class Worker {
  public:
    // A sentence where the folder or this machine will not do.
    [[nodiscard]] static tl::expected<std::unique_ptr<Worker>, std::string> open(
        const std::string& blob_folder);

    // Runs on the calling thread's TBB arena. Throws nothing. Thread-safe.
    [[nodiscard]] Answer answer(const Request& request);

  private:
    using What = decltype(Answer::what);

    Worker(std::unique_ptr<store::BlobStore> store, std::shared_ptr<const trace::Device> device)
        : store_(std::move(store)), maps_(*store_, std::move(device)) {}

    [[nodiscard]] What perform(const InspectRequest& request);
    [[nodiscard]] What perform(const AssessRequest& request);
    [[nodiscard]] What perform(const BakeRequest& request);
    [[nodiscard]] What bake(const BakeRequest& request, const LoadedMap& map);
    [[nodiscard]] store::Result<ResultBlobs> store_result(std::span<const std::uint8_t> file,
                                                          std::span<const std::uint8_t> footprint,
                                                          const LoadedMap& map);

    const std::unique_ptr<store::BlobStore> store_;
    LoadedMaps maps_;
};

}  // namespace drtv::worker
