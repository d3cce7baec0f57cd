// Records of the farm's cache: plain numbers one after the other, compressed as a whole. Readers survive any
// bytes.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace drtv::reuse {

class RecordWriter {
  public:
    template <class Value>
    requires std::is_trivially_copyable_v<Value>
    void add(const Value& value) {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof value);
        std::memcpy(bytes_.data() + at, &value, sizeof value);
    }
    template <class Value>
    void add_all(const std::vector<Value>& values) {
        add(static_cast<std::uint64_t>(values.size()));
        for (const Value& value : values)
            add(value);
    }
    void add_text(const std::string& text) { add_all(std::vector<char>(text.begin(), text.end())); }

    void add_texts(const std::vector<std::string>& texts) {
        add(static_cast<std::uint64_t>(texts.size()));
        for (const std::string& text : texts)
            add_text(text);
    }

    [[nodiscard]] std::vector<std::uint8_t> compressed() const;

  private:
    std::vector<std::uint8_t> bytes_;
};

class RecordReader {
  public:
    // Of what `compressed` gave; else nothing can be read.
    explicit RecordReader(std::span<const std::uint8_t> compressed);

    template <class Value>
    requires std::is_trivially_copyable_v<Value> Value read() {
        Value value{};
        if (bytes_.size() - at_ < sizeof value) {
            sound_ = false;
            return value;
        }
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    template <class Value>
    std::vector<Value> read_all() {
        const auto count = read<std::uint64_t>();
        if (count > (bytes_.size() - at_) / sizeof(Value)) {
            sound_ = false;
            return {};
        }
        std::vector<Value> values(count);
        for (Value& value : values)
            value = read<Value>();
        return values;
    }
    std::string read_text() {
        const auto letters = read_all<char>();
        return {letters.begin(), letters.end()};
    }

    std::vector<std::string> read_texts() {
        const auto count = read<std::uint64_t>();
        std::vector<std::string> texts;
        while (texts.size() < count && sound_)
            texts.push_back(read_text());
        return texts;
    }

    [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
    void refuse() { sound_ = false; }
    // All was there, and all was read.
    [[nodiscard]] bool complete() const { return sound_ && at_ == bytes_.size(); }
    [[nodiscard]] bool sound() const { return sound_; }

  private:
    std::vector<std::uint8_t> bytes_;
    std::size_t at_ = 0;
    bool sound_ = false;
};

}  // namespace drtv::reuse
