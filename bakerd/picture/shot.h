// What a picture is of: the sectors, the map and the camera that a command line names.
#pragma once

#include "bakerd/picture/camera.h"
#include "bakerd/picture/moment.h"
#include "bakerd/picture/path_light.h"
#include "bakerd/picture/render_request.h"
#include "bakerd/picture/scenery.h"
#include "bakerd/picture/show.h"
#include "bakerd/picture/view_rule.h"
#include "format/kit/sector_folder.h"

#include <memory>
#include <optional>
#include <string>

namespace drtv::picture {

class Shot {
  public:
    // Fails with a sentence where something does not fit together.
    [[nodiscard]] static cli::Result<std::unique_ptr<const Shot>> open(const RenderRequest& request);

    [[nodiscard]] const SectorSet& sectors() const { return folder_->set(); }
    [[nodiscard]] const Scenery& scenery() const { return *scenery_; }
    [[nodiscard]] const Camera& camera() const { return *camera_; }
    [[nodiscard]] const RelightChoice& choice() const { return choice_; }
    [[nodiscard]] Show show() const { return show_; }
    // What the files' paths were.
    [[nodiscard]] const PathSettings& bake() const { return bake_; }
    // The volume's middle.
    [[nodiscard]] Double3 window() const { return as_place(camera_->eye()); }
    // Where the rule chose it.
    [[nodiscard]] const std::optional<View>& view() const { return view_; }
    // What is seen from above.
    [[nodiscard]] const trace::WorldRectangle& world() const { return world_; }

  private:
    explicit Shot(const RenderRequest& request) : request_(request) {}
    [[nodiscard]] cli::Result<void> read_choices();
    [[nodiscard]] cli::Result<void> read_bake_settings();
    [[nodiscard]] cli::Result<void> load_sectors(const trace::WorldRectangle& wanted,
                                                 const trace::WorldRectangle& map);
    [[nodiscard]] cli::Result<void> load_around(const trace::WorldRectangle& wanted);
    [[nodiscard]] trace::WorldRectangle wanted_of(const map::Bounds& bounds) const;
    [[nodiscard]] cli::Result<void> place_camera(const map::Bounds& bounds);
    [[nodiscard]] cli::Result<void> check_camera() const;
    [[nodiscard]] cli::Result<void> check_map() const;

    const RenderRequest& request_;
    Size size_;
    // On the command line.
    std::optional<View> asked_;
    std::optional<trace::WorldRectangle> region_;
    Show show_ = Show::all;
    RelightChoice choice_;
    std::unique_ptr<kit::SectorFolder> folder_;
    PathSettings bake_;
    std::unique_ptr<const Scenery> scenery_;
    std::optional<Camera> camera_;
    std::optional<View> view_;
    trace::WorldRectangle world_;
};

}  // namespace drtv::picture
