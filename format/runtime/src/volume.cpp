#include <drtv/volume.h>

#include "arena.h"
#include "columns.h"
#include "volume_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drtv {
namespace {

// Sectors that texels along one axis may lie over, wherever the window starts.
std::int32_t sectors_under(const VolumeSettings& settings, std::size_t axis) {
    const double length_m =
        static_cast<double>(settings.size[axis]) * static_cast<double>(settings.texel_m[axis]);
    return static_cast<std::int32_t>(std::ceil(length_m / side_m)) + 1;
}

std::int32_t modulo(std::int32_t n, std::int32_t length) {
    const std::int32_t rest = n % length;
    return rest < 0 ? rest + length : rest;
}

std::size_t product(const Int3& size) {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
}

Int3 texture_size_of(const VolumeSettings& settings) {
    const std::int32_t more = settings.borders ? 2 : 0;
    return {settings.size[0] + more, settings.size[1] + more, settings.size[2] + more};
}

struct Counts {
    std::size_t texel_bytes;
    std::size_t encoded_bytes;
    std::size_t slots;
    std::array<std::size_t, 3> places;
    std::size_t under;
    std::size_t cells_z;
    std::size_t slices;
    std::size_t runs;
};

Counts counts_of(const VolumeSettings& settings, const SectorSetLimits& limits) {
    const std::size_t texel = settings.encoding == TexelEncoding::rgba16f ? 8 : 4;
    const auto under = static_cast<std::size_t>(sectors_under(settings, 0)) *
                       static_cast<std::size_t>(sectors_under(settings, 1));
    const auto nx = static_cast<std::size_t>(settings.size[0]);
    const auto ny = static_cast<std::size_t>(settings.size[1]);
    constexpr std::size_t floats = basis_count * channel_count;
    // A slice with a texel more on each side, one that is blurred along x, and three along both.
    const std::size_t slices = (nx + 2) * (ny + 2) + nx * (ny + 2) + 3 * nx * ny;
    return {channel_count * texel * product(texture_size_of(settings)),
            channel_count * texel * limits.probes,
            limits.sectors,
            {nx, ny, static_cast<std::size_t>(settings.size[2])},
            under,
            under * static_cast<std::size_t>(settings.size[2]),
            settings.blur ? slices * floats : 0,
            static_cast<std::size_t>(sectors_under(settings, 0)) + 2};
}

// The window's lowest texel for a camera (each axis by itself): the middle lies nearest to it. False where it
// is out of the world.
bool window_at(const VolumeSettings& settings, const Double3& camera_m, Int3& window) {
    Int3 found;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!in_reach(camera_m[axis]))
            return false;
        const double texels = camera_m[axis] / static_cast<double>(settings.texel_m[axis]);
        found[axis] = static_cast<std::int32_t>(std::floor(texels + 0.5)) - settings.size[axis] / 2;
    }
    window = found;
    return true;
}

// Texels of the new window that were not in the old one, along one axis: from one side alone.
std::pair<std::int32_t, std::int32_t> came_in(std::int32_t moved, std::int32_t length) {
    return moved >= 0 ? std::pair(length - moved, length) : std::pair(0, -moved);
}

// Boxes to write in one update.
struct Work {
    std::array<TexelBox, 64> boxes;
    std::size_t count = 0;
    bool all = false;

    void add(const TexelBox& box) {
        if (box.empty())
            return;
        if (count == boxes.size())
            all = true;
        else
            boxes[count++] = box;
    }
};

// A slab for each axis along which the window moved; what an earlier one has is left out. A blur reaches a
// texel further, and sees where the window ends.
void add_moves(const Volume::State& state, const Int3& moved, Work& work) {
    const Int3& size = state.settings.size;
    TexelBox rest = state.whole();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (moved[axis] == 0)
            continue;
        if (std::abs(moved[axis]) >= size[axis]) {
            work.all = true;
            return;
        }
        const auto [low, high] = came_in(moved[axis], size[axis]);
        TexelBox slab = state.settings.blur ? state.whole() : rest;
        slab.low[axis] = low;
        slab.high[axis] = high;
        if (state.settings.blur) {
            TexelBox other = slab;
            other.low[axis] = moved[axis] > 0 ? 0 : size[axis] - 1;
            other.high[axis] = other.low[axis] + 1;
            work.add(other);
            slab.low[axis] = std::max(slab.low[axis] - 1, 0);
            slab.high[axis] = std::min(slab.high[axis] + 1, size[axis]);
        }
        work.add(slab);
        (moved[axis] > 0 ? rest.high[axis] : rest.low[axis]) = moved[axis] > 0 ? low : high;
    }
}

