#include "suggestion.h"

#include <algorithm>

namespace drtv::spelling {

std::size_t edit_distance(std::string_view from, std::string_view to) {
    // Row n: from the first n letters of `from`.
    std::vector<std::size_t> before(to.size() + 1), last(to.size() + 1), row(to.size() + 1);
    for (std::size_t m = 0; m <= to.size(); ++m)
        row[m] = m;
    for (std::size_t n = 1; n <= from.size(); ++n) {
        before.swap(last);
        last.swap(row);
        row[0] = n;
        for (std::size_t m = 1; m <= to.size(); ++m) {
            const bool is_same = from[n - 1] == to[m - 1];
            row[m] = std::min({last[m] + 1, row[m - 1] + 1, last[m - 1] + (is_same ? 0 : 1)});
            if (n > 1 && m > 1 && from[n - 1] == to[m - 2] && from[n - 2] == to[m - 1])
                row[m] = std::min(row[m], before[m - 2] + 1);
        }
    }
    return row[to.size()];
}

std::string suggestion(std::string_view meant, const std::vector<std::string>& words) {
    constexpr std::size_t min_beginning = 3;
    std::size_t best_distance = std::max<std::size_t>(1, meant.size() / 3);
    std::string_view best;
    for (const std::string& word : words) {
        const bool begins_so = meant.size() >= min_beginning && word.starts_with(meant);
        const std::size_t distance = begins_so ? 0 : edit_distance(meant, word);
        if (distance < best_distance || (distance == best_distance && best.empty())) {
            best_distance = distance;
            best = word;
        }
    }
    return best.empty() ? "" : ". Did you mean \"" + std::string(best) + "\"?";
}

std::string with_hint(const std::string& sentence, const std::string& suggested, const std::string& more) {
    return sentence + suggested + (suggested.empty() ? "; " : " ") + more;
}

}  // namespace drtv::spelling
