#include "json_writer.h"

#include "../src/utf8.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace drtv::kit {
namespace {

template <class Number>
void append_number(std::string& out, Number number) {
    char buffer[64];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, number);
    out.append(buffer, result.ptr);
}

}  // namespace

void JsonWriter::separate() {
    if (after_key_) {
        after_key_ = false;
        return;
    }
    if (has_element_.empty())
        return;
    if (has_element_.back())
        out_ += ',';
    has_element_.back() = true;
}

void JsonWriter::append_quoted(std::string_view text) {
    static constexpr char hex[] = "0123456789abcdef";
    out_ += '"';
    while (!text.empty()) {
        const char c = text.front();
        const std::size_t length = utf8_length(text);
        if (c == '"' || c == '\\') {
            out_ += '\\';
            out_ += c;
        } else if (static_cast<unsigned char>(c) < 0x20) {
            out_ += "\\u00";
            out_ += hex[(c >> 4) & 15];
            out_ += hex[c & 15];
        } else if (length > 0) {
            out_ += text.substr(0, length);
        } else {
            out_ += "\\ufffd";
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    out_ += '"';
}

JsonWriter& JsonWriter::begin(char bracket) {
    separate();
    out_ += bracket;
    has_element_.push_back(false);
    return *this;
}

JsonWriter& JsonWriter::end(char bracket) {
    out_ += bracket;
    has_element_.pop_back();
    return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
    separate();
    append_quoted(name);
    out_ += ':';
    after_key_ = true;
    return *this;
}

JsonWriter& JsonWriter::value(std::string_view text) {
    separate();
    append_quoted(text);
    return *this;
}

JsonWriter& JsonWriter::value(bool truth) {
    separate();
    out_ += truth ? "true" : "false";
    return *this;
}

JsonWriter& JsonWriter::null() {
    separate();
    out_ += "null";
    return *this;
}

JsonWriter& JsonWriter::value(float number) {
    separate();
    if (std::isfinite(number))
        append_number(out_, number);
    else
        out_ += "null";
    return *this;
}

JsonWriter& JsonWriter::value(double number) {
    separate();
    if (std::isfinite(number))
        append_number(out_, number);
    else
        out_ += "null";
    return *this;
}

JsonWriter& JsonWriter::value(std::int64_t number) {
    separate();
    append_number(out_, number);
    return *this;
}

JsonWriter& JsonWriter::value(std::uint64_t number) {
    separate();
    append_number(out_, number);
    return *this;
}

}  // namespace drtv::kit
