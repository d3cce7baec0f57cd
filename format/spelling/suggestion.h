// "Did you mean": the known word that somebody most likely meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drtv::spelling {

// Letters left out, put in, exchanged, or swapped with their neighbour, that lead from one word to the other
// (Damerau and Levenshtein, in the form of the optimal string alignment).
[[nodiscard]] std::size_t edit_distance(std::string_view from, std::string_view to);

// `. Did you mean "word"?` where one of the words begins as this one does or is at most a third of its
// letters away; else empty.
[[nodiscard]] std::string suggestion(std::string_view meant, const std::vector<std::string>& words);

// The sentence, the suggestion, and where to read more.
[[nodiscard]] std::string with_hint(const std::string& sentence,
                                    const std::string& suggested,
                                    const std::string& more);

}  // namespace drtv::spelling
