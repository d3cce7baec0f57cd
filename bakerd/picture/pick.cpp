#include "bakerd/picture/pick.h"

#include "bakerd/picture/painter.h"
#include "bakerd/trace/device.h"
#include "format/cli/number_list.h"
#include "format/kit/ambient_json.h"

#include <fmt/format.h>

#include <cmath>

namespace drtv::picture {
namespace {

void write_surface(kit::JsonWriter& json, const Shot& shot, const Moment& moment, const SurfacePoint& point) {
    const trace::Scene& scene = shot.scenery().scene();
    const Ambient ambient = moment.ambient(point.at, point.hit.normal);
    json.member("object", scene.object_of(point.hit).name);
    json.key("at").array(as_float3(point.at));
    json.key("normal").array(as_float3(point.hit.normal));
    json.member("front", point.hit.front);
    json.key("albedo").array(as_float3(point.surface.albedo));
    kit::append_reference(json, "probe", ambient.probe.sector, ambient.probe.probe);
    kit::append_reference(json, "interior", ambient.interior.sector, ambient.interior.index);
    json.member("interior_share", ambient.interior.share);
    json.key("ambient").array(ambient.colour);
    kit::append_parts(json, ambient.parts);
    json.key("direct").array(as_float3(direct_light(shot.scenery(), moment, point)));
}

}  // namespace

cli::Result<std::string> picked(const Shot& shot,
                                const Moment& moment,
                                const std::string& time,
                                const std::string& pixel) {
    const trace::FloatMode float_mode;
    const Camera& camera = shot.camera();
    const Size size = camera.size();
    const auto numbers = cli::number_list(pixel, 2);
    const auto is_within = [](double n, std::size_t pixels) {
        return n >= 0 && n < static_cast<double>(pixels) && n == std::floor(n);
    };
    if (!numbers || !is_within((*numbers)[0], size.width) || !is_within((*numbers)[1], size.height))
        return cli::fail(cli::exit_usage,
                         fmt::format("render: --pick takes x,y of a pixel, up to {},{}, not \"{}\"",
                                     size.width - 1,
                                     size.height - 1,
                                     pixel));
    const glm::vec2 middle = glm::vec2((*numbers)[0], (*numbers)[1]) + 0.5f;
    const auto point = surface_on(shot.scenery().scene(), camera, camera.ray(middle));
    kit::JsonWriter json;
    json.begin_object().key("pixel").array(*numbers);
    if (!time.empty())
        json.member("time", time);
    if (point)
        write_surface(json, shot, moment, *point);
    return json.end_object().text();
}

}  // namespace drtv::picture
