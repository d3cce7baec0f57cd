// Reader, view, writer and the validator's structure on any bytes: they agree on what can be read, and what
// was read survives being written, raw and compressed.
#include "tests/fuzz/sealed_mutator.h"

#include <drtv/read.h>
#include <drtv/validate.h>
#include <drtv/view.h>
#include <drtv/write.h>

#include <cstdlib>

namespace {

void require(bool holds) {
    if (!holds)
        std::abort();
}

void check_view(const drtv::Sector& sector, const std::vector<std::uint8_t>& raw_file) {
    drtv::SectorView view;
    require(drtv::open_sector(raw_file, view).ok());
    require(view.probe_count == sector.probes.size() && view.interiors.size() == sector.interiors.size());
    for (std::size_t p = 0; p < view.probe_count; ++p)
        require(view.transfer[p] == sector.probes[p].transfer &&
                view.positions[p].position == sector.probes[p].position);
    require(view.light_group_names.size() == sector.light_groups.size());
    for (std::size_t g = 0; g < sector.light_groups.size(); ++g) {
        require(light_group_name(view, g) == sector.light_groups[g].name);
        for (std::size_t p = 0; p < view.probe_count; ++p)
            require(light_group_irradiance_of(view, g, p) == sector.light_groups[g].irradiance[p]);
    }
    require(view.local_pairs.size() == (sector.local_transfer ? sector.local_transfer->pairs.size() : 0));
    for (std::size_t n = 0; n < view.local_pairs.size(); ++n)
        require(view.local_pairs[n] == sector.local_transfer->pairs[n]);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::vector<std::uint8_t> bytes(data, data + size);  // aligned, and its own block
    drtv::Sector sector;
    const drtv::ReadStatus status = drtv::read_sector(bytes, sector);
    drtv::SectorView view;
    const drtv::ReadStatus opened = drtv::open_sector(bytes, view);
    const drtv::Report report = drtv::validate_sector(bytes, {.quick = true});
    require(status.ok() == report.valid());
    require(opened.error == drtv::ReadError::compressed || opened.ok() == status.ok());
    require(status.ok() || (!status.message.empty() && status.offset <= size));
    if (!status.ok())
        return 0;

    for (const drtv::Codec codec : {drtv::Codec::raw, drtv::Codec::zstd}) {
        const std::vector<std::uint8_t> written = drtv::write_sector(sector, {codec});
        drtv::Sector again;
        require(drtv::read_sector(written, again).ok());
        require(drtv::write_sector(again) == drtv::write_sector(sector));
        if (codec == drtv::Codec::raw)
            check_view(sector, written);
    }
    return 0;
}