Volume::State::Shown shown_of(const Volume::State::Under& under, const RelitProbes& relit) {
    if (under.sector == nullptr)
        return {under.id, 0, relit.fallback_stamp(), under.tile};
    // Its holes show the fallback.
    const std::uint64_t stamp = std::max(relit.stamp(*under.sector), relit.fallback_stamp());
    return {under.id, under.sector->load, stamp, under.tile};
}

// Boxes of the sectors that show something else than before.
void add_changes(Volume::State& state, const RelitProbes& relit, Work& work) {
    const std::int32_t reach = state.settings.blur ? 1 : 0;
    const auto range_of = [&](std::size_t axis, std::int32_t sector) {
        const auto& places = state.places[axis];
        const auto low = std::find_if(
            places.begin(), places.end(), [&](const Volume::State::Place& p) { return p.sector == sector; });
        const auto high = std::find_if(
            low, places.end(), [&](const Volume::State::Place& p) { return p.sector != sector; });
        return std::pair(static_cast<std::int32_t>(low - places.begin()),
                         static_cast<std::int32_t>(high - places.begin()));
    };
    for (const Volume::State::Under& under : state.under) {
        const auto [x0, x1] = range_of(0, under.id.i);
        const auto [y0, y1] = range_of(1, under.id.j);
        if (x0 == x1 || y0 == y1)
            continue;  // room for more sectors than lie there
        Volume::State::Shown& shown = state.shown[state.lasting_index(under.id)];
        const Volume::State::Shown now = shown_of(under, relit);
        if (shown == now)
            continue;
        // What was not under the window before comes in with its slab.
        const bool was_there = shown.id == now.id;
        shown = now;
        if (!was_there)
            continue;
        const Int3& size = state.settings.size;
        work.add({{std::max(x0 - reach, 0), std::max(y0 - reach, 0), 0},
                  {std::min(x1 + reach, size[0]), std::min(y1 + reach, size[1]), size[2]}});
    }
}

// Intervals of a texture's indices along one axis.
struct Intervals {
    std::array<std::pair<std::int32_t, std::int32_t>, 4> parts;  // from, behind the last
    std::size_t count = 0;

    void add(std::int32_t low, std::int32_t high) {
        if (low < high)
            parts[count++] = {low, high};
    }
};

// Where the window's texels [low, high) stand, with their copies at the borders.
Intervals intervals_of(const Volume::State& state, std::size_t axis, std::int32_t low, std::int32_t high) {
    const std::int32_t length = state.settings.size[axis];
    const std::int32_t border = state.border();
    Intervals intervals;
    if (high - low >= length) {
        intervals.add(0, length + 2 * border);
        return intervals;
    }
    const std::int32_t from = modulo(state.window[axis] + low, length);
    const std::int32_t to = from + (high - low);
    const bool wraps = to > length;
    const std::int32_t first_to = wraps ? length : to;
    const bool has_last = first_to == length;
    const bool has_first = from == 0 || wraps;
    intervals.add(from + border, first_to + border + (has_first && has_last ? border : 0));
    if (wraps)
        intervals.add(border, to - length + border);
    if (border == 1 && has_last)
        intervals.add(0, 1);
    if (border == 1 && has_first && !has_last)
        intervals.add(length + 1, length + 2);
    return intervals;
}

void mark_dirty(Volume::State& state, const TexelBox& box) {
    std::array<Intervals, 3> axes;
    for (std::size_t axis = 0; axis < 3; ++axis)
        axes[axis] = intervals_of(state, axis, box.low[axis], box.high[axis]);
    const std::size_t more = axes[0].count * axes[1].count * axes[2].count;
    if (state.dirty_count + more > state.dirty.size()) {
        state.dirty[0] = {{0, 0, 0}, state.texture_size()};
        state.dirty_count = 1;
        return;
    }
    for (std::size_t n = 0; n < more; ++n) {
        const std::array<std::size_t, 3> part = {
            n % axes[0].count, n / axes[0].count % axes[1].count, n / axes[0].count / axes[1].count};
        TextureBox& dirty = state.dirty[state.dirty_count++];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto [low, high] = axes[axis].parts[part[axis]];
            dirty.offset[axis] = low;
            dirty.size[axis] = high - low;
        }
    }
}

