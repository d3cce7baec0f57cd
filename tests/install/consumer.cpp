#include <drtv/relight.h>
#include <drtv/view.h>
#include <cstdio>

alignas(16) static std::uint8_t bytes[1 << 20];

int main(int, char** argv) {
    drtv::SectorView sector;
    if (!drtv::open_sector({bytes, std::fread(bytes, 1, sizeof bytes, std::fopen(argv[1], "rb"))}, sector)
             .ok())
        return 1;
    drtv::SceneLight light;
    light.sky = drtv::constant_sky({1, 1, 1});
    const drtv::BasisColours colours =
        sector.probe_count > 0 ? drtv::relight(sector, 0, light) : drtv::open_sky(light);
    std::printf("%zu probes, from below %.4f\n", sector.probe_count, static_cast<double>(colours[3][0]));
}
