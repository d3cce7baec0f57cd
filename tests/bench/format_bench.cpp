// Size and speed of sector files on real sectors: format_bench DIR [DIR...]. Each figure stands beside a
// baseline on the same bytes in the same run: memcpy, a checksum alone, plain zstd.
#include "tests/format/allocation_count.h"

#include <drtv/read.h>
#include <drtv/validate.h>
#include <drtv/view.h>
#include <drtv/write.h>

#define XXH_INLINE_ALL
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace {

using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

struct Folder {
    std::vector<Bytes> raw, packed;
    std::size_t probes = 0, raw_bytes = 0, packed_bytes = 0, largest = 0;
    std::map<std::uint16_t, std::array<std::size_t, 2>> kinds;  // raw and stored bytes of each section
};

Folder load(const char* path) {
    Folder folder;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
        if (entry.path().extension() != ".drtv")
            continue;
        std::ifstream in(entry.path(), std::ios::binary);
        const Bytes file{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
        drtv::Sector sector;
        if (const drtv::ReadStatus status = drtv::read_sector(file, sector); !status.ok()) {
            std::fprintf(stderr, "%s: %s\n", entry.path().c_str(), status.message.c_str());
            continue;
        }
        folder.probes += sector.probes.size();
        folder.raw.push_back(drtv::write_sector(sector));
        folder.packed.push_back(drtv::write_sector(sector, {drtv::Codec::zstd}));
        folder.raw_bytes += folder.raw.back().size();
        folder.packed_bytes += folder.packed.back().size();
        folder.largest = std::max(folder.largest, folder.raw.back().size());
        std::vector<drtv::SectionEntry> sections;
        if (!drtv::read_section_table(folder.packed.back(), sections).ok())
            continue;
        for (const drtv::SectionEntry& section : sections) {
            folder.kinds[section.kind][0] += section.raw_bytes;
            folder.kinds[section.kind][1] += section.stored_bytes;
        }
    }
    return folder;
}

// Nanoseconds for one pass over all files: the median of rounds that alternate between all of the works, so
// that each meets the same noise.
std::vector<double> time_in_turn(const std::vector<std::function<void()>>& works) {
    constexpr int rounds = 31;
    constexpr auto least = std::chrono::milliseconds(4);
    std::vector<std::vector<double>> times(works.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t w = 0; w < works.size(); ++w) {
            int passes = 0;
            const auto start = Clock::now();
            do {
                works[w]();
                ++passes;
            } while (Clock::now() - start < least);
            times[w].push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count() /
                               passes);
        }
    }
    std::vector<double> medians;
    for (auto& of_work : times) {
        std::ranges::nth_element(of_work, of_work.begin() + rounds / 2);
        medians.push_back(of_work[rounds / 2]);
    }
    return medians;
}

volatile std::uint64_t sink = 0;

void report(const char* name, double ns, std::size_t files, std::size_t bytes, double baseline_ns) {
    std::printf("  %-34s %9.2f us a sector %8.2f GB/s %8.2f x\n", name,
                ns / 1000 / static_cast<double>(files), static_cast<double>(bytes) / ns, ns / baseline_ns);
}

void bench(const char* path) {
    const Folder folder = load(path);
    const std::size_t files = folder.raw.size();
    if (files == 0) {
        std::fprintf(stderr, "%s holds no sector file\n", path);
        return;
    }
    const auto a_probe = [&](std::size_t bytes) {
        return static_cast<double>(bytes) / static_cast<double>(folder.probes);
    };
    std::printf("%s: %zu sectors, %zu probes, largest %zu bytes\n", path, files, folder.probes,
                folder.largest);
    std::printf("  bytes a probe: raw %.1f, zstd %.1f; %.2f times smaller\n", a_probe(folder.raw_bytes),
                a_probe(folder.packed_bytes),
                static_cast<double>(folder.raw_bytes) / static_cast<double>(folder.packed_bytes));
    for (const auto& [kind, bytes] : folder.kinds) {
        std::printf("    %-18s %7.1f %7.1f  %.2f\n", std::string(drtv::name_of_section(kind)).c_str(),
                    a_probe(bytes[0]), a_probe(bytes[1]),
                    static_cast<double>(bytes[0]) / static_cast<double>(std::max<std::size_t>(bytes[1], 1)));
    }

    Bytes target(folder.largest + 64);
    const auto over = [](const std::vector<Bytes>& all, auto work) {
        return [&all, work] {
            for (const Bytes& file : all)
                work(file);
        };
    };
    // Plain zstd: the whole raw file in one frame of the same level.
    std::vector<Bytes> plain;
    for (const Bytes& file : folder.raw) {
        Bytes frame(ZSTD_compressBound(file.size()));
        frame.resize(ZSTD_compress(frame.data(), frame.size(), file.data(), file.size(), 12));
        plain.push_back(std::move(frame));
    }
    const auto memcpy_all = over(folder.raw, [&](const Bytes& file) {
        std::memcpy(target.data(), file.data(), file.size());
        sink = sink + target[file.size() / 2];
    });
    const auto checksum =
        over(folder.raw, [](const Bytes& file) { sink = sink + XXH64(file.data(), file.size(), 0); });
    const auto open = over(folder.raw, [](const Bytes& file) {
        drtv::SectorView view;
        sink = sink + (drtv::open_sector(file, view).ok() ? view.probe_count : 0);
    });
    const auto read = [](const Bytes& file) {
        drtv::Sector sector;
        sink = sink + (drtv::read_sector(file, sector).ok() ? sector.probes.size() : 0);
    };
    const auto validate = over(
        folder.raw, [](const Bytes& file) { sink = sink + drtv::validate_sector(file).findings.size(); });
    const auto unpack_plain = over(plain, [&](const Bytes& frame) {
        sink = sink + ZSTD_decompress(target.data(), target.size(), frame.data(), frame.size());
    });
    const std::vector<double> ns = time_in_turn({memcpy_all, checksum, open, over(folder.raw, read), validate,
                                                 unpack_plain, over(folder.packed, read)});

    std::printf("  of raw bytes; the last column: times the checksum alone\n");
    const char* const names[] = {"memcpy",
                                 "XXH64 (libxxhash) over the file",
                                 "open_sector, checksums included",
                                 "read_sector of raw files",
                                 "validate_sector, all of it",
                                 "plain zstd of the file, decoded",
                                 "read_sector of zstd files"};
    for (std::size_t n = 0; n < ns.size(); ++n)
        report(names[n], ns[n], files, folder.raw_bytes, ns[1]);
    std::printf("  validation: %.0f sectors a second and thread\n", 1e9 * static_cast<double>(files) / ns[4]);
    drtv::SectorView view;
    const std::size_t before = drtv::test::allocation_count();
    const bool opened = drtv::open_sector(folder.raw.front(), view).ok();
    std::printf("  open_sector allocates %zu times%s\n\n", drtv::test::allocation_count() - before,
                opened ? "" : " and failed");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fputs("usage: format_bench DIR [DIR...]: folders of sector files\n", stderr);
        return 1;
    }
    for (int n = 1; n < argc; ++n)
        bench(argv[n]);
    return 0;
}
