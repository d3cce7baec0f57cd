#include "local_filter.h"

#include "bytes.h"
#include "layout.h"

#include <drtv/sector.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>

namespace drtv {
namespace {

using Local = layout::LocalTransferLayout;

constexpr std::size_t values_of_pair = channel_count * sh_count;
constexpr std::size_t class_count = 17;  // 0 to 16 bits

// A pair's numbers in the order in which they are foretold: green first, from which red and blue follow.
constexpr std::array<std::size_t, channel_count> channel_order = {1, 0, 2};

using Values = std::array<std::int32_t, values_of_pair>;  // [c][i]

// Of the low 16 bits.
std::uint32_t zigzag(std::uint32_t value) {
    const auto v = static_cast<std::int16_t>(value);
    return (static_cast<std::uint32_t>(v) << 1 ^ static_cast<std::uint32_t>(v >> 15)) & 0xFFFF;
}
std::int16_t unzigzag(std::uint32_t code) {
    return static_cast<std::int16_t>(code >> 1 ^ (0u - (code & 1)));
}

// Foretells red and blue from green: band 0 by the ratio of the last pairs, band 1 by the pair's own band 0.
class Predictor {
  public:
    // Both modulo 2^32, of which the low 16 bits count.
    [[nodiscard]] std::uint32_t band0(std::size_t c, std::int32_t green0) const {
        const auto g = static_cast<std::uint32_t>(std::max(green0, 0));
        return (g * sums_[c] + sums_[1] / 2) / sums_[1];  // below 2^32: sums are below 2^17
    }
    [[nodiscard]] static std::uint32_t band1(std::int32_t green, std::int32_t green0, std::int32_t own0) {
        const std::int32_t product = green * own0, divisor = std::max(green0, 1);
        const auto rounded = static_cast<std::uint32_t>((std::abs(product) + divisor / 2) / divisor);
        return product < 0 ? 0 - rounded : rounded;
    }
    void learn(const Values& v) {
        for (std::size_t c = 0; c < channel_count; ++c)
            sums_[c] = std::max(
                sums_[c] - sums_[c] / 4 + static_cast<std::uint32_t>(std::max(v[c * sh_count], 0)), 1u);
    }

  private:
    std::array<std::uint32_t, channel_count> sums_ = {1, 1, 1};
};

// How many bits a number is off a pair's class, about: green's band 0 one more for its sign, the others less,
// those foretold least.
constexpr std::array<int, values_of_pair> bits_off = {1, -1, -1, -1, -2, -4, -4, -4, -2, -4, -4, -4};

// Where each pair's numbers stand in the planes: one number of all pairs of a class together, groups of like
// size beside each other.
class Places {
  public:
    explicit Places(ByteSpan classes) : rank_(classes.size()) {
        std::array<std::uint32_t, class_count> of_class{};
        for (std::size_t n = 0; n < classes.size(); ++n)
            rank_[n] = of_class[classes[n]]++;
        std::size_t at = 0;
        for (int bits = *std::ranges::min_element(bits_off);
             bits < static_cast<int>(class_count) + *std::ranges::max_element(bits_off);
             ++bits) {
            for (std::size_t c = 0; c < class_count; ++c) {
                for (std::size_t k = 0; k < values_of_pair; ++k) {
                    if (static_cast<int>(c) + bits_off[k] != bits)
                        continue;
                    first_[c][k] = at;
                    at += of_class[c];
                }
            }
        }
    }
    [[nodiscard]] std::size_t of(std::size_t pair, std::uint8_t its_class, std::size_t number) const {
        return first_[its_class][number] + rank_[pair];
    }

