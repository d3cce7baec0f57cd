#include "bakerd/picture/setting.h"

#include "bakerd/picture/ground_probes.h"
#include "bakerd/picture/view_arguments.h"
#include "bakerd/trace/device.h"
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

Rectangle square_of(const LoadedSector& sector) {
    const auto side = static_cast<float>(sector_size_m);
    const glm::vec2 low = glm::vec2(sector.view.i, sector.view.j) * side;
    return {low, low + side};
}

Rectangle extent_of(const SectorSet& set) {
    Rectangle extent{glm::vec2(INFINITY), glm::vec2(-INFINITY)};
    kit::for_each_sector(set, [&](const LoadedSector& sector) {
        const Rectangle square = square_of(sector);
        extent = {glm::min(extent.low, square.low), glm::max(extent.high, square.high)};
    });
    return extent;
}

bool overlap(const Rectangle& a, const Rectangle& b) {
    return glm::all(glm::lessThan(a.low, b.high)) && glm::all(glm::lessThan(b.low, a.high));
}

// The picture's shape around a part of the world.
Rectangle widened(const Rectangle& world, Size size) {
    const glm::vec2 middle = (world.low + world.high) / 2.0f;
    glm::vec2 half = (world.high - world.low) / 2.0f;
    const float shape = static_cast<float>(size.width) / static_cast<float>(size.height);
    half = {std::max(half.x, half.y * shape), std::max(half.y, half.x / shape)};
    return {middle - half, middle + half};
}

}  // namespace

Expected<std::unique_ptr<const Setting>> Setting::open(const RenderRequest& request) {
    std::unique_ptr<Setting> setting(new Setting(request));
    if (auto done = setting->read_choices(); !done)
        return tl::unexpected(done.error());
    auto map = read_map(request.maps);
    if (!map)
        return tl::unexpected(map.error());
    const map::Bounds bounds = bounds_of(**map);
    if (bounds.empty())
        return failed(kit::exit_invalid, "the map has nothing that could be seen");
    if (auto done = setting->load_sectors(bounds); !done)
        return tl::unexpected(done.error());
    if (request.compare) {
        if (auto done = setting->read_bake_settings(); !done)
            return tl::unexpected(done.error());
    }
    const glm::vec2 around =
        setting->asked_ ? glm::vec2(setting->asked_->eye) : glm::vec2(bounds.low + bounds.high) / 2.0f;
    auto scenery = Scenery::build(*map, around);
    if (!scenery)
        return tl::unexpected(scenery.error());
    setting->scenery_ = std::move(*scenery);
    if (auto done = setting->place_camera(bounds); !done)
        return tl::unexpected(done.error());
    setting->warn_of_other_map();
    return setting;
}

Expected<void> Setting::read_choices() {
    const auto size = read_size(request_.size);
    if (!size)
        return tl::unexpected(size.error());
    size_ = *size;
    const auto view = read_view(request_);
    if (!view)
        return tl::unexpected(view.error());
    asked_ = *view;
    show_ = show_of(request_.show);
    const std::string by = request_.by.value_or(request_.top ? "trilinear" : "volume");
    choice_.by = by == "nearest" ? By::nearest : by == "trilinear" ? By::trilinear : By::volume;
    const std::string encoding = request_.encoding.value_or(show_ == Show::clipped ? "rgba8" : "rgba16f");
    choice_.encoding = encoding == "rgba8"        ? TexelEncoding::rgba8
                       : encoding == "rgba8-sqrt" ? TexelEncoding::rgba8_sqrt
                                                  : TexelEncoding::rgba16f;
    choice_.interiors = request_.interiors;
    const bool needs_volume = show_ == Show::clipped || show_ == Show::age;
    if (choice_.by != By::volume && (needs_volume || request_.encoding))
        return failed(kit::exit_usage,
                      fmt::format("render: {} goes with --by volume",
                                  needs_volume ? "--show " + request_.show : "--encoding"));
    return {};
}

