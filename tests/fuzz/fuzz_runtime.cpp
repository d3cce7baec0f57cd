// What a game hands in from outside: sector files and files of tiles of any bytes, places, normals, light and
// lamps of any floats, a day's light of any text. Never a fault, never a colour that is no number or below 0.
#include "tests/fuzz/sealed_mutator.h"

#include "format/src/checksum.h"

#include <drtv/ambient.h>
#include <drtv/day_file.h>
#include <drtv/sky_tile.h>
#include <drtv/volume.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

namespace {

using namespace drtv;

void require(bool holds) {
    if (!holds)
        std::abort();
}

// Floats and doubles from the end of the input, from the beginning again when it is used up.
class Numbers {
  public:
    Numbers(const std::uint8_t* data, std::size_t size) : bytes_(data, data + size) {}

    float next() {
        float number = 0;
        for (std::size_t n = 0; n < sizeof number && !bytes_.empty(); ++n)
            reinterpret_cast<std::uint8_t*>(&number)[n] = bytes_[at_++ % bytes_.size()];
        return number;
    }
    Float3 next3() { return {next(), next(), next()}; }
    // Now and then among the sectors, else anywhere.
    Double3 place(const SectorView& near) {
        const Float3 v = next3();
        if (!(std::abs(v[0]) < 100))
            return {double{v[0]}, double{v[1]}, double{v[2]}};
        return {64.0 * near.i + double{v[0]}, 64.0 * near.j + double{v[1]}, double{v[2]}};
    }

  private:
    std::vector<std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

void check(const BasisColours& colours) {
    for (const Float3& colour : colours) {
        for (const float channel : colour)
            require(channel >= 0);
    }
}

SceneLight any_light(Numbers& numbers) {
    SceneLight light;
    light.mode = numbers.next() > 0 ? RelightMode::literal : RelightMode::accurate;
    light.sky = gradient_sky({numbers.next3(), numbers.next3(), numbers.next3()}, numbers.next3());
    light.sun = {numbers.next3(), numbers.next3()};
    light.static_colour = numbers.next3();
    light.other_groups = numbers.next3();
    return light;
}

void relight_any(std::span<const std::uint8_t> file, Numbers numbers) {
    constexpr SectorSetLimits limits{2, 2 * 255, 64, 4};
    std::vector<std::byte> set_memory(SectorSet::memory_bytes(limits));
    SectorSet set(set_memory, limits);
    const LoadedSector* sector = nullptr;
    if (set.load(file, &sector) != LoadStatus::loaded)
        return;
    const SceneLight light = any_light(numbers);
    std::vector<LightShare> lamps;
    for (int n = 0; n < 3; ++n) {
        std::array<LightShare, max_shares_per_light> shares;
        const std::size_t count = split_light(set, {numbers.place(sector->view), numbers.next3()}, shares);
        lamps.insert(lamps.end(), shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(count));
    }
    std::vector<std::byte> relit_memory(RelitProbes::memory_bytes(limits, true));
    RelitProbes relit(relit_memory, limits, true);
    for (const Shown shown : {Shown::now, Shown::next}) {
        relit.set_light(shown, light);
        relit.relight(shown, *sector, light, lamps);
    }
    relit.set_fade(numbers.next());
    (void)relight_needed(sector->view, light, any_light(numbers), numbers.next());
    for (std::size_t p = 0; p < sector->view.probe_count; ++p)
        check(relit.colours(*sector, p));
    VolumeSettings settings;
    settings.size = {6, 5, 4};
    settings.encoding = static_cast<TexelEncoding>(static_cast<unsigned>(file.size()) % 3);
    settings.blur = numbers.next() > 0;
    settings.outdoors = numbers.next() > 0;
    std::vector<std::byte> volume_memory(Volume::memory_bytes(settings, limits));
    Volume volume(volume_memory, settings, limits);
    volume.set_scale(suggest_scale(numbers.next(), numbers.next()));
    for (int n = 0; n < 3; ++n) {
        AmbientPlace place;
        place.at = numbers.place(sector->view);
        place.normal = numbers.next3();
        place.sampling = n == 0 ? Sampling::nearest : Sampling::trilinear;
        place.offset_m = numbers.next();
        place.interior_soft_m = numbers.next();
        place.interiors = settings.outdoors;
        check(ambient_at(set, light, lamps, place).colours);
        volume.update(set, relit, place.at);
        check(ambient_in(volume, set, light, lamps, place).colours);
        const float factor = set.sky_factor(place.at);
        require(factor >= 0 && factor <= 1);
    }
    set.drop({sector->view.i, sector->view.j});
    volume.update(set, relit, numbers.place(sector->view));
    set.retire();
}

void open_any_tiles(std::vector<std::uint8_t> bytes, Numbers numbers) {
    // With a right checksum half of the time.
    if (bytes.size() >= 40 && bytes.size() % 2 == 0) {
        const std::uint64_t sum = xxh64({bytes.data(), bytes.size() - 8});
        std::memcpy(&bytes[bytes.size() - 8], &sum, sizeof sum);
    }
    std::span<const SkyTile> tiles;
    const ReadStatus status = open_tiles(bytes, tiles);
    require(status.ok() != !status.message.empty());
    if (!status.ok())
        return;
    require(write_tiles(tiles).size() == bytes.size());
    for (const SkyTile& tile : tiles) {
        require(find_tile(tiles, tile.i, tile.j) == &tile);
        const float factor = sky_factor(tile, 3, 4, double{numbers.next()});
        require(factor >= 0 && factor <= 1);
    }
}

void read_any_day(std::string_view text, Numbers numbers) {
    const auto file = DayFile::read(text);
    if (!file)
        return;
    std::vector<GroupColour> groups(file->day().groups.size());
    const SceneLight light = light_of_day(file->day(), double{numbers.next()}, RelightMode::accurate, groups);
    check(clamped(open_sky(light)));
    require(std::isfinite(light.sun.direction[2]));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::vector<std::uint8_t> bytes(data, data + size);  // aligned, and its own block
    const Numbers numbers(data + size / 2, size - size / 2);
    if (size >= 4 && std::memcmp(data, "DRTL", 4) == 0)
        open_any_tiles(bytes, numbers);
    else if (size >= 4 && std::memcmp(data, "DRTV", 4) == 0)
        relight_any(bytes, numbers);
    else
        read_any_day({reinterpret_cast<const char*>(data), size}, numbers);
    return 0;
}
