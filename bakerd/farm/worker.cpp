#include "bakerd/farm/worker.h"

#include "bakerd/bake/sector_file.h"
#include "bakerd/farm/assess_results.h"
#include "bakerd/farm/blob_store.h"
#include "bakerd/farm/manifest.h"
#include "bakerd/farm/worker_protocol.h"
#include "bakerd/map/import.h"
#include "bakerd/reuse/footprint_record.h"
#include "bakerd/reuse/inventory.h"
#include "bakerd/reuse/rebake.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <future>
#include <iostream>
#include <list>
#include <mutex>
#include <thread>

namespace drtv::farm {
namespace {

// The map at work and the one before: an undo finds its scene still there.
constexpr std::size_t kept_maps = 2;

struct LoadedMap {
    std::shared_ptr<bake::World> world;
    InspectAnswer summary;
    std::shared_ptr<const reuse::Inventory> inventory;
    std::shared_ptr<ChangesSince> changes;
};

using MapResult = tl::expected<LoadedMap, FailureAnswer>;

class Worker {
  public:
    Worker(std::unique_ptr<BlobStore> store, std::shared_ptr<const trace::Device> device, std::FILE* out)
        : store_(std::move(store)), device_(std::move(device)), out_(out) {}

    void answer(const WorkerRequest& request) {
        WorkerAnswer answer;
        std::visit([&](const auto& r) { answer.id = r.id; }, request);
        try {
            answer.what = std::visit([this](const auto& r) { return perform(r); }, request);
        } catch (const std::bad_alloc&) {
            answer.what = FailureAnswer{"the worker has not enough memory", true};
        } catch (const std::exception& exception) {
            answer.what =
                FailureAnswer{fmt::format("the worker met an unexpected error: {}", exception.what()), true};
        }
        const std::string text = encode(answer);
        const std::lock_guard lock(out_mutex_);
        std::fprintf(out_, "%s\n", text.c_str());
        std::fflush(out_);
    }

  private:
    using What = decltype(WorkerAnswer::what);

    What perform(const InspectRequest& request) {
        const MapResult loaded = map_of(request.manifest);
        if (!loaded)
            return loaded.error();
        return loaded->summary;
    }

    What perform(const BakeRequest& request) {
        const MapResult loaded = map_of(request.manifest);
        if (!loaded)
            return loaded.error();
        const auto start = std::chrono::steady_clock::now();
        const trace::FloatMode float_mode;
        const std::optional<reuse::EarlierBake> earlier =
            read_earlier(request, *loaded->world, *loaded->changes, *store_);
        auto rebake = reuse::bake_and_record(
            *loaded->world, request.sector, request.settings, earlier ? &*earlier : nullptr);
        if (!rebake)
            return FailureAnswer{rebake.error(), false};
        bake::BakedSector& baked = rebake->baked;
        const auto bytes = bake::encode_sector(baked.sector, baked.warnings);
        if (!bytes)
            return FailureAnswer{bytes.error(), false};
        const std::vector<std::uint8_t> footprint = reuse::encode_footprint(rebake->footprint);
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        // Lost when nothing rested on it any more.
        if (!store_->has(loaded->summary.inventory) &&
            !store_->put(reuse::encode_inventory(*loaded->inventory)))
            return FailureAnswer{"the map's record cannot be stored", true};
        // The footprint first: a result without one could never be found again.
        const auto footprint_digest = store_->put(footprint),
                   digest = footprint_digest ? store_->put(*bytes) : footprint_digest;
        if (!digest)
            return FailureAnswer{digest.error().message, true};
        const Sector& sector = baked.sector;
        return BakeAnswer{*digest,
                          static_cast<std::int64_t>(bytes->size()),
                          static_cast<std::int64_t>(sector.probes.size()),
                          static_cast<std::int64_t>(sector.statistics.rays),
                          baked.warnings,
                          *footprint_digest,
                          loaded->summary.inventory,
                          static_cast<std::int64_t>(footprint.size()),
                          seconds,
                          rebake->footprint.bound()};
    }

    What perform(const AssessRequest& request) {
        const MapResult loaded = map_of(request.manifest);
        if (!loaded)
            return loaded.error();
        return assess_results(request, *loaded->world, *loaded->changes, *store_);
    }

