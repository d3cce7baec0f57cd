#include "bakerd/farm/farm.h"

#include "bakerd/farm/database.h"
#include "bakerd/farm/job_store.h"
#include "bakerd/farm/maps.h"
#include "bakerd/farm/open_store.h"
#include "bakerd/farm/planner.h"
#include "bakerd/farm/recorder.h"
#include "bakerd/farm/result_cache.h"

namespace drtv::farm {

using store::Result;

Farm::Farm(Options options, std::unique_ptr<DataFolder> folder, std::unique_ptr<store::BlobStore> blobs)
    : options_(std::move(options)), folder_(std::move(folder)), blobs_(std::move(blobs)) {}

Result<std::unique_ptr<Farm>> Farm::open(Options options) {
    auto folder = DataFolder::lock(options.data_folder);
    if (!folder)
        return tl::unexpected(folder.error());
    auto blobs = open_store(options.store_folder, options.blob_folder(), **folder);
    if (!blobs)
        return tl::unexpected(blobs.error());
    (*blobs)->remove_leftovers();
    std::unique_ptr<Farm> farm(new Farm(std::move(options), std::move(*folder), std::move(*blobs)));
    if (auto loaded = farm->load(); !loaded)
        return tl::unexpected(loaded.error());
    if (auto started = farm->start(); !started)
        return tl::unexpected(started.error());
    return farm;
}

Result<void> Farm::load() {
    auto database = Database::open(folder_->database());
    if (!database)
        return tl::unexpected(database.error());
    database_ = std::move(*database);
    cache_ = std::make_unique<ResultCache>(*database_, *blobs_, options_.cache_bytes);
    if (auto opened = cache_->open(); !opened)
        return opened;
    return load_jobs(*database_, book_);
}

Result<void> Farm::start() {
    const auto owner = folder_->id();
    if (!owner)
        return tl::unexpected(owner.error());
    book_.set_turn(turn_s(options_.executor));
    recorder_ = std::make_unique<Recorder>(*database_, *cache_, book_, [this] { executor_->wake(); });
    executor::Executor::Callbacks callbacks;
    callbacks.next = [this](executor::Priority priority) { return book_.next(priority); };
    callbacks.finished = [this](executor::SectorEnd end) {
        if (auto finished = book_.finish(std::move(end)))
            recorder_->record(std::move(*finished));
    };
    callbacks.give_up = [this](std::uint64_t id) { return book_.give_up(id); };
    callbacks.is_recorded = [this](std::uint64_t id) { return !book_.knows(id); };
    auto executor =
        open_executor(options_.executor, options_.store_folder, *owner, *blobs_, std::move(callbacks));
    if (!executor)
        return tl::unexpected(executor.error());
    executor_ = std::move(*executor);
    maps_ = std::make_unique<Maps>(*database_, *blobs_, *executor_);
    planner_ = std::make_unique<Planner>(*maps_, *cache_, *blobs_, *executor_);
    executor_->wake();
    return {};
}

Farm::~Farm() {
    stop(std::chrono::milliseconds(0));
}

void Farm::stop(std::chrono::milliseconds patience) {
    if (executor_)
        executor_->stop(patience);
    if (recorder_)
        recorder_->stop();
}

Result<MapView> Farm::create_map(store::Manifest manifest) {
    return maps_->create(std::move(manifest));
}

Result<MapView> Farm::get_map(const Digest& id) {
    return maps_->get(id);
}

Result<PlanView> Farm::plan_job(const JobRequest& request) {
    CachePin pin(*cache_);
    auto planned = planner_->plan(request, pin);
    if (!planned)
        return tl::unexpected(planned.error());
    const double seconds = seconds_to_bake(planned->plan, options_.executor.threads);
    return PlanView{std::move(planned->plan), seconds};
}

Result<std::vector<JobSectorView>> Farm::list_sectors(std::int64_t id,
                                                      std::optional<map::SectorCoordinate> after,
                                                      std::int64_t count) {
    return sector_views(*database_, book_, id, after, count);
}

Result<std::vector<JobSectorView>> Farm::get_sectors(std::int64_t id,
                                                     const std::vector<map::SectorCoordinate>& sectors) {
    return sector_views(*database_, book_, id, sectors);
}

Result<SectorLog> Farm::sector_log(std::int64_t id, map::SectorCoordinate sector) {
    const auto views = get_sectors(id, {sector});
    if (!views)
        return tl::unexpected(views.error());
    return read_sector_log(options_.store_folder, id, views->front());
}

Result<CacheView> Farm::cache() {
    const auto counts = cache_->counts();
    if (!counts)
        return tl::unexpected(counts.error());
    return CacheView{*counts, cache_->max_bytes()};
}

Result<CacheView> Farm::clear_cache() {
    if (auto cleared = cache_->clear(); !cleared)
        return tl::unexpected(cleared.error());
    return cache();
}

}  // namespace drtv::farm
