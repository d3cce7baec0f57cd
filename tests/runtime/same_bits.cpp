// Prints hashes of what the runtime makes of some sector files: the same on every CPU and by every kind of
// instructions. Compiled with the amalgamated pair. same_bits FILE...
#include "drtv_runtime.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace {

// FNV-1a, 64 bits.
class Hash {
  public:
    void add(const void* bytes, std::size_t count) {
        const auto* next = static_cast<const unsigned char*>(bytes);
        for (std::size_t n = 0; n < count; ++n)
            hash_ = (hash_ ^ next[n]) * 0x100000001B3u;
    }
    [[nodiscard]] unsigned long long value() const { return hash_; }

  private:
    unsigned long long hash_ = 0xCBF29CE484222325u;
};

struct Aligned {
    alignas(16) unsigned char bytes[16];
};

std::vector<Aligned> read(const char* path, std::size_t& size) {
    std::vector<Aligned> content(1 << 16);
    std::FILE* file = std::fopen(path, "rb");
    size = file == nullptr ? 0 : std::fread(content.data(), 1, content.size() * sizeof(Aligned), file);
    if (file != nullptr)
        std::fclose(file);
    return content;
}

drtv::SceneLight light_of(drtv::RelightMode mode, float turn) {
    drtv::SceneLight light;
    light.mode = mode;
    light.sun = {{3, 2.5f, 2}, {1, turn, 0.4f}};
    light.sky =
        drtv::gradient_sky({{0.3f, 0.5f, 1.1f}, {0.7f, 0.6f, 0.5f}, {0.4f, 0.2f, 0.1f}}, light.sun.direction);
    light.other_groups = {0.5f, 1.5f, 0.25f};
    return light;
}

}  // namespace

int main(int argc, char** argv) {
    constexpr drtv::SectorSetLimits limits{16, 16 * 255, 64, 64};
    std::vector<std::byte> set_memory(drtv::SectorSet::memory_bytes(limits));
    drtv::SectorSet set(set_memory, limits);
    std::vector<std::byte> relit_memory(drtv::RelitProbes::memory_bytes(limits, true));
    drtv::RelitProbes relit(relit_memory, limits, true);
    std::vector<std::vector<Aligned>> files;
    std::vector<const drtv::LoadedSector*> sectors;
    for (int n = 1; n < argc; ++n) {
        std::size_t size = 0;
        files.push_back(read(argv[n], size));
        const drtv::LoadedSector* sector = nullptr;
        drtv::ReadStatus why;
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(files.back().data());
        if (set.load({bytes, size}, &sector, &why) != drtv::LoadStatus::loaded) {
            std::printf("%s: %s\n", argv[n], why.message.c_str());
            return 1;
        }
        sectors.push_back(sector);
    }
    const drtv::SectorView& first = sectors.front()->view;
    const drtv::Double3 middle = {64.0 * first.i + 40, 64.0 * first.j + 24, 10};
    std::array<drtv::LightShare, drtv::max_shares_per_light> shares;
    const std::size_t count = drtv::split_light(set, {middle, {5, 4, 3}}, shares);
    const std::span<const drtv::LightShare> lamps(shares.data(), count);

    for (const drtv::RelightMode mode : {drtv::RelightMode::literal, drtv::RelightMode::accurate}) {
        Hash probes, places;
        const drtv::SceneLight light = light_of(mode, 0.3f);
        relit.set_light(drtv::Shown::now, light);
        relit.set_light(drtv::Shown::next, light_of(mode, -0.6f));
        for (const drtv::LoadedSector* sector : sectors) {
            // With lamps probe by probe, without all at once.
            relit.relight(drtv::Shown::now, *sector, light, lamps);
            relit.relight(drtv::Shown::next, *sector, light_of(mode, -0.6f), {});
            for (std::size_t p = 0; p < sector->view.probe_count; ++p) {
                const drtv::BasisColours one = drtv::relight(sector->view, p, light);
                probes.add(&one, sizeof one);
                for (const float fade : {0.0f, 1.0f}) {
                    relit.set_fade(fade);
                    const drtv::BasisColours shown = relit.colours(*sector, p);
                    probes.add(&shown, sizeof shown);
                }
            }
        }
        for (int n = 0; n < 2000; ++n) {
            const drtv::Double3 at = {middle[0] + (n * 37 % 400 - 200) * 0.31,
                                      middle[1] + (n * 53 % 400 - 200) * 0.37, middle[2] + n % 17 - 8.3};
            drtv::AmbientPlace place;
            place.at = at;
            place.normal = {0.6f, 0, 0.8f};
            const drtv::Ambient ambient = drtv::ambient_at(set, light, lamps, place);
            places.add(&ambient.colours, sizeof ambient.colours);
            places.add(&ambient.colour, sizeof ambient.colour);
            places.add(&ambient.parts, sizeof ambient.parts);
        }
        std::printf("mode %d: probes %016llx, places %016llx\n", static_cast<int>(mode), probes.value(),
                    places.value());
    }
    for (int encoding = 0; encoding < 3; ++encoding) {
        for (const bool blur : {false, true}) {
            drtv::VolumeSettings settings;
            settings.size = {24, 20, 8};
            settings.encoding = static_cast<drtv::TexelEncoding>(encoding);
            settings.blur = blur;
            std::vector<std::byte> memory(drtv::Volume::memory_bytes(settings, limits));
            drtv::Volume volume(memory, settings, limits);
            volume.set_scale(4);
            Hash texels;
            for (const float fade : {0.0f, 0.3f, 1.0f}) {
                relit.set_fade(fade);
                volume.update(set, relit,
                              {middle[0] + 20.0 * static_cast<double>(fade), middle[1], middle[2]});
                for (std::size_t k = 0; k < 3; ++k)
                    texels.add(volume.texels(k).data(), volume.texels(k).size());
            }
            std::printf("encoding %d%s: %016llx\n", encoding, blur ? ", blurred" : "", texels.value());
        }
    }
}
