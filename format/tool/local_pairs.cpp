#include "local_pairs.h"

namespace drtv::tool {
namespace {

PairSource source_of(const LocalSource& source, const std::vector<std::size_t>* new_index) {
    const bool own = source.di == 0 && source.dj == 0;
    if (!own || new_index == nullptr)
        return {source.di, source.dj, false, source.probe};
    const std::size_t renumbered = (*new_index)[source.probe];
    const bool only_first = renumbered == no_match;
    return {source.di, source.dj, only_first, only_first ? source.probe : renumbered};
}

Coefficients decode(const LightCodes& codes, float scale) {
    Coefficients coefficients{};
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t i = 0; i < sh_count; ++i)
            coefficients[c][i] = static_cast<double>(decode_fixed(codes[c][i], scale));
    }
    return coefficients;
}

}  // namespace

LocalPairs local_pairs_of(const Sector& sector, std::size_t p, const std::vector<std::size_t>* new_index) {
    if (!sector.local_transfer)
        return {};
    LocalPairs pairs;
    const LocalTransfer& local = *sector.local_transfer;
    const LocalReceiver& receiver = local.receivers[p];
    std::size_t pair = receiver.first_pair;
    for (std::size_t s = 0; s < local.sources.size(); ++s) {
        if (!has_pair(receiver, s))
            continue;
        const LocalSource& source = local.sources[s];
        const float scale = scale_of_exponent(receiver.exponent + source.exponent);
        pairs[source_of(source, new_index)] = decode(local.pairs[pair], scale);
        ++pair;
    }
    return pairs;
}

std::string text(const PairSource& source, const Sector& sector) {
    const std::string i = std::to_string(sector.i + source.di);
    const std::string j = std::to_string(sector.j + source.dj);
    const std::string probe = source.only_first ? "the first's probe " : "probe ";
    return probe + std::to_string(source.probe) + " of (" + i + ", " + j + ")";
}

}  // namespace drtv::tool
