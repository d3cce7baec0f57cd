// Which texels an update writes.
#include "columns.h"
#include "search.h"
#include "volume_state.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace drtv {
namespace {

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

    [[nodiscard]] std::int64_t texels() const {
        std::int64_t sum = 0;
        for (std::size_t n = 0; n < count; ++n)
            sum += boxes[n].texels();
        return sum;
    }

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
        const auto is_there = [&](const Volume::State::Place& p) { return p.sector == sector; };
        const std::size_t low = index_where(places, is_there);
        const std::size_t high = index_where(places, std::not_fn(is_there), low);
        return std::pair(static_cast<std::int32_t>(low), static_cast<std::int32_t>(high));
    };
    const SectorId last{state.places[0].back().sector, state.places[1].back().sector};
    for (const Volume::State::Under& under : state.under) {
        if (under.id.i > last.i || under.id.j > last.j)
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
        const auto [x0, x1] = range_of(0, under.id.i);
        const auto [y0, y1] = range_of(1, under.id.j);
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

}  // namespace

void update_volume(Volume::State& state,
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
    if (work.all || 2 * work.texels() > state.whole().texels()) {
        work.count = 0;
        work.all = false;
        work.add(state.whole());
    }
    for (std::size_t n = 0; n < work.count; ++n) {
        if (state.settings.blur)
            write_blurred(state, relit, work.boxes[n]);
        else
            write_rows(state, work.boxes[n]);
        mark_dirty(state, work.boxes[n]);
    }
    state.filled = true;
    state.stale = false;
}

}  // namespace drtv
