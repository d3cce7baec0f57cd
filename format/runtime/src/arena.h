// A piece of the caller's memory, given out in parts of 16-byte alignment.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace drtv {

class Arena {
  public:
    static constexpr std::size_t alignment = 16;

    // What `take<T>(count)` needs.
    template <class T>
    [[nodiscard]] static constexpr std::size_t bytes_of(std::size_t count) {
        static_assert(alignof(T) <= alignment);
        return (count * sizeof(T) + alignment - 1) / alignment * alignment;
    }

    explicit Arena(std::span<std::byte> memory) : memory_(memory) {}

    // Default-made objects. They need no destructor. REQUIRES: there is room.
    template <class T>
    [[nodiscard]] std::span<T> take(std::size_t count) {
        static_assert(std::is_trivially_destructible_v<T>);
        auto* first = reinterpret_cast<T*>(memory_.data());
        memory_ = memory_.subspan(bytes_of<T>(count));
        for (std::size_t n = 0; n < count; ++n)
            std::construct_at(first + n);
        return {first, count};
    }

  private:
    std::span<std::byte> memory_;
};

}  // namespace drtv
