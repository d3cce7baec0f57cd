// The rules for codes whose scale stands beside them as an exponent: static irradiance, local transfer.
#pragma once

#include <drtv/sector.h>

#include "findings.h"
#include "layout.h"
#include "sentence.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace drtv {

struct LightCodesAt {
    layout::Place place;
    std::uint64_t offset;   // of the first code, in the section
    bool largest_exponent;  // no larger scale could have been chosen
    const Issue& out_of_range;
};

// Looks at each code: reserved, saturated, and else `range(c, k)`, which gives a function that makes the
// sentence where the code is out of its range. `path` gives that of all the codes.
template <class Path, class Range>
void check_light_codes(
    const LightCodes& codes, const LightCodesAt& at, Findings& findings, Path path, Range range) {
    std::uint64_t offset = at.offset;
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t k = 0; k < codes[c].size(); ++k, offset += sizeof(std::int16_t)) {
            const std::int16_t q = codes[c][k];
            const auto add = [&](const Issue& issue, const auto& message) {
                const auto path_of_code = [&] { return path() + "." + channel_name[c] + index(k); };
                findings.add(issue, at.place.at(offset), q, path_of_code, message);
            };
            if (q == INT16_MIN) {
                add(issue::fixed_point_reserved, [] { return "code -32768 is reserved"; });
                continue;
            }
            if (at.largest_exponent && std::abs(q) == INT16_MAX)
                add(issue::fixed_point_saturated,
                    [&] { return sentence("code ", q, " under the largest exponent"); });
            if (const auto message = range(c, k))
                add(at.out_of_range, *message);
        }
    }
}

}  // namespace drtv