void update(Volume::State& state,
            const SectorSet& set,
            const RelitProbes& relit,
            const Double3& camera_m,
            bool write_all) {
    Int3 window = state.window;
    (void)window_at(state.settings, camera_m, window);
    Work work;
    work.all = write_all || !state.filled || state.stale;
    Int3 moved;
    for (std::size_t axis = 0; axis < 3; ++axis)
        moved[axis] = window[axis] - state.window[axis];
    state.window = window;
    add_moves(state, moved, work);
    look_under(state, set, relit);
    state.fallback = relit.fallback();
    add_changes(state, relit, work);
    encode_probes(state, relit);
    state.dirty_count = 0;
    if (work.all) {
        work.count = 0;
        work.all = false;
        work.add(state.whole());
    }
    for (std::size_t n = 0; n < work.count; ++n) {
        write_box(state, relit, work.boxes[n]);
        mark_dirty(state, work.boxes[n]);
    }
    state.filled = true;
    state.stale = false;
}

}  // namespace

Int3 Volume::State::texture_size() const {
    return texture_size_of(settings);
}

std::size_t Volume::State::texels_per_texture() const {
    return product(texture_size());
}

std::int32_t Volume::State::wrapped(std::size_t axis, std::int32_t n) const {
    return modulo(window[axis] + n, settings.size[axis]) + border();
}

double Volume::State::centre_m(std::size_t axis, std::int32_t n) const {
    return (static_cast<double>(window[axis] + n) + 0.5) * static_cast<double>(settings.texel_m[axis]);
}

std::size_t Volume::State::under_index(std::int32_t x, std::int32_t y) const {
    const std::int32_t i = places[0][static_cast<std::size_t>(x)].sector - under_first.i;
    const std::int32_t j = places[1][static_cast<std::size_t>(y)].sector - under_first.j;
    return static_cast<std::size_t>(j * under_size[0] + i);
}

std::size_t Volume::State::lasting_index(SectorId id) const {
    const std::int32_t i = modulo(id.i, under_size[0]);
    const std::int32_t j = modulo(id.j, under_size[1]);
    return static_cast<std::size_t>(j * under_size[0] + i);
}

std::size_t Volume::State::memory_bytes(const VolumeSettings& settings, const SectorSetLimits& limits) {
    const Counts counts = counts_of(settings, limits);
    return Arena::bytes_of<std::byte>(counts.texel_bytes) + Arena::bytes_of<std::byte>(counts.encoded_bytes) +
           Arena::bytes_of<Encoded>(counts.slots) + Arena::bytes_of<Place>(counts.places[0]) +
           Arena::bytes_of<Place>(counts.places[1]) + Arena::bytes_of<Place>(counts.places[2]) +
           Arena::bytes_of<CellsOf>(counts.under) + Arena::bytes_of<Under>(counts.under) +
           Arena::bytes_of<std::uint8_t>(counts.cells_z) + Arena::bytes_of<Shown>(counts.under) +
           Arena::bytes_of<float>(counts.slices) + Arena::bytes_of<Run>(counts.runs);
}

Volume::State::State(const VolumeSettings& settings_,
                     const SectorSetLimits& limits,
                     std::span<std::byte> memory)
    : settings(settings_), under_size{sectors_under(settings_, 0), sectors_under(settings_, 1), 1} {
    const Counts counts = counts_of(settings, limits);
    Arena arena(memory);
    texels = arena.take<std::byte>(counts.texel_bytes);
    encoded = arena.take<std::byte>(counts.encoded_bytes);
    encoded_of = arena.take<Encoded>(counts.slots);
    places = {arena.take<Place>(counts.places[0]),
              arena.take<Place>(counts.places[1]),
              arena.take<Place>(counts.places[2])};
    under = arena.take<Under>(counts.under);
    cells_z = arena.take<std::uint8_t>(counts.cells_z);
    cells_of = arena.take<CellsOf>(counts.under);
    shown = arena.take<Shown>(counts.under);
    slices = arena.take<float>(counts.slices);
    runs = arena.take<Run>(counts.runs);
}

float suggest_scale(float largest, float current) {
    constexpr float lowest = 0x1p-60f;
    constexpr float highest = 0x1p60f;
    const bool fits = current > 0 && largest <= current / 2 && largest > current / 8;
    if (fits)
        return current;
    if (!(largest > 0))
        return current > 0 ? current : 1;
    float scale = lowest;
    while (scale < highest && scale < 2 * largest)
        scale *= 2;
    return scale;
}

bool Volume::is_possible(const VolumeSettings& settings) {
    constexpr std::int32_t max_size = 1024;
    constexpr float min_texel_m = 0.25f;
    constexpr float max_texel_m = 64;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool size_fits = settings.size[axis] >= 2 && settings.size[axis] <= max_size;
        const bool width_fits =
            settings.texel_m[axis] >= min_texel_m && settings.texel_m[axis] <= max_texel_m;
        if (!size_fits || !width_fits)
            return false;
    }
    return settings.borders || !settings.atlas;
}

std::size_t Volume::memory_bytes(const VolumeSettings& settings, const SectorSetLimits& limits) {
    return Arena::bytes_of<State>(1) + State::memory_bytes(settings, limits);
}

