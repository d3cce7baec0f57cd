// Apart from what opens raw files, which needs neither reader nor writer.
#include <drtv/read.h>
#include <drtv/view.h>
#include <drtv/write.h>

namespace drtv {

ReadStatus unpack_sector(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& raw_file) {
    Sector sector;
    ReadStatus status = read_sector(bytes, sector);
    if (status.ok())
        raw_file = write_sector(sector);
    return status;
}

}  // namespace drtv
