#include "bakerd/farm/row_codec.h"

#include <algorithm>

namespace drtv::farm {

std::string joined(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& sentence : sentences)
        text += (text.empty() ? "" : "\n") + sentence;
    return text;
}

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> sentences;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        sentences.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return sentences;
}

std::string ColumnNames::list(const std::string& prefix) const {
    std::string text;
    for (const std::string& name : names_)
        text += (text.empty() ? "" : ", ") + prefix + name;
    return text;
}

std::string ColumnNames::assignments() const {
    std::string text;
    for (const std::string& name : names_)
        text += (text.empty() ? "" : ", ") + name + " = :" + name;
    return text;
}

}  // namespace drtv::farm