Volume::Volume(std::span<std::byte> memory, const VolumeSettings& settings, const SectorSetLimits& limits)
    : state_(std::construct_at(reinterpret_cast<State*>(memory.data()),
                               settings,
                               limits,
                               memory.subspan(Arena::bytes_of<State>(1)))) {}

void Volume::set_scale(float scale) {
    if (scale == state_->scale || state_->settings.encoding == TexelEncoding::rgba16f)
        return;
    state_->scale = scale;
    state_->stale = true;
    std::fill(state_->encoded_of.begin(), state_->encoded_of.end(), State::Encoded{});
}

float Volume::scale() const {
    return state_->scale;
}

void Volume::update(const SectorSet& set, const RelitProbes& relit, const Double3& camera_m) {
    drtv::update(*state_, set, relit, camera_m, false);
}

void Volume::update_all(const SectorSet& set, const RelitProbes& relit, const Double3& camera_m) {
    drtv::update(*state_, set, relit, camera_m, true);
}

std::span<const TextureBox> Volume::dirty() const {
    return {state_->dirty.data(), state_->dirty_count};
}

std::array<std::int32_t, 3> Volume::texture_size() const {
    const Int3 one = state_->texture_size();
    return {one[0], one[1], state_->settings.atlas ? 3 * one[2] : one[2]};
}

std::size_t Volume::texel_bytes() const {
    return state_->settings.encoding == TexelEncoding::rgba16f ? 8 : 4;
}

std::span<const std::byte> Volume::texels(std::size_t k) const {
    const std::size_t bytes = state_->texels_per_texture() * texel_bytes();
    return state_->texels.subspan(k * bytes, bytes);
}

VolumeShaderInputs Volume::shader_inputs() const {
    const VolumeSettings& settings = state_->settings;
    VolumeShaderInputs inputs;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int32_t size = settings.size[axis];
        const auto length = static_cast<float>(size);
        const std::int32_t middle = state_->window[axis] + size / 2;
        inputs.snapped_camera[axis] =
            static_cast<double>(middle) * static_cast<double>(settings.texel_m[axis]);
        inputs.uv_scale[axis] = 1 / (length * settings.texel_m[axis]);
        // frac(middle / N - 1/2), of whole numbers: twice N is the common denominator.
        inputs.wrap_offset[axis] = static_cast<float>(modulo(2 * middle - size, 2 * size)) / (2 * length);
        const float with_borders = length + 2;
        inputs.uvw_multiply[axis] = settings.borders ? length / with_borders : 1;
        inputs.uvw_add[axis] = settings.borders ? 1 / with_borders : 0;
    }
    inputs.scale = state_->scale;
    return inputs;
}

std::array<std::int32_t, 3> Volume::window() const {
    return state_->window;
}

bool Volume::is_filled() const {
    return state_->filled;
}

const VolumeSettings& Volume::settings() const {
    return state_->settings;
}

Volume::Sample Volume::sample(const Double3& world_m) const {
    Sample sample;
    const VolumeSettings& settings = state_->settings;
    std::array<std::int32_t, 3> low{};
    std::array<float, 3> above{};
    float weight = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double width = static_cast<double>(settings.texel_m[axis]);
        const double texels = world_m[axis] / width - static_cast<double>(state_->window[axis]);
        const double length = static_cast<double>(settings.size[axis]);
        const double to_side = std::min(texels, length - texels);
        if (!(to_side > 0.5))
            return {};
        weight = std::min(weight, static_cast<float>(to_side - 0.5));
        const double from_centre = texels - 0.5;
        const double floor = std::min(std::floor(from_centre), length - 2);
        low[axis] = static_cast<std::int32_t>(floor);
        above[axis] = static_cast<float>(from_centre - floor);
    }
    sample.weight = weight;
    for (std::size_t k = 0; k < channel_count; ++k) {
        Float4 sum{};
        for (int n = 0; n < 8; ++n) {
            Int3 place = low;
            float share = 1;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const bool next = (n >> axis & 1) != 0;
                place[axis] += next ? 1 : 0;
                share *= next ? above[axis] : 1 - above[axis];
            }
            const Float4 texel = stored_texel(*state_, k, place);
            for (std::size_t c = 0; c < 4; ++c)
                sum[c] += share * texel[c];
        }
        if (settings.encoding == TexelEncoding::rgba8_sqrt) {
            for (float& channel : sum)
                channel = channel * channel * state_->scale;
        }
        sample.colours[k] = {sum[0], sum[1], sum[2]};
        sample.colours[3][k] = sum[3];
    }
    return sample;
}

}  // namespace drtv
