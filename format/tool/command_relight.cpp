#include "command_relight.h"

#include "cli/number_list.h"
#include "kit/ambient_json.h"
#include "kit/json_writer.h"
#include "kit/relit_volume.h"
#include "kit/sector_folder.h"
#include "relight_points.h"

#include <drtv/ambient.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drtv::tool {
namespace {

const char* name_of(PlaceStatus status) {
    switch (status) {
        case PlaceStatus::inside:
            return "inside";
        case PlaceStatus::fading:
            return "fading";
        case PlaceStatus::sector_missing:
            return "no_sector";
        case PlaceStatus::probe_missing:
            break;
    }
    return "no_probe";
}

void print_json(const RelightPoint& point, const Ambient& ambient) {
    kit::JsonWriter json;
    json.begin_object().key("at").array(point.at).key("normal").array(point.normal);
    json.member("status", name_of(ambient.status));
    kit::append_reference(json, "probe", ambient.probe.sector, ambient.probe.probe);
    kit::append_reference(json, "interior", ambient.interior.sector, ambient.interior.index);
    json.key("basis_colours").begin_array();
    for (const Float3& colour : ambient.colours)
        json.array(colour);
    json.end_array();
    kit::append_parts(json, ambient.parts);
    json.key("colour").array(ambient.colour).end_object();
    std::puts(json.text().c_str());
}

std::string shown(const LoadedSector* sector, std::uint32_t index) {
    if (sector == nullptr)
        return "-";
    return "(" + std::to_string(sector->view.i) + ", " + std::to_string(sector->view.j) + ") " +
           std::to_string(index);
}

void print_row(const RelightPoint& point, const Ambient& ambient) {
    const auto& [x, y, z] = point.at;
    const auto& [nx, ny, nz] = point.normal;
    const auto& [r, g, b] = ambient.colour;
    std::printf("%10.8g %10.8g %9.7g  %6.3f %6.3f %6.3f  %-9s  %-14s  %-14s  %10.5g %10.5g %10.5g\n",
                x,
                y,
                z,
                static_cast<double>(nx),
                static_cast<double>(ny),
                static_cast<double>(nz),
                name_of(ambient.status),
                shown(ambient.probe.sector, ambient.probe.probe).c_str(),
                shown(ambient.interior.sector, ambient.interior.index).c_str(),
                static_cast<double>(r),
                static_cast<double>(g),
                static_cast<double>(b));
}

void print_head() {
    std::printf("%10s %10s %9s  %6s %6s %6s  %-9s  %-14s  %-14s  %10s %10s %10s\n",
                "x",
                "y",
                "z",
                "nx",
                "ny",
                "nz",
                "status",
                "probe",
                "interior",
                "r",
                "g",
                "b");
}

cli::Result<std::vector<RelightPoint>> read_places(const RelightRequest& request) {
    return request.points ? read_points(*request.points) : read_point(request.at, request.normal);
}

// Nothing where the option is not given.
cli::Result<std::optional<Double3>> read_camera(const RelightRequest& request) {
    if (!request.camera)
        return std::nullopt;
    const auto numbers = cli::number_list(*request.camera, 3);
    if (!numbers)
        return cli::fail(cli::exit_usage, "relight: --camera takes x,y,z, not \"" + *request.camera + "\"");
    return Double3{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

VolumeSettings volume_settings(const RelightRequest& request) {
    VolumeSettings settings;
    settings.outdoors = request.interiors;
    settings.encoding = kit::encoding_of(request.encoding);
    return settings;
}

}  // namespace

cli::Result<cli::ExitCode> run_relight(const RelightRequest& request) {
    kit::RequestedLight requested;
    if (auto read = kit::read_light(request.light, "relight", requested); !read)
        return tl::unexpected(read.error());
    const auto points = read_places(request);
    if (!points)
        return tl::unexpected(points.error());
    const auto camera = read_camera(request);
    if (!camera)
        return tl::unexpected(camera.error());

    std::vector<Double3> places;
    for (const RelightPoint& point : *points)
        places.push_back(point.at);
    for (const PointLight& lamp : requested.lamps)
        places.push_back(lamp.position);
    kit::SectorFolder folder;
    if (auto loaded = folder.load(request.folder, places); !loaded)
        return tl::unexpected(loaded.error());

    const SectorSet& set = folder.set();
    kit::warn_of_lost_light(set, requested, "around the places");
    const std::vector<LightShare> lamps = kit::split_lamps(set, requested.lamps);
    std::optional<kit::RelitVolume> volume;
    if (request.by == "volume")
        volume.emplace(set, requested.light, lamps, volume_settings(request));
    if (!request.json)
        print_head();
    for (const RelightPoint& point : *points) {
        AmbientPlace place;
        place.at = point.at;
        place.normal = point.normal;
        place.sampling = request.by == "nearest" ? Sampling::nearest : Sampling::trilinear;
        place.offset_m = static_cast<float>(request.offset_m.value_or(volume ? surface_offset_m : 0));
        place.interiors = request.interiors;
        const Ambient ambient =
            volume ? ambient_in(volume->at(camera->value_or(point.at)), set, requested.light, lamps, place)
                   : ambient_at(set, requested.light, lamps, place);
        if (request.json)
            print_json(point, ambient);
        else
            print_row(point, ambient);
    }
    return cli::exit_done;
}

}  // namespace drtv::tool
