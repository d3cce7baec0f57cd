#include "bakerd/worker/worker.h"

#include "bakerd/bake/sector_file.h"
#include "bakerd/reuse/footprint_record.h"
#include "bakerd/reuse/rebake.h"
#include "bakerd/worker/assess_results.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>

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

std::string too_little_memory() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_DATA, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return "the worker has not enough memory";
    return fmt::format("the worker needs more memory than its limit of {} MB", limit.rlim_cur / 1'000'000);
}

}  // namespace

tl::expected<std::unique_ptr<Worker>, std::string> Worker::open(const std::string& blob_folder) {
    auto store = store::BlobStore::open(blob_folder);
    if (!store)
        return tl::unexpected(store.error().message);
    auto device = trace::Device::open();
    if (!device)
        return tl::unexpected(device.error());
    return std::unique_ptr<Worker>(new Worker(std::move(*store), std::move(*device)));
}

Answer Worker::answer(const Request& request) {
    Answer answer;
    answer.id = request.id;
    try {
        answer.what = std::visit([this](const auto& what) { return perform(what); }, request.what);
    } catch (const std::bad_alloc&) {
        answer.what = RequestFailure{too_little_memory(), true};
    } catch (const std::exception& exception) {
        answer.what =
            RequestFailure{fmt::format("the worker met an unexpected error: {}", exception.what()), true};
    }
    return answer;
}

Worker::What Worker::perform(const InspectRequest& request) {
    const auto map = maps_.get(request.manifest);
    if (!*map)
        return map->error();
    return (*map)->summary;
}

Worker::What Worker::perform(const AssessRequest& request) {
    const auto map = maps_.get(request.manifest);
    if (!*map)
        return map->error();
    return assess_results(request, **map, *store_);
}

Worker::What Worker::perform(const BakeRequest& request) {
    const auto map = maps_.get(request.manifest);
    if (!*map)
        return map->error();
    return bake(request, **map);
}

Worker::What Worker::bake(const BakeRequest& request, const LoadedMap& map) {
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
store::Result<ResultBlobs> Worker::store_result(std::span<const std::uint8_t> file,
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

}  // namespace drtv::worker
