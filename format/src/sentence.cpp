#include "sentence.h"

namespace drtv {

void SentencePart::append_to(std::string& sentence) const {
    switch (kind_) {
        case Kind::text:
            sentence += text_;
            return;
        case Kind::whole:
            sentence += std::to_string(whole_);
            return;
        case Kind::natural:
            sentence += std::to_string(natural_);
            return;
        case Kind::real:
            sentence += std::to_string(real_);
            return;
    }
}

std::string sentence_of(const SentencePart* parts, std::size_t count) {
    std::string text;
    for (std::size_t n = 0; n < count; ++n)
        parts[n].append_to(text);
    return text;
}

}  // namespace drtv
