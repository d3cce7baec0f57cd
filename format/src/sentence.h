// A message from its parts, so that numbers need no words of their own to stand in it.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace drtv {

// Text as it is, or a number as std::to_string writes it.
class SentencePart {
  public:
    SentencePart(std::string_view text) : kind_(Kind::text), text_(text) {}
    SentencePart(const std::string& text) : kind_(Kind::text), text_(text) {}
    SentencePart(const char* text) : kind_(Kind::text), text_(text) {}
    SentencePart(std::signed_integral auto number) : kind_(Kind::whole), whole_(number) {}
    SentencePart(std::unsigned_integral auto number) : kind_(Kind::natural), natural_(number) {}
    SentencePart(std::floating_point auto number) : kind_(Kind::real), real_(static_cast<double>(number)) {}
    SentencePart(char) = delete;  // a text of one character will do

    void append_to(std::string& sentence) const;

  private:
    enum class Kind : std::uint8_t { text, whole, natural, real };

    Kind kind_;
    union {
        std::string_view text_;
        std::int64_t whole_;
        std::uint64_t natural_;
        double real_;
    };
};

[[nodiscard]] std::string sentence_of(const SentencePart* parts, std::size_t count);

// All parts in their order.
template <class... Parts>
[[nodiscard]] std::string sentence(const Parts&... parts) {
    const SentencePart all[] = {parts...};
    return sentence_of(all, sizeof...(parts));
}

}  // namespace drtv
