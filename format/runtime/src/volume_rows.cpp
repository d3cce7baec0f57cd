// The texels of a volume that is not blurred, row by row.
#include "volume_texels.h"

#include <array>
#include <span>

namespace drtv {
namespace {

// Runs of a box. REQUIRES: room for all: two more than sectors under the window, along x.
std::size_t runs_of(const Volume::State& state,
                    std::int32_t x0,
                    std::int32_t x1,
                    std::span<Volume::State::Run> runs) {
    const auto& places = state.places[0];
    const auto place = [&](std::int32_t x) { return places[static_cast<std::size_t>(x)]; };
    const std::int32_t first_border = state.border();
    std::size_t count = 0;
    for (std::int32_t x = x0; x < x1;) {
        Volume::State::Run run{x, place(x).to, 1, 0, true};
        run.under = static_cast<std::size_t>(place(x).sector - state.under_first.i);
        const std::int32_t until_wrap = state.settings.size[0] + first_border - run.to;
        while (x + run.length < x1 && run.length < until_wrap &&
               place(x + run.length).sector == place(x).sector) {
            run.whole_cells = run.whole_cells && place(x + run.length).cell == place(x).cell + run.length;
            ++run.length;
        }
        x += run.length;
        runs[count++] = run;
    }
    return count;
}

// Writes rows of the window to three rows of texels, where x is wrapped.
template <class Texel>
class RowWriter {
  public:
    RowWriter(const Volume::State& state, std::int32_t x0, std::int32_t x1)
        : state_(state),
          encoder_(encoder_of(state)),
          probes_(encoded_probes<Texel>(state)),
          open_(encoder_.encode<Texel>(texel_colours(state.fallback))),
          run_count_(runs_of(state, x0, x1, state.runs)) {}

    void write(const std::array<Texel*, texture_count>& rows, std::int32_t y, std::int32_t z) const {
        const Volume::State::Place& place_y = state_.place(1, y);
        const auto across = static_cast<std::size_t>(state_.under_size[0]);
        const auto row = static_cast<std::size_t>(place_y.sector - state_.under_first.j);
        const Volume::State::Under* row_under = state_.under.data() + row * across;
        const auto cell_y = static_cast<std::size_t>(place_y.cell);
        for (const Volume::State::Run& run : std::span(state_.runs).first(run_count_)) {
            const Volume::State::Under& under = row_under[run.under];
            const std::array<Texel*, texture_count> to = {
                rows[0] + run.to, rows[1] + run.to, rows[2] + run.to};
            if (under.sector == nullptr) {
                write_fallback(to, run, under, y, z);
                continue;
            }
            const std::size_t cell_z = under.cells_z[z];
            const std::uint8_t* cells =
                under.sector->view.grid->cells.data() + grid_size * (cell_y + grid_size * cell_z);
            write_probes(to, run, under, cells, y, z);
        }
    }

  private:
    void write_probes(const std::array<Texel*, texture_count>& to,
                      const Volume::State::Run& run,
                      const Volume::State::Under& under,
                      const std::uint8_t* cells,
                      std::int32_t y,
                      std::int32_t z) const {
        const ProbeTexels<Texel>* probes = probes_.data() + under.sector->first_probe;
        const std::size_t count = under.sector->view.probe_count;
        const Volume::State::Place* places = &state_.places[0][static_cast<std::size_t>(run.x)];
        Texel* const first = to[0];
        Texel* const second = to[1];
        Texel* const third = to[2];
        const auto put = [&](std::int32_t n, std::uint8_t p) {
            if (p < count) [[likely]] {
                const Texel* texels = probes[p].data();
                first[n] = texels[0];
                second[n] = texels[1];
                third[n] = texels[2];
                return;
            }
            const ProbeTexels<Texel> texels = fallback_texels(under, {run.x + n, y, z});
            first[n] = texels[0];
            second[n] = texels[1];
            third[n] = texels[2];
        };
        if (run.whole_cells) {
            const std::uint8_t* cell = cells + places[0].cell;
            for (std::int32_t n = 0; n < run.length; ++n)
                put(n, cell[n]);
        } else {
            for (std::int32_t n = 0; n < run.length; ++n)
                put(n, cells[places[n].cell]);
        }
    }

    void write_fallback(const std::array<Texel*, texture_count>& to,
                        const Volume::State::Run& run,
                        const Volume::State::Under& under,
                        std::int32_t y,
                        std::int32_t z) const {
        for (std::int32_t n = 0; n < run.length; ++n) {
            const ProbeTexels<Texel> texels = fallback_texels(under, {run.x + n, y, z});
            for (std::size_t k = 0; k < texture_count; ++k)
                to[k][n] = texels[k];
        }
    }

    [[nodiscard]] ProbeTexels<Texel> fallback_texels(const Volume::State::Under& under,
                                                     const Int3& place) const {
        if (under.tile == nullptr)
            return open_;
        return encoder_.encode<Texel>(texel_colours(fallback_at(state_, under, place)));
    }

    const Volume::State& state_;
    Encoder encoder_;
    std::span<const ProbeTexels<Texel>> probes_;
    ProbeTexels<Texel> open_;
    std::size_t run_count_;
};

template <class Texel>
void write_plain(const Volume::State& state, const TexelBox& box) {
    const RowWriter<Texel> writer(state, box.low[0], box.high[0]);
    const BorderCopier<Texel> borders(state, box);
    const Int3 size = state.texture_size();
    const std::array<Texel*, texture_count> bases = {
        texture<Texel>(state, 0), texture<Texel>(state, 1), texture<Texel>(state, 2)};
    for (std::int32_t z = box.low[2]; z < box.high[2]; ++z) {
        for (std::int32_t y = box.low[1]; y < box.high[1]; ++y) {
            const std::size_t row = offset_in(size, 0, state.place(1, y).to, state.place(2, z).to);
            writer.write({bases[0] + row, bases[1] + row, bases[2] + row}, y, z);
            if (!borders.has_copies(y, z))
                continue;
            for (Texel* base : bases)
                borders.copy(base, y, z);
        }
    }
}

}  // namespace

void write_rows(Volume::State& state, const TexelBox& box) {
    if (state.settings.encoding == TexelEncoding::rgba16f)
        write_plain<std::uint64_t>(state, box);
    else
        write_plain<std::uint32_t>(state, box);
}

}  // namespace drtv
