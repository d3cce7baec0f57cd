// The glTF importer on any bytes: a map or one sentence.
#include "bakerd/map/ground.h"
#include "bakerd/map/import.h"

#include <array>
#include <cstdlib>
#include <cstring>
#include <string>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

// A GLB says its length in its header: kept right, so that most mutants are read beyond it.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int) {
    constexpr std::size_t length_at = 8, header_bytes = 12;
    size = LLVMFuzzerMutate(data, size, max_size);
    if (size >= header_bytes && std::memcmp(data, "glTF", 4) == 0) {
        for (std::size_t k = 0; k < 4; ++k)
            data[length_at + k] = static_cast<std::uint8_t>(size >> (8 * k));
    }
    return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::array<std::string, 1> paths = {"x"};
    const auto map = drtv::map::import_map(
        paths, [&](const std::string& path) -> tl::expected<drtv::map::FileBytes, drtv::map::FileFailure> {
            if (path != paths[0])
                return tl::unexpected(drtv::map::FileFailure{"there is no file " + path, true});
            return drtv::map::FileBytes(data, data + size);
        });
    if (map) {
        static_cast<void>(drtv::map::sectors_of(*map));
    } else {
        const bool one_line = map.error().find('\n') == std::string::npos;
        if (!map.error().starts_with("x: ") || !one_line)
            std::abort();
    }
    return 0;
}
