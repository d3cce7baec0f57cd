#include "bakerd/worker/worker.h"

#include "bakerd/bake/sector_file.h"
#include "bakerd/reuse/footprint_record.h"
#include "bakerd/reuse/rebake.h"
#include "bakerd/store/blob_store.h"
#include "bakerd/worker/assess_results.h"
#include "bakerd/worker/loaded_maps.h"
#include "bakerd/worker/protocol.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <mutex>
#include <thread>

namespace drtv::worker {
namespace {

SectorNumbers numbers_of(const Sector& sector) {
    const Statistics& statistics = sector.statistics;
    SectorNumbers numbers;
    numbers.candidates = statistics.candidates;
    numbers.moved_out = statistics.moved_out;
    numbers.dropped_in_solid = statistics.dropped_in_solid;
    numbers.removed_by_volume = statistics.removed_by_volume;
    numbers.thinned = statistics.thinned;
    // All other places have a probe.
    const auto manual = std::ranges::count(sector.probes, ProbeKind::manual, &Probe::kind);
    numbers.too_near = numbers.candidates - numbers.dropped_in_solid - numbers.removed_by_volume -
                       numbers.thinned - (static_cast<std::int64_t>(sector.probes.size()) - manual);
    if (const auto& convergence = sector.convergence) {
        numbers.error_median = static_cast<double>(convergence->error_median);
        numbers.error_p95 = static_cast<double>(convergence->error_p95);
        numbers.error_max = static_cast<double>(convergence->error_max);
    }
    if (sector.quality)
        numbers.budget_ended = std::ranges::count(sector.quality->probes, true, &ProbeQuality::budget_ended);
    return numbers;
}

class Worker {
  public:
    Worker(std::unique_ptr<store::BlobStore> store,
           std::shared_ptr<const trace::Device> device,
           std::FILE* out)
        : store_(std::move(store)), maps_(*store_, std::move(device)), out_(out) {}

    void answer(const Request& request) {
        Answer answer;
        answer.id = request.id;
        try {
            answer.what = std::visit([this](const auto& what) { return perform(what); }, request.what);
        } catch (const std::bad_alloc&) {
            answer.what = RequestFailure{"the worker has not enough memory", true};
        } catch (const std::exception& exception) {
            answer.what =
                RequestFailure{fmt::format("the worker met an unexpected error: {}", exception.what()), true};
        }
        const std::string line = encode(answer);
        const std::lock_guard lock(out_mutex_);
        std::fprintf(out_, "%s\n", line.c_str());
        std::fflush(out_);
    }

  private:
    using What = decltype(Answer::what);

    What perform(const InspectRequest& request) {
        const auto map = maps_.get(request.manifest);
        if (!*map)
            return map->error();
        return (*map)->summary;
    }

    What perform(const AssessRequest& request) {
        const auto map = maps_.get(request.manifest);
        if (!*map)
            return map->error();
        return assess_results(request, **map, *store_);
    }

    What perform(const BakeRequest& request) {
        const auto map = maps_.get(request.manifest);
        if (!*map)
            return map->error();
        return bake(request, **map);
    }

    What bake(const BakeRequest& request, const LoadedMap& map) {
        bake::Stopwatch stopwatch;
        const trace::FloatMode float_mode;
        std::optional<reuse::EarlierBake> earlier;
        if (request.earlier) {
            auto read = read_earlier(*request.earlier, request.sector, request.settings, map, *store_);
            if (read)
                earlier = std::move(*read);
            else
                spdlog::warn("{}", read.error());  // all of it is baked then
        }
        auto rebake = reuse::bake_and_record(
            *map.world, request.sector, request.settings.bake, earlier ? &*earlier : nullptr);
        if (!rebake)
            return RequestFailure{rebake.error(), false};
        bake::BakedSector& baked = rebake->baked;
        const auto file = bake::encode_sector(baked.sector, baked.warnings);
        if (!file)
            return RequestFailure{file.error(), false};
        const std::vector<std::uint8_t> footprint = reuse::encode_footprint(rebake->footprint);
        const auto blobs = store_result(*file, footprint, map);
        if (!blobs)
            return RequestFailure{blobs.error().message, true};
        SectorResult result;
        result.blobs = *blobs;
        result.file_bytes = static_cast<std::int64_t>(file->size());
        result.footprint_bytes = static_cast<std::int64_t>(footprint.size());
        result.probes = static_cast<std::int64_t>(baked.sector.probes.size());
        result.rays = static_cast<std::int64_t>(baked.sector.statistics.rays);
        result.numbers = numbers_of(baked.sector);
        result.warnings = std::move(baked.warnings);
        result.seconds = stopwatch.lap();
        result.stages = baked.seconds;
        result.stages.files = std::max(0.0, result.seconds - baked.seconds.total());
        result.bound = rebake->footprint.bound();
        return result;
    }

    // The file last: a result without its records could never be found again.
    store::Result<ResultBlobs> store_result(std::span<const std::uint8_t> file,
                                            std::span<const std::uint8_t> footprint,
                                            const LoadedMap& map) {
        ResultBlobs blobs;
        blobs.inventory = map.summary.inventory;
        // It may have been evicted since the map was inspected.
        if (!store_->has(blobs.inventory)) {
            const auto put = store_->put(reuse::encode_inventory(*map.inventory));
            if (!put)
                return tl::unexpected(put.error());
        }
        const auto footprint_digest = store_->put(footprint);
        if (!footprint_digest)
            return tl::unexpected(footprint_digest.error());
        const auto file_digest = store_->put(file);
        if (!file_digest)
            return tl::unexpected(file_digest.error());
        blobs.footprint = *footprint_digest;
        blobs.file = *file_digest;
        return blobs;
    }

    const std::unique_ptr<store::BlobStore> store_;
    LoadedMaps maps_;
    std::mutex out_mutex_;
    std::FILE* const out_;  // guarded by out_mutex_
};

// The protocol's stream; file descriptor 1 becomes standard error for everyone else.
std::FILE* take_standard_output() {
    const int fd = ::dup(STDOUT_FILENO);
    if (fd < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
        return nullptr;
    return ::fdopen(fd, "w");
}

}  // namespace

tl::expected<void, std::string> run_worker(const Options& options) {
    // Dies with the daemon, whatever kills it.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    std::FILE* out = take_standard_output();
    auto store = store::BlobStore::open(options.blob_folder);
    if (!store)
        return tl::unexpected(store.error().message);
    auto device = trace::Device::open();
    if (!device)
        return tl::unexpected(device.error());
    if (out == nullptr)
        return tl::unexpected(std::string("cannot take over standard output"));
    const int threads =
        options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
    // One more than the arena's: this thread, which only reads.
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads) + 1);
    tbb::task_arena arena(threads, 0);
    tbb::task_group in_flight;
    Worker worker(std::move(*store), *device, out);
    std::string line;
    while (std::getline(std::cin, line)) {
        const auto request = decode_request(line);
        if (!request)
            return tl::unexpected("the worker was sent a line it does not understand: " +
                                  line.substr(0, 200));
        arena.enqueue(in_flight.defer([&worker, request = *request] { worker.answer(request); }));
    }
    // The daemon has gone or wants no more: what is left has no reader.
    std::fflush(out);
    std::_Exit(0);
}

}  // namespace drtv::worker
