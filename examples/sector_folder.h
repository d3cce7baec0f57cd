// The sector files of a folder, for the examples. A game maps raw files (`drtv strip`) and hands them over as
// they lie; here they are read and unpacked.
//
// SPDX-License-Identifier: MIT. Copy what you like.
#pragma once

#include <drtv/read.h>
#include <drtv/sector_set.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

struct SectorFolder {
    std::filesystem::path path;
    std::vector<std::vector<std::uint8_t>> files{};  // must stay while the set is used
    std::vector<const drtv::LoadedSector*> sectors{};

    // Room for all that may lie there. A game takes the sectors around its camera: 64 are many.
    [[nodiscard]] drtv::SectorSetLimits limits() const {
        const std::filesystem::directory_iterator entries(path);
        const auto count = static_cast<std::uint32_t>(std::distance(begin(entries), end(entries)));
        return {.sectors = count, .probes = count * 255, .interiors = 1024, .tiles = count};
    }

    void load(drtv::SectorSet& set) {
        for (const auto& entry : std::filesystem::directory_iterator(path)) {
            std::ifstream stream(entry.path(), std::ios::binary);
            const std::vector<char> read{std::istreambuf_iterator<char>(stream), {}};
            std::vector<std::uint8_t> raw;
            const drtv::ReadStatus status =
                drtv::unpack_sector({reinterpret_cast<const std::uint8_t*>(read.data()), read.size()}, raw);
            files.push_back(std::move(raw));
            const drtv::LoadedSector* sector = nullptr;
            const drtv::LoadStatus loaded =
                status.ok() ? set.load(files.back(), &sector) : drtv::LoadStatus::unreadable;
            if (loaded == drtv::LoadStatus::loaded)
                sectors.push_back(sector);
            else
                std::fprintf(stderr,
                             "%s is left out: %s\n",
                             entry.path().c_str(),
                             status.ok() ? drtv::sentence_of(loaded) : status.message.c_str());
        }
        std::printf("%zu sectors\n", sectors.size());
    }
};