Expected<void> Setting::load_sectors(const map::Bounds& bounds) {
    const auto region = read_region(request_.region);
    if (!region)
        return tl::unexpected(region.error());
    Rectangle wanted{bounds.low, bounds.high};
    if (asked_)
        wanted = {glm::vec2(asked_->eye), glm::vec2(asked_->eye)};
    else if (*region)
        wanted = **region;
    else if (!request_.top)
        wanted = {(wanted.low + wanted.high) / 2.0f, (wanted.low + wanted.high) / 2.0f};
    const glm::dvec2 low(wanted.low - sectors_m);
    const glm::dvec2 high(wanted.high + sectors_m);
    const int code = folder_.load(request_.folder, kit::WorldSquare{low.x, low.y, high.x, high.y});
    if (code != kit::exit_valid)
        return failed(static_cast<kit::ExitCode>(code), {});  // and has been told
    const Rectangle map{bounds.low, bounds.high};
    std::size_t count = 0;
    bool fits = false;
    kit::for_each_sector(folder_.set(), [&](const LoadedSector& sector) {
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
        return failed(kit::exit_invalid,
                      fmt::format("{} has no sector within {} m of x {:.0f}, y {:.0f}; {}",
                                  request_.folder,
                                  sectors_m,
                                  (wanted.low.x + wanted.high.x) / 2,
                                  (wanted.low.y + wanted.high.y) / 2,
                                  where));
    const Rectangle sectors = extent_of(folder_.set());
    return failed(
        kit::exit_invalid,
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
Expected<void> Setting::read_bake_settings() {
    const auto files = kit::sector_files(request_.folder);
    int code = kit::exit_unreadable;
    const auto sector = files ? kit::load_sector(files->front(), code) : std::nullopt;
    if (!sector)
        return failed(static_cast<kit::ExitCode>(code), {});
    bake_.bounces = sector->bake.bounces;
    bake_.reach_m = sector->bake.reach_m;
    return {};
}

Expected<void> Setting::place_camera(const map::Bounds& bounds) {
    if (request_.top) {
        const auto region = read_region(request_.region);
        world_ = widened(*region ? **region : extent_of(folder_.set()), size_);
        camera_ = Camera::above(world_, bounds.high.z + over_the_top_m, size_);
        return {};
    }
    std::optional<View> view = asked_;
    if (!view) {
        view_ = view_by_rule(scenery_->scene(), folder_.set());
        // So that it is the same when it is said on the command line.
        if (view_)
            view_ = View{in_millimetres(view_->eye), in_millimetres(view_->look)};
        view = view_;
    }
    if (!view)
        return failed(kit::exit_invalid,
                      "no probe of the files sees anything of the map; --camera and --look say what to show");
    camera_ = Camera::at(view->eye, view->look, request_.fov_deg, size_);
    return asked_ ? check_camera() : Expected<void>();
}

// Where a camera stands in something there is nothing to see.
Expected<void> Setting::check_camera() const {
    const trace::FloatMode float_mode;
    const trace::Scene& scene = scenery_->scene();
    const glm::vec3& eye = camera_->eye();
    if (const auto object = scene.closed_around(eye))
        return failed(kit::exit_invalid,
                      fmt::format("the camera at {} stands inside of '{}'",
                                  place_text(eye),
                                  scenery_->map().objects[scene.object_index(*object)].name));
    const std::optional<trace::Hit> above = scene.closest({eye, {0, 0, 1}, sight_m});
    if (above && scene.surface(*above, 1).absorbs)
        return failed(
            kit::exit_invalid,
            fmt::format("the camera at {} stands under the ground: {:.1f} m above it is the back of '{}'",
                        place_text(eye),
                        above->distance_m,
                        scene.object_of(*above).name));
    return {};
}

// Probes stand over ground: where there is none, it is another map, or not all of it.
void Setting::warn_of_other_map() const {
    const trace::FloatMode float_mode;
    constexpr float ground_m = 1.5f;
    constexpr std::size_t most_asked = 256;
    std::vector<glm::vec3> probes;
    for_each_ground_probe(folder_.set(), [&](const glm::vec3& place) { probes.push_back(place); });
    const std::size_t step = probes.size() / most_asked + 1;
    std::size_t asked = 0, over_nothing = 0;
    for (std::size_t n = 0; n < probes.size(); n += step) {
        ++asked;
        over_nothing += scenery_->scene().closest({probes[n], {0, 0, -1}, ground_m}) ? 0u : 1u;
    }
    if (2 * over_nothing > asked)
        kit::complain(
            fmt::format("warning: {} % of the probes stand over no ground of this map: is it the one "
                        "that {} was baked of?",
                        100 * over_nothing / asked,
                        request_.folder));
}

}  // namespace drtv::picture
