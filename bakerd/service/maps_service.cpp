#include "bakerd/service/names.h"
#include "bakerd/service/services.h"
#include "map_files/limits.h"

#include <fmt/format.h>

namespace drtv::service {
namespace {

void fill(const map::Survey& survey, v1::MapSurvey& out) {
    out.set_x0(static_cast<double>(survey.low.x));
    out.set_y0(static_cast<double>(survey.low.y));
    out.set_z0(static_cast<double>(survey.low.z));
    out.set_x1(static_cast<double>(survey.high.x));
    out.set_y1(static_cast<double>(survey.high.y));
    out.set_z1(static_cast<double>(survey.high.z));
    out.set_static_objects(survey.static_objects);
    out.set_vegetation_objects(survey.vegetation_objects);
    out.set_ignored_nodes(survey.ignored_nodes);
    out.set_triangles(survey.triangles);
    out.set_lamps(survey.lamps);
    out.set_suns(survey.suns);
    out.set_glowing_objects(survey.glowing_objects);
    out.set_probes(survey.probes);
    out.set_interiors(survey.interiors);
    out.set_probe_free_volumes(survey.probe_free_volumes);
    out.set_spacing_volumes(survey.spacing_volumes);
    out.set_likeness(survey.likeness);
}

void fill(const farm::MapView& view, v1::Map& out) {
    out.set_name(map_name(view.id));
    for (const store::ManifestFile& file : view.manifest.files) {
        v1::MapFile* f = out.add_files();
        f->set_path(file.path);
        f->set_sha256(to_hex(file.digest));
        f->set_size_bytes(file.size_bytes);
    }
    for (const std::string& root : view.manifest.roots)
        out.add_roots(root);
    out.set_content_sha256(to_hex(view.summary.content));
    fill(view.summary.survey, *out.mutable_survey());
    out.set_sector_count(static_cast<std::int64_t>(view.summary.sectors.size()));
    for (const std::string& warning : view.summary.warnings)
        out.add_warnings(warning);
}

}  // namespace

grpc::Status MapsService::CreateMap(grpc::ServerContext*,
                                    const v1::CreateMapRequest* request,
                                    v1::Map* response) {
    const v1::Map& map = request->map();
    if (auto checked = map_files::check_counts(map.roots_size(), map.files_size()); !checked)
        return failed(grpc::StatusCode::INVALID_ARGUMENT, checked.error());
    store::Manifest manifest;
    for (const v1::MapFile& file : map.files()) {
        const auto digest = digest_from_text(file.sha256());
        if (!digest)
            return to_status(digest.error());
        manifest.files.push_back({file.path(), *digest, file.size_bytes()});
    }
    manifest.roots.assign(map.roots().begin(), map.roots().end());
    const auto view = farm_.create_map(std::move(manifest));
    if (!view)
        return to_status(view.error());
    fill(*view, *response);
    return grpc::Status::OK;
}

grpc::Status MapsService::GetMap(grpc::ServerContext*, const v1::GetMapRequest* request, v1::Map* response) {
    const auto id = map_from_name(request->name());
    if (!id)
        return to_status(id.error());
    const auto view = farm_.get_map(*id);
    if (!view)
        return to_status(view.error());
    fill(*view, *response);
    return grpc::Status::OK;
}

}  // namespace drtv::service
