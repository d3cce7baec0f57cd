#include "local_filter.h"

#include "bytes.h"
#include "layout.h"
#include "section_headers.h"

#include <drtv/sector.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <vector>

namespace drtv {
namespace {

using Local = layout::LocalTransferLayout;

constexpr std::size_t values_of_pair = channel_count * sh_count;
constexpr std::uint8_t shift_count = 16;
constexpr std::uint8_t class_count = 17;  // 0 to 16 bits

// A pair's numbers in the order in which they are foretold: green first, from which red and blue follow.
constexpr std::array<std::size_t, channel_count> channel_order = {1, 0, 2};

using Values = std::array<std::int32_t, values_of_pair>;  // [c][i]

// Of the low 16 bits.
std::uint32_t zigzag(std::uint32_t value) {
    const auto v = static_cast<std::int16_t>(value);
    const auto doubled = static_cast<std::uint32_t>(v) << 1;
    const auto sign = static_cast<std::uint32_t>(v >> 15);
    return (doubled ^ sign) & 0xFFFF;
}
std::int16_t unzigzag(std::uint32_t code) {
    return static_cast<std::int16_t>(code >> 1 ^ (0u - (code & 1)));
}

// Foretells red and blue from green: band 0 by the ratio of the last pairs, band 1 by the pair's own band 0.
class Predictor {
  public:
    // Of channel c's coefficient i, from those before it in `v`. Modulo 2^32, of which the low 16 bits count.
    [[nodiscard]] std::uint32_t foretell(const Values& v, std::size_t c, std::size_t i) const {
        const std::int32_t green0 = v[sh_count];
        if (c == 1)
            return 0;
        if (i == 0)
            return band0(c, green0);
        return band1(v[sh_count + i], green0, v[c * sh_count]);
    }

    void learn(const Values& v) {
        for (std::size_t c = 0; c < channel_count; ++c) {
            const std::uint32_t kept = sums_[c] - sums_[c] / 4;
            const std::uint32_t sum = kept + positive(v[c * sh_count]);
            sums_[c] = std::max(sum, 1u);
        }
    }

  private:
    static std::uint32_t positive(std::int32_t value) {
        return static_cast<std::uint32_t>(std::max(value, 0));
    }
    [[nodiscard]] std::uint32_t band0(std::size_t c, std::int32_t green0) const {
        const std::uint32_t product = positive(green0) * sums_[c];
        return (product + sums_[1] / 2) / sums_[1];  // below 2^32: sums are below 2^17
    }
    static std::uint32_t band1(std::int32_t green, std::int32_t green0, std::int32_t own0) {
        const std::int32_t product = green * own0;
        const std::int32_t divisor = std::max(green0, 1);
        const std::uint32_t rounded = positive((std::abs(product) + divisor / 2) / divisor);
        return product < 0 ? 0 - rounded : rounded;
    }

