#include "sheet_words.h"

#include "canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace drtv::image {

double round_down(double value) {
    const double ten = std::pow(10, std::floor(std::log10(value)));
    for (const double step : {5.0, 2.0}) {
        if (step * ten <= value)
            return step * ten;
    }
    return ten;
}

std::string length_text(double metres) {
    std::array<char, 32> text{};
    const bool long_way = metres >= 1000;
    std::snprintf(
        text.data(), text.size(), "%g %s", long_way ? metres / 1000 : metres, long_way ? "km" : "m");
    return text.data();
}

int label_step(double sector_px, int label_px) {
    int step = 1;
    for (const int factor : {2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000}) {
        if (step * sector_px >= label_px)
            break;
        step = factor;
    }
    return step;
}

std::vector<std::string> wrapped(std::string_view text, int width_px, int scale) {
    std::vector<std::string> lines(1);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        const std::string word(text.substr(0, end));
        const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
        if (lines.back().empty() || text_width(longer, scale) <= width_px)
            lines.back() = longer;
        else
            lines.push_back(word);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

}  // namespace drtv::image
