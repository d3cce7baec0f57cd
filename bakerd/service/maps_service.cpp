#include "bakerd/service/names.h"
#include "bakerd/service/services.h"

#include <fmt/format.h>

namespace drtv::service {
namespace {

constexpr int max_files = 10000, max_roots = 1000;

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
    out.set_object_count(view.summary.object_count);
    out.set_triangle_count(view.summary.triangle_count);
    out.set_sector_count(static_cast<std::int64_t>(view.summary.sectors.size()));
    for (const std::string& warning : view.summary.warnings)
        out.add_warnings(warning);
}

}  // namespace

grpc::Status MapsService::CreateMap(grpc::ServerContext*,
                                    const v1::CreateMapRequest* request,
                                    v1::Map* response) {
    const v1::Map& map = request->map();
    if (map.files_size() > max_files || map.roots_size() > max_roots) {
        return failed(grpc::StatusCode::INVALID_ARGUMENT,
                      fmt::format("{} files and {} roots, the limits are {} and {}",
                                  map.files_size(),
                                  map.roots_size(),
                                  max_files,
                                  max_roots));
    }
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
