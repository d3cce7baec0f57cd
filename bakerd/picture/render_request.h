// `bakerd render` as its command line says it.
#pragma once

#include "format/cli/failure.h"
#include "format/kit/light_request.h"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace drtv::picture {

struct RenderRequest {
    std::string folder;
    std::vector<std::string> maps;
    std::string out;  // empty: no picture
    std::string size = "960x540";
    std::optional<std::string> camera, look;
    float fov_deg = 60;
    bool top = false;
    std::optional<std::string> region;  // from above
    std::vector<std::string> times;
    std::string show = "all";
    std::optional<std::string> by;        // nearest, trilinear, volume
    std::optional<std::string> encoding;  // rgba8, rgba8-sqrt, rgba16f
    bool interiors = true;
    std::string exposure = "noon";
    std::vector<std::string> picks;  // x,y
    bool compare = false;
    unsigned paths = 64;
    int threads = 0;
    kit::LightRequest light;
};

// The options of the command.
void add_render(CLI::App& command, RenderRequest& request);

[[nodiscard]] cli::Result<cli::ExitCode> run_render(const RenderRequest& request);

}  // namespace drtv::picture