    std::array<std::uint32_t, channel_count> sums_ = {1, 1, 1};
};

// How many bits a number is off a pair's class, about: green's band 0 one more for its sign, the others less,
// those foretold least.
constexpr std::array<int, values_of_pair> bits_off = {1,
                                                      -1,
                                                      -1,
                                                      -1,  // green
                                                      -2,
                                                      -4,
                                                      -4,
                                                      -4,  // red
                                                      -2,
                                                      -4,
                                                      -4,
                                                      -4};  // blue

// Where each pair's numbers stand in the planes: one number of all pairs of a class together, groups of like
// size beside each other.
class Places {
  public:
    explicit Places(ByteSpan classes) : rank_(classes.size()) {
        std::array<std::uint32_t, class_count> of_class{};
        for (std::size_t n = 0; n < classes.size(); ++n)
            rank_[n] = of_class[classes[n]]++;
        constexpr int min_bits = std::ranges::min(bits_off);
        constexpr int max_bits = int{class_count} - 1 + std::ranges::max(bits_off);
        std::size_t at = 0;
        for (int bits = min_bits; bits <= max_bits; ++bits) {
            for (std::size_t c = 0; c < class_count; ++c) {
                const int off = bits - static_cast<int>(c);
                for (std::size_t k = 0; k < values_of_pair; ++k) {
                    if (bits_off[k] != off)
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

// What stands behind the masks of a filtered section: a shift and a class for each pair, then the high and
// the low bytes of all numbers.
template <class Byte>
struct Planes {
    Byte* shifts;
    Byte* classes;
    Byte* high;
    Byte* low;

    Planes(Byte* start, std::size_t pairs)
        : shifts(start), classes(shifts + pairs), high(classes + pairs), low(high + pairs * values_of_pair) {}
};

Values load_values(ByteSpan raw, std::size_t at) {
    Values values;
    for (std::int32_t& value : values) {
        value = load_i16(raw, at);
        at += sizeof(std::int16_t);
    }
    return values;
}

bool all_below(ByteSpan bytes, std::uint8_t limit) {
    return std::ranges::all_of(bytes, [limit](std::uint8_t byte) { return byte < limit; });
}

// All bits that the numbers have, without their signs.
std::uint32_t bits_of(const Values& values) {
    std::uint32_t bits = 0;
    for (const std::int32_t value : values)
        bits |= static_cast<std::uint32_t>(std::abs(value));
    return bits;
}

}  // namespace

std::size_t max_filtered_bytes(std::size_t raw_bytes) {
    return raw_bytes + 2 * (raw_bytes / layout::light_codes_bytes);
}

std::vector<std::uint8_t> filter_local(ByteSpan raw, std::size_t probe_count) {
    const LocalTransferCounts counts = load_local_transfer_counts(raw);
    const std::size_t pairs = counts.pairs;
    const Local parts = counts.parts(probe_count);
    std::vector<std::uint8_t> out(parts.filtered_end(pairs));
    std::copy_n(raw.begin(), parts.codes, out.begin());
    const Planes<std::uint8_t> planes(out.data() + parts.codes, pairs);

    std::vector<Values> values(pairs);
    for (std::size_t n = 0; n < pairs; ++n) {
        values[n] = load_values(raw, parts.pair_at(n));
        const std::uint32_t bits = bits_of(values[n]);
        const int shift = bits == 0 ? 0 : std::countr_zero(bits);
        for (std::int32_t& value : values[n])
            value >>= shift;
        planes.shifts[n] = static_cast<std::uint8_t>(shift);
        planes.classes[n] = static_cast<std::uint8_t>(std::bit_width(bits >> shift));
    }
    const Places places(ByteSpan(planes.classes, pairs));
    Predictor predictor;
    for (std::size_t n = 0; n < pairs; ++n) {
        const Values& v = values[n];
        std::size_t number = 0;
        for (const std::size_t c : channel_order) {
            for (std::size_t i = 0; i < sh_count; ++i) {
                const auto value = static_cast<std::uint32_t>(v[c * sh_count + i]);
                const std::uint32_t code = zigzag(value - predictor.foretell(v, c, i));
                const std::size_t place = places.of(n, planes.classes[n], number++);
                planes.high[place] = static_cast<std::uint8_t>(code >> 8);
                planes.low[place] = static_cast<std::uint8_t>(code);
            }
        }
        predictor.learn(v);
    }
    return out;
}

bool unfilter_local(ByteSpan filtered,
                    std::size_t probe_count,
                    std::size_t max_sources,
                    std::size_t raw_bytes,
                    std::vector<std::uint8_t>& raw) {
    if (filtered.size() < Local::header_bytes)
        return false;
    const auto [sources, pairs] = load_local_transfer_counts(filtered);
    if (sources > max_sources || pairs > probe_count * sources)
        return false;
    const Local parts(probe_count, sources, pairs);
    if (parts.filtered_end(pairs) != filtered.size() || parts.end != raw_bytes)
        return false;
    const Planes<const std::uint8_t> planes(filtered.data() + parts.codes, pairs);
    const ByteSpan shifts(planes.shifts, pairs);
    const ByteSpan classes(planes.classes, pairs);
    if (!all_below(shifts, shift_count) || !all_below(classes, class_count))
        return false;

    raw.resize(raw_bytes);
    std::copy_n(filtered.begin(), parts.codes, raw.begin());
    const Places places(classes);
    Predictor predictor;
    for (std::size_t n = 0; n < pairs; ++n) {
        Values v{};
        std::size_t number = 0;
        for (const std::size_t c : channel_order) {
            for (std::size_t i = 0; i < sh_count; ++i) {
                const std::size_t place = places.of(n, classes[n], number++);
                const std::uint32_t code = std::uint32_t{planes.high[place]} << 8 | planes.low[place];
                // In 16 bits, as the encoder's difference was.
                const auto residual = static_cast<std::uint32_t>(unzigzag(code));
                v[c * sh_count + i] = static_cast<std::int16_t>(predictor.foretell(v, c, i) + residual);
            }
        }
        predictor.learn(v);
        std::uint8_t* out = raw.data() + parts.pair_at(n);
        for (const std::int32_t value : v) {
            const std::uint32_t code = static_cast<std::uint32_t>(value) << shifts[n];
            *out++ = static_cast<std::uint8_t>(code);
            *out++ = static_cast<std::uint8_t>(code >> 8);
        }
    }
    return true;
}

}  // namespace drtv
