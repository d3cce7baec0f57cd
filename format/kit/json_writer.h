// A small JSON writer: appends to a string, keeps track of commas. Floats print with the shortest text that
// reads back to the same float; text that is not UTF-8 (a file's name may be anything) has U+FFFD for each
// wrong byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::kit {

class JsonWriter {
  public:
    JsonWriter& begin_object() { return begin('{'); }
    JsonWriter& end_object() { return end('}'); }
    JsonWriter& begin_array() { return begin('['); }
    JsonWriter& end_array() { return end(']'); }
    JsonWriter& key(std::string_view name);
    JsonWriter& value(std::string_view text);
    JsonWriter& value(const char* text) { return value(std::string_view(text)); }
    JsonWriter& value(bool truth);
    JsonWriter& null();
    JsonWriter& value(float number);
    JsonWriter& value(double number);
    JsonWriter& value(std::int64_t number);
    JsonWriter& value(std::uint64_t number);
    JsonWriter& value(int number) { return value(std::int64_t{number}); }
    JsonWriter& value(unsigned number) { return value(std::uint64_t{number}); }

    // A key with its value.
    template <class Value>
    JsonWriter& member(std::string_view name, const Value& content) {
        return key(name).value(content);
    }
    JsonWriter& count(std::string_view name, std::size_t number) {
        return key(name).value(std::uint64_t{number});
    }

    template <class Range>
    JsonWriter& array(const Range& range) {
        begin_array();
        for (const auto& element : range)
            value(element);
        return end_array();
    }

    [[nodiscard]] const std::string& text() const { return out_; }

  private:
    JsonWriter& begin(char bracket);
    JsonWriter& end(char bracket);
    void separate();
    void append_quoted(std::string_view text);

    std::string out_;
    std::vector<bool> has_element_;  // for each open object or array
    bool after_key_ = false;
};

}  // namespace drtv::kit
