#include "folder_info.h"

#include "folder/manifest.h"
#include "info_text.h"
#include "kit/files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <set>
#include <string>

namespace drtv::tool {
namespace {

struct Sums {
    std::size_t files = 0;
    std::size_t bytes = 0;
    std::set<std::string> versions;
    std::int32_t west = std::numeric_limits<std::int32_t>::max();
    std::int32_t east = std::numeric_limits<std::int32_t>::min();
    std::int32_t south = std::numeric_limits<std::int32_t>::max();
    std::int32_t north = std::numeric_limits<std::int32_t>::min();
    std::array<std::size_t, 3> probes_of_kind{};
    std::size_t empty = 0;  // files without a probe
    std::set<std::string> settings;
    Statistics statistics;
    std::set<std::string> light_groups;
    std::size_t interiors = 0;
    std::size_t with_local_transfer = 0;

    void add(const Sector& sector, const kit::FileBytes& file) {
        ++files;
        bytes += file.size();
        versions.insert(kit::format_version(file));
        west = std::min(west, sector.i);
        east = std::max(east, sector.i);
        south = std::min(south, sector.j);
        north = std::max(north, sector.j);
        for (const Probe& probe : sector.probes)
            ++probes_of_kind[static_cast<std::size_t>(probe.kind)];
        empty += sector.probes.empty() ? 1u : 0u;
        settings.insert(settings_text(sector.bake));
        statistics.candidates += sector.statistics.candidates;
        statistics.moved_out += sector.statistics.moved_out;
        statistics.dropped_in_solid += sector.statistics.dropped_in_solid;
        statistics.removed_by_volume += sector.statistics.removed_by_volume;
        statistics.thinned += sector.statistics.thinned;
        statistics.rays += sector.statistics.rays;
        statistics.back_hits += sector.statistics.back_hits;
        for (const LightGroup& group : sector.light_groups)
            light_groups.insert(group.name);
        interiors += sector.interiors.size();
        with_local_transfer += sector.local_transfer ? 1u : 0u;
    }
};

std::string joined(const std::set<std::string>& texts, const char* between) {
    std::string all;
    for (const std::string& text : texts)
        all += (all.empty() ? "" : between) + text;
    return all;
}

void print(const Sums& sums) {
    std::printf("files           %zu, %.1f MB, format %s\n",
                sums.files,
                static_cast<double>(sums.bytes) * 1e-6,
                joined(sums.versions, " and ").c_str());
    std::printf("sectors         i %d to %d, j %d to %d: x %d to %d m, y %d to %d m\n",
                sums.west,
                sums.east,
                sums.south,
                sums.north,
                sums.west * sector_size_m,
                (sums.east + 1) * sector_size_m,
                sums.south * sector_size_m,
                (sums.north + 1) * sector_size_m);
    const auto& kinds = sums.probes_of_kind;
    std::printf("probes          %zu (%zu ground, %zu vegetation, %zu manual); %zu files have none\n",
                kinds[0] + kinds[1] + kinds[2],
                kinds[0],
                kinds[1],
                kinds[2],
                sums.empty);
    std::printf("settings        %s\n", joined(sums.settings, "\n                ").c_str());
    std::printf("placement       %s\n", placement_text(sums.statistics).c_str());
    std::printf("rays            %s\n", rays_text(sums.statistics).c_str());
    if (!sums.light_groups.empty())
        std::printf("light groups    %s\n", joined(sums.light_groups, ", ").c_str());
    if (sums.interiors > 0)
        std::printf("interiors       %zu\n", sums.interiors);
    if (sums.with_local_transfer > 0)
        std::printf("local lights    in %zu files\n", sums.with_local_transfer);
}

void print(const folder::FolderManifest& manifest) {
    std::printf("manifest        job %s of %s, preset %s, baker %u; %zu files listed",
                manifest.job.c_str(),
                joined({manifest.documents.begin(), manifest.documents.end()}, ", ").c_str(),
                manifest.preset.c_str(),
                manifest.baker_version,
                manifest.files.size());
    if (manifest.unfinished > 0)
        std::printf(", %lld sectors had none", static_cast<long long>(manifest.unfinished));
    std::printf("\n");
}

}  // namespace

cli::Result<cli::ExitCode> print_folder_info(const std::string& folder) {
    const auto files = kit::sector_files(folder);
    if (!files)
        return tl::unexpected(files.error());
    const auto manifest = folder::read_manifest(folder);
    if (manifest && *manifest)
        folder::warn_of_pull(folder, **manifest);
    Sums sums;
    for (const std::string& file : *files) {
        kit::FileBytes bytes;
        const auto sector = kit::load_sector(file, &bytes);
        if (!sector)
            return tl::unexpected(sector.error());
        sums.add(*sector, bytes);
    }
    print(sums);
    if (!manifest)
        return tl::unexpected(manifest.error());
    if (*manifest)
        print(**manifest);
    return cli::exit_done;
}

}  // namespace drtv::tool
