// A map from its files, and all of it that a camera may see.
#pragma once

#include "bakerd/bake/lights.h"
#include "bakerd/map/map.h"
#include "bakerd/picture/camera.h"
#include "bakerd/trace/device.h"
#include "bakerd/trace/scene.h"
#include "format/cli/failure.h"

#include <memory>
#include <span>
#include <string>

namespace drtv::picture {

// So many triangles in sight make some 10 GB.
inline constexpr std::size_t max_triangles = 64'000'000;

// Reads glTF files, and folders of them, as one map.
[[nodiscard]] cli::Result<std::shared_ptr<const map::Map>> read_map(std::span<const std::string> arguments);

// Fails where the folder has a manifest (sectors.json) and that is of another map.
[[nodiscard]] cli::Result<void> check_manifest(const std::string& folder, const map::Map& map);

// Of all objects; empty where there is none.
[[nodiscard]] map::Bounds bounds_of(const map::Map& map);

class Scenery {
  public:
    // Objects within sight of the place. Fails where they are over max_triangles: of small ones all instances
    // of a mesh count once.
    [[nodiscard]] static cli::Result<std::unique_ptr<const Scenery>> build(
        std::shared_ptr<const map::Map> map, glm::vec2 around);

    [[nodiscard]] const trace::Scene& scene() const { return *scene_; }
    [[nodiscard]] const map::Map& map() const { return scene_->map(); }
    [[nodiscard]] const bake::StaticLights& lights() const { return lights_; }

  private:
    explicit Scenery(const std::shared_ptr<const map::Map>& map) : lights_(map) {}

    bake::StaticLights lights_;
    std::shared_ptr<const trace::Scene> scene_;
};

}  // namespace drtv::picture
