#include "bakerd/picture/shot.h"

#include "bakerd/picture/ground_probes.h"
#include "bakerd/picture/rectangle.h"
#include "bakerd/picture/view_arguments.h"
#include "bakerd/trace/device.h"
#include "format/cli/report.h"
#include "format/kit/files.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::picture {
namespace {

// Sectors so far from the camera are loaded; beyond, the open sky lights.
constexpr float sectors_m = 2048;
constexpr float over_the_top_m = 1;

// The picture's shape around a part of the world.
trace::WorldRectangle widened(const trace::WorldRectangle& world, Size size) {
    const glm::vec2 middle = (world.low + world.high) / 2.0f;
    glm::vec2 half = (world.high - world.low) / 2.0f;
    const float shape = static_cast<float>(size.width) / static_cast<float>(size.height);
    half = {std::max(half.x, half.y * shape), std::max(half.y, half.x / shape)};
    return {middle - half, middle + half};
}

}  // namespace

cli::Result<std::unique_ptr<const Shot>> Shot::open(const RenderRequest& request) {
    std::unique_ptr<Shot> shot(new Shot(request));
    if (auto done = shot->read_choices(); !done)
        return tl::unexpected(done.error());
    if (const auto files = kit::sector_files(request.folder); !files)
        return tl::unexpected(files.error());
    auto map = read_map(request.maps);
    if (!map)
        return tl::unexpected(map.error());
    if (auto checked = check_manifest(request.folder, **map); !checked)
        return tl::unexpected(checked.error());
    const map::Bounds bounds = bounds_of(**map);
    if (bounds.empty())
        return cli::fail(cli::exit_invalid, "the map has nothing that could be seen");
    const trace::WorldRectangle wanted = shot->wanted_of(bounds);
    if (auto done = shot->load_sectors(wanted, {bounds.low, bounds.high}); !done)
        return tl::unexpected(done.error());
    if (request.compare) {
        if (auto done = shot->read_bake_settings(); !done)
            return tl::unexpected(done.error());
    }
    auto scenery = Scenery::build(*map, (wanted.low + wanted.high) / 2.0f);
    if (!scenery)
        return tl::unexpected(scenery.error());
    shot->scenery_ = std::move(*scenery);
    if (auto done = shot->place_camera(bounds); !done)
        return tl::unexpected(done.error());
    if (auto done = shot->check_map(); !done)
        return tl::unexpected(done.error());
    return shot;
}

cli::Result<void> Shot::read_choices() {
    const auto size = read_size(request_.size);
    if (!size)
        return tl::unexpected(size.error());
    size_ = *size;
    const auto view = read_view(request_);
    if (!view)
        return tl::unexpected(view.error());
    asked_ = *view;
    const auto region = read_region(request_.region);
    if (!region)
        return tl::unexpected(region.error());
    region_ = *region;
    show_ = show_of(request_.show);
    const std::string by = request_.by.value_or(request_.top ? "trilinear" : "volume");
    choice_.by = by == "nearest" ? By::nearest : by == "trilinear" ? By::trilinear : By::volume;
    const std::string encoding = request_.encoding.value_or(show_ == Show::clipped ? "rgba8" : "rgba16f");
    choice_.encoding = kit::encoding_of(encoding);
    choice_.interiors = request_.interiors;
    if (request_.compare && !is_surface_light(show_))
        return cli::fail(
            cli::exit_usage,
            fmt::format("render: --compare goes with light, all or a part of it, not with --show {}",
                        request_.show));
    const bool needs_volume = show_ == Show::clipped || show_ == Show::age;
    if (choice_.by != By::volume && (needs_volume || request_.encoding))
        return cli::fail(cli::exit_usage,
                         fmt::format("render: {} goes with --by volume",
                                     needs_volume ? "--show " + request_.show : "--encoding"));
    return {};
}

// Around a place where there are sectors: a map may be baked in a corner only.
trace::WorldRectangle Shot::wanted_of(const map::Bounds& bounds) const {
    if (asked_)
        return {glm::vec2(asked_->eye), glm::vec2(asked_->eye)};
    if (region_)
        return *region_;
    if (request_.top)
        return {bounds.low, bounds.high};
    const glm::vec2 middle = glm::vec2(bounds.low + bounds.high) / 2.0f;
    const auto nearest = kit::nearest_sector(request_.folder, middle.x, middle.y);
    const auto side = static_cast<float>(sector_size_m);
    const glm::vec2 around = nearest ? (glm::vec2(nearest->first, nearest->second) + 0.5f) * side : middle;
    return {around, around};
}

cli::Result<void> Shot::load_around(const trace::WorldRectangle& wanted) {
    const glm::dvec2 low(wanted.low - sectors_m);
    const glm::dvec2 high(wanted.high + sectors_m);
    folder_ = std::make_unique<kit::SectorFolder>();
    return folder_->load(request_.folder, kit::WorldSquare{low.x, low.y, high.x, high.y});
}

