// What an array of tasks on a cluster has to bake: a batch of sectors for each task. Written by the daemon
// before the cluster hears of it; each task reads its own batch.
#pragma once

#include "bakerd/worker/build_id.h"
#include "bakerd/worker/requests.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::worker {

struct ArrayFile {
    BuildId build;
    std::vector<std::vector<BakeRequest>> batches;  // by task
};

[[nodiscard]] std::string encode(const ArrayFile& array);
[[nodiscard]] tl::expected<ArrayFile, std::string> decode_array(std::string_view text);

struct Batch {
    BuildId build;
    std::vector<BakeRequest> sectors;
};

// Reads no other batch. A sentence where the file cannot be read, or has no such task.
[[nodiscard]] tl::expected<Batch, std::string> read_batch(const std::string& path, std::size_t task);

}  // namespace drtv::worker
