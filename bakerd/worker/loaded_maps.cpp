#include "bakerd/worker/loaded_maps.h"

#include "bakerd/map/import.h"
#include "bakerd/map/survey.h"
#include "bakerd/store/manifest.h"
#include "bakerd/store/text_bytes.h"

namespace drtv::worker {
namespace {

// The map at work and the one before: an undo finds its scene still there.
constexpr std::size_t kept_maps = 2;

MapSummary summary_of(const bake::World& world, const map::Survey& survey, const Digest& inventory) {
    const map::Map& map = world.map();
    MapSummary summary;
    summary.content = map.content;
    summary.inventory = inventory;
    summary.sectors = world.sectors();
    summary.survey = survey;
    summary.warnings = map::doubts_about(survey);
    summary.warnings.insert(summary.warnings.end(), map.warnings.begin(), map.warnings.end());
    summary.warnings.insert(summary.warnings.end(), world.warnings().begin(), world.warnings().end());
    return summary;
}

tl::unexpected<RequestFailure> failed(std::string sentence, bool may_retry) {
    return tl::unexpected(RequestFailure{std::move(sentence), may_retry});
}

}  // namespace

LoadedMaps::LoadedMaps(store::BlobStore& store, std::shared_ptr<const trace::Device> device)
    : store_(store),
      device_(std::move(device)),
      shelf_(std::make_shared<trace::MeshShelf>()),
      maps_(kept_maps) {}

// A failure is not worth keeping: its reason may pass.
std::shared_ptr<const LoadResult> LoadedMaps::get(const Digest& manifest) {
    return maps_.get_if(
        manifest,
        [&] { return load(manifest); },
        [](const LoadResult& result) { return result.has_value(); });
}

LoadResult LoadedMaps::load(const Digest& digest) const {
    const auto bytes = store_.get(digest);
    if (!bytes)
        return failed(bytes.error().message, true);
    const auto manifest = store::decode_manifest(store::text_of_bytes(*bytes));
    if (!manifest)
        return failed(manifest.error().message, false);
    auto imported = map::import_map(manifest->roots, store::manifest_source(*manifest, store_));
    if (!imported)
        return failed(imported.error(), false);
    const map::Survey survey = map::survey_of(*imported);
    if (auto checked = map::check_survey(survey); !checked)
        return failed(checked.error(), false);
    auto world = bake::World::open(device_, std::make_shared<const map::Map>(std::move(*imported)), shelf_);
    if (!world)
        return failed(world.error(), false);
    auto inventory = std::make_shared<const reuse::Inventory>(reuse::take_inventory(**world));
    const auto inventory_digest = store_.put(reuse::encode_inventory(*inventory));
    if (!inventory_digest)
        return failed(inventory_digest.error().message, true);
    return LoadedMap{*world,
                     summary_of(**world, survey, *inventory_digest),
                     inventory,
                     std::make_shared<ChangesSince>(inventory, store_)};
}

}  // namespace drtv::worker
