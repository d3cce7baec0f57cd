#include "tests/reference/check_files.h"

#include "bakerd/map/file_source.h"
#include "bakerd/map/import.h"

#include <drtv/read.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace drtv::reference {

map::Map read_map(const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    const std::string folder = path.parent_path().string();
    auto map = map::import_map({&name, 1}, map::folder_source(folder.empty() ? "." : folder));
    if (!map)
        throw std::runtime_error(map.error());
    return std::move(*map);
}

Sector read_sector_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> chars{std::istreambuf_iterator<char>(file), {}};
    const std::vector<std::uint8_t> bytes(chars.begin(), chars.end());
    Sector sector;
    const ReadStatus status = read_sector(bytes, sector);
    if (!status.ok())
        throw std::runtime_error(path.string() + ": " + status.message);
    return sector;
}

}  // namespace drtv::reference
