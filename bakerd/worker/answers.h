// What tasks on a cluster answer: a file for each sector, in the store's folder "answers". It stands there
// when, and only when, the sector is done, whatever the cluster says of the task.
#pragma once

#include "bakerd/store/error.h"
#include "bakerd/worker/requests.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace drtv::worker {

// The same for all requests that have the same answer from this build: an earlier result only saves work.
[[nodiscard]] Digest answer_key(const BakeRequest& request);

struct TaskAnswer {
    std::variant<SectorResult, RequestFailure> what;
    std::string node;
    std::string log;                     // file of the task's log, for people
    std::int64_t peak_memory_bytes = 0;  // of the task so far
    double load_seconds = 0;             // that passed before the task could bake
};

class Answers {
  public:
    // Makes the folder where it is missing.
    [[nodiscard]] static store::Result<Answers> open(const std::string& store_folder);

    [[nodiscard]] store::Result<void> write(const Digest& key, const TaskAnswer& answer) const;

    // Those of the keys that have an answer; sorted, as the keys must be. Lists folders: over NFS, asking for
    // a name that is not there yet would hide it for a minute.
    [[nodiscard]] std::vector<Digest> among(std::span<const Digest> keys) const;

    // Nothing where it cannot be read, or is none.
    [[nodiscard]] std::optional<TaskAnswer> read(const Digest& key) const;

    // Those among the keys that can be read, with some threads of its own: over a network each file is a wait
    // of a millisecond.
    [[nodiscard]] std::vector<std::pair<Digest, TaskAnswer>> find(std::span<const Digest> keys) const;

    // Nothing happens where there is none.
    void remove(std::span<const Digest> keys) const;

  private:
    explicit Answers(std::string folder) : folder_(std::move(folder)) {}
    [[nodiscard]] std::string folder_of(const std::string& hex) const;
    [[nodiscard]] std::string path_of(const Digest& key) const;

    std::string folder_;
};

}  // namespace drtv::worker