  private:
    std::vector<std::uint32_t> rank_;
    std::array<std::array<std::size_t, values_of_pair>, class_count> first_{};
};

}  // namespace

std::size_t max_filtered_bytes(std::size_t raw_bytes) {
    return raw_bytes + 2 * (raw_bytes / layout::light_codes_bytes);
}

std::vector<std::uint8_t> filter_local(ByteSpan raw, std::size_t probe_count) {
    const std::size_t pairs = load_u32(raw, Local::pair_count);
    const Local parts(probe_count, load_u16(raw, Local::source_count), pairs);
    std::vector<std::uint8_t> out(parts.filtered_end(pairs));
    std::copy_n(raw.begin(), parts.codes, out.begin());
    std::uint8_t *shifts = out.data() + parts.codes, *classes = shifts + pairs, *high = classes + pairs,
                 *low = high + pairs * values_of_pair;

    std::vector<Values> values(pairs);
    for (std::size_t n = 0; n < pairs; ++n) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < values_of_pair; ++k) {
            values[n][k] = load_i16(raw, parts.pair_at(n) + 2 * k);
            bits |= static_cast<std::uint32_t>(std::abs(values[n][k]));
        }
        shifts[n] = bits == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(std::countr_zero(bits));
        for (std::int32_t& value : values[n])
            value >>= shifts[n];
        classes[n] = static_cast<std::uint8_t>(std::bit_width(bits >> shifts[n]));
    }
    const Places places(ByteSpan(classes, pairs));
    Predictor predictor;
    for (std::size_t n = 0; n < pairs; ++n) {
        std::size_t number = 0;
        for (const std::size_t c : channel_order) {
            for (std::size_t i = 0; i < sh_count; ++i, ++number) {
                const Values& v = values[n];
                const std::uint32_t foretold =
                    c == 1   ? 0
                    : i == 0 ? predictor.band0(c, v[sh_count])
                             : Predictor::band1(v[sh_count + i], v[sh_count], v[c * sh_count]);
                const std::uint32_t code = zigzag(static_cast<std::uint32_t>(v[c * sh_count + i]) - foretold);
                const std::size_t place = places.of(n, classes[n], number);
                high[place] = static_cast<std::uint8_t>(code >> 8);
                low[place] = static_cast<std::uint8_t>(code);
            }
        }
        predictor.learn(values[n]);
    }
    return out;
}

bool unfilter_local(ByteSpan filtered,
                    std::size_t probe_count,
                    std::size_t raw_bytes,
                    std::vector<std::uint8_t>& raw) {
    if (filtered.size() < Local::header_bytes)
        return false;
    const std::size_t sources = load_u16(filtered, Local::source_count),
                      pairs = load_u32(filtered, Local::pair_count);
    if (sources > max_probes || pairs > probe_count * sources)
        return false;
    const Local parts(probe_count, sources, pairs);
    if (parts.filtered_end(pairs) != filtered.size() || parts.end != raw_bytes)
        return false;
    const std::uint8_t *shifts = filtered.data() + parts.codes, *classes = shifts + pairs,
                       *high = classes + pairs, *low = high + pairs * values_of_pair;
    if (std::any_of(shifts, classes, [](std::uint8_t shift) { return shift > 15; }))
        return false;
    if (std::any_of(classes, high, [](std::uint8_t its_class) { return its_class >= class_count; }))
        return false;

    raw.resize(raw_bytes);
    std::copy_n(filtered.begin(), parts.codes, raw.begin());
    const Places places(ByteSpan(classes, pairs));
    Predictor predictor;
    for (std::size_t n = 0; n < pairs; ++n) {
        Values v{};
        std::size_t number = 0;
        for (const std::size_t c : channel_order) {
            for (std::size_t i = 0; i < sh_count; ++i, ++number) {
                const std::uint32_t foretold =
                    c == 1   ? 0
                    : i == 0 ? predictor.band0(c, v[sh_count])
                             : Predictor::band1(v[sh_count + i], v[sh_count], v[c * sh_count]);
                const std::size_t place = places.of(n, classes[n], number);
                // In 16 bits, as the encoder's difference was.
                v[c * sh_count + i] = static_cast<std::int16_t>(
                    foretold +
                    static_cast<std::uint32_t>(unzigzag(std::uint32_t{high[place]} << 8 | low[place])));
            }
        }
        predictor.learn(v);
        for (std::size_t k = 0; k < values_of_pair; ++k) {
            const auto code = static_cast<std::uint16_t>(static_cast<std::uint32_t>(v[k]) << shifts[n]);
            raw[parts.pair_at(n) + 2 * k] = static_cast<std::uint8_t>(code);
            raw[parts.pair_at(n) + 2 * k + 1] = static_cast<std::uint8_t>(code >> 8);
        }
    }
    return true;
}

}  // namespace drtv
