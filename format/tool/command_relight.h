// drtv relight: the light at places, as a game would see it.
#pragma once

#include "kit/light_request.h"

#include <optional>
#include <string>

namespace drtv::tool {

struct RelightRequest {
    std::string folder;
    std::string at;      // x,y,z; where there is no `points`
    std::string normal;  // x,y,z
    std::optional<std::string> points;
    std::string by = "trilinear";       // nearest, trilinear, volume
    std::optional<std::string> camera;  // x,y,z of the volume's window; the place itself without it
    std::string encoding = "rgba16f";   // rgba8, rgba8-sqrt, rgba16f
    std::optional<double> offset_m;     // else 0, and surface_offset_m by volume
    bool interiors = true;
    bool json = false;
    kit::LightRequest light;
};
cli::Result<cli::ExitCode> run_relight(const RelightRequest& request);

}  // namespace drtv::tool
