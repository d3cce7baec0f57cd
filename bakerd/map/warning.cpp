#include "bakerd/map/warning.h"

#include <algorithm>

namespace drtv::map {

std::string as_sentence(std::string text) {
    constexpr std::size_t max_length = 500;
    if (text.size() > max_length)
        text = text.substr(0, max_length) + "...";
    for (char& c : text) {
        if (is_control(c))
            c = ' ';
    }
    return text;
}

void warn(Map& map, const std::string& text) {
    constexpr std::size_t max_warnings = 100;  // more, nobody reads
    if (map.warnings.size() >= max_warnings)
        return;
    const std::string sentence = as_sentence(text);
    const bool is_new = std::ranges::find(map.warnings, sentence) == map.warnings.end();
    if (is_new)
        map.warnings.push_back(sentence);
}

}  // namespace drtv::map