    // Imports a map once, however many requests ask for it at the same time.
    MapResult map_of(const Digest& manifest) {
        std::promise<MapResult> promise;
        std::shared_future<MapResult> future;
        bool ours = false;
        {
            const std::lock_guard lock(maps_mutex_);
            auto found = std::find_if(
                maps_.begin(), maps_.end(), [&](const Entry& entry) { return entry.manifest == manifest; });
            if (found == maps_.end()) {
                ours = true;
                maps_.push_front({manifest, promise.get_future().share()});
                while (maps_.size() > kept_maps)
                    maps_.pop_back();
            } else {
                maps_.splice(maps_.begin(), maps_, found);
            }
            future = maps_.front().result;
        }
        if (!ours)
            return future.get();
        try {
            promise.set_value(load(manifest));
        } catch (...) {
            promise.set_exception(std::current_exception());
            forget(manifest);
        }
        const MapResult& result = future.get();
        if (!result)
            forget(manifest);
        return result;
    }

    // A failure is not worth keeping: its reason may pass.
    void forget(const Digest& manifest) {
        const std::lock_guard lock(maps_mutex_);
        maps_.remove_if([&](const Entry& entry) { return entry.manifest == manifest; });
    }

    MapResult load(const Digest& digest) {
        const auto bytes = store_->get(digest);
        if (!bytes)
            return tl::unexpected(FailureAnswer{bytes.error().message, true});
        const auto manifest = decode_manifest({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
        if (!manifest)
            return tl::unexpected(FailureAnswer{manifest.error().message, false});
        auto imported = map::import_map(manifest->roots, manifest_source(*manifest, *store_));
        if (!imported)
            return tl::unexpected(FailureAnswer{imported.error(), false});
        auto map = std::make_shared<const map::Map>(std::move(*imported));
        auto world = bake::World::open(device_, map, shelf_);
        if (!world)
            return tl::unexpected(FailureAnswer{world.error(), false});
        auto inventory = std::make_shared<const reuse::Inventory>(reuse::take_inventory(**world));
        const auto inventory_digest = store_->put(reuse::encode_inventory(*inventory));
        if (!inventory_digest)
            return tl::unexpected(FailureAnswer{inventory_digest.error().message, true});
        LoadedMap loaded{*world,
                         {map->content,
                          *inventory_digest,
                          (*world)->sectors_with_ground(),
                          static_cast<std::int64_t>(map->objects.size()),
                          0,
                          map->warnings},
                         inventory,
                         std::make_shared<ChangesSince>(inventory, *store_)};
        loaded.summary.warnings.insert(
            loaded.summary.warnings.end(), (*world)->warnings().begin(), (*world)->warnings().end());
        for (const map::Object& object : map->objects) {
            for (const map::Primitive& primitive : map->meshes[object.mesh].primitives)
                loaded.summary.triangle_count += static_cast<std::int64_t>(primitive.triangles.size());
        }
        return loaded;
    }

    struct Entry {
        Digest manifest;
        std::shared_future<MapResult> result;
    };

    const std::unique_ptr<BlobStore> store_;
    const std::shared_ptr<const trace::Device> device_;
    const std::shared_ptr<trace::MeshShelf> shelf_ =
        std::make_shared<trace::MeshShelf>();  // an edit leaves most meshes as they were
    std::mutex out_mutex_;
    std::FILE* const out_;  // guarded by out_mutex_
    std::mutex maps_mutex_;
    std::list<Entry> maps_;  // guarded by maps_mutex_; most recently used first
};

// The protocol's stream; file descriptor 1 becomes standard error for everyone else.
std::FILE* take_standard_output() {
    const int fd = ::dup(STDOUT_FILENO);
    if (fd < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
        return nullptr;
    return ::fdopen(fd, "w");
}

}  // namespace

int run_worker(const WorkerOptions& options) {
    // Dies with the daemon, whatever kills it.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    std::FILE* out = take_standard_output();
    auto store = BlobStore::open(options.blob_folder);
    auto device = trace::Device::open();
    if (out == nullptr || !store || !device) {
        spdlog::error("{}",
                      !store    ? store.error().message
                      : !device ? device.error()
                                : "cannot take over standard output");
        return 1;
    }
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
        if (!request) {
            spdlog::error("the worker was sent a line it does not understand: {}", line.substr(0, 200));
            return 1;
        }
        arena.enqueue(in_flight.defer([&worker, request = *request] { worker.answer(request); }));
    }
    // The daemon has gone or wants no more: what is left has no reader.
    std::fflush(out);
    std::_Exit(0);
}

}  // namespace drtv::farm