cli::Result<void> Shot::load_sectors(const trace::WorldRectangle& wanted, const trace::WorldRectangle& map) {
    if (auto done = load_around(wanted); !done)
        return done;
    std::size_t count = 0;
    bool fits = false;
    kit::for_each_sector(folder_->set(), [&](const LoadedSector& sector) {
        ++count;
        fits = fits || overlap(square_of(sector), map);
    });
    if (fits)
        return {};
    const std::string where = fmt::format("the map lies at x {:.0f} to {:.0f}, y {:.0f} to {:.0f}",
                                          map.low.x,
                                          map.high.x,
                                          map.low.y,
                                          map.high.y);
    if (count == 0)
        return cli::fail(cli::exit_invalid,
                         fmt::format("{} has no sector within {} m of x {:.0f}, y {:.0f}; {}",
                                     request_.folder,
                                     sectors_m,
                                     (wanted.low.x + wanted.high.x) / 2,
                                     (wanted.low.y + wanted.high.y) / 2,
                                     where));
    const trace::WorldRectangle sectors = extent_of(folder_->set());
    return cli::fail(
        cli::exit_invalid,
        fmt::format("the sectors of {} lie at x {:.0f} to {:.0f}, y {:.0f} to {:.0f}, but {}: they are "
                    "of another map",
                    request_.folder,
                    sectors.low.x,
                    sectors.high.x,
                    sectors.low.y,
                    sectors.high.y,
                    where));
}

// Of the first file: a folder is one bake.
cli::Result<void> Shot::read_bake_settings() {
    const auto files = kit::sector_files(request_.folder);
    if (!files)
        return tl::unexpected(files.error());
    const auto sector = kit::load_sector(files->front());
    if (!sector)
        return tl::unexpected(sector.error());
    bake_.bounces = sector->bake.bounces;
    if (sector->convergence && sector->convergence->local_bounces > 0)
        bake_.local_bounces = sector->convergence->local_bounces;
    bake_.reach_m = sector->bake.reach_m;
    return {};
}

cli::Result<void> Shot::place_camera(const map::Bounds& bounds) {
    if (request_.top) {
        world_ = widened(region_ ? *region_ : extent_of(folder_->set()), size_);
        camera_ = Camera::above(world_, bounds.high.z + over_the_top_m, size_);
        return {};
    }
    std::optional<View> view = asked_;
    if (!view) {
        view_ = view_by_rule(scenery_->scene(), folder_->set());
        // So that it is the same when it is said on the command line.
        if (view_)
            view_ = View{in_millimetres(view_->eye), in_millimetres(view_->look)};
        view = view_;
        // Those that the same view would load on the command line.
        const glm::vec2 eye = view ? glm::vec2(view->eye) : glm::vec2(0);
        if (auto done = view ? load_around({eye, eye}) : cli::Result<void>(); !done)
            return done;
    }
    if (!view)
        return cli::fail(
            cli::exit_invalid,
            "no probe of the files sees anything of the map; --camera and --look say what to show");
    camera_ = Camera::at(view->eye, view->look, request_.fov_deg, size_);
    return asked_ ? check_camera() : cli::Result<void>();
}

// Where a camera stands in something there is nothing to see.
cli::Result<void> Shot::check_camera() const {
    const trace::FloatMode float_mode;
    const trace::Scene& scene = scenery_->scene();
    const glm::vec3& eye = camera_->eye();
    if (const auto object = scene.closed_around(eye))
        return cli::fail(cli::exit_invalid,
                         fmt::format("the camera at {} stands inside of '{}'",
                                     place_text(eye),
                                     scenery_->map().objects[scene.object_index(*object)].name));
    const std::optional<trace::Hit> above = scene.closest({eye, {0, 0, 1}, sight_m});
    if (above && scene.surface(*above, 1).absorbs)
        return cli::fail(
            cli::exit_invalid,
            fmt::format("the camera at {} stands under the ground: {:.1f} m above it is the back of '{}'",
                        place_text(eye),
                        above->distance_m,
                        scene.object_of(*above).name));
    return {};
}

// Probes stand over ground: where there is none, it is another map, or not all of it.
cli::Result<void> Shot::check_map() const {
    const trace::FloatMode float_mode;
    constexpr float ground_m = 1.5f;
    constexpr std::size_t max_asked = 256;
    std::vector<glm::vec3> probes;
    for_each_ground_probe(folder_->set(), [&](const glm::vec3& place) { probes.push_back(place); });
    const std::size_t step = probes.size() / max_asked + 1;
    std::size_t asked = 0, over_nothing = 0;
    for (std::size_t n = 0; n < probes.size(); n += step) {
        ++asked;
        over_nothing += scenery_->scene().closest({probes[n], {0, 0, -1}, ground_m}) ? 0u : 1u;
    }
    if (2 * over_nothing <= asked)
        return {};
    const std::string sentence = fmt::format(
        "{} of {} probes of {} stand over no ground of the map", over_nothing, asked, request_.folder);
    if (over_nothing == asked)
        return cli::fail(cli::exit_invalid, sentence + ": they are of another map");
    cli::warn(sentence + ": is it the one that they were baked of?");
    return {};
}

}  // namespace drtv::picture
