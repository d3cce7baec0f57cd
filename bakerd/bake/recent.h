// What was asked for last, by key: each made once, however many threads ask for it at the same time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>

namespace drtv::bake {

// Thread-safe. A value lives as long as somebody holds it, also when it is no longer kept here.
template <class Key, class Value>
class Recent {
  public:
    explicit Recent(std::size_t most) : most_(most) {}

    // `make` gives the value. It runs outside the lock: other keys need not wait. When it throws, the next
    // one tries again.
    template <class Make>
    [[nodiscard]] std::shared_ptr<const Value> get(const Key& key, Make make) {
        return get_if(key, make, [](const Value&) { return true; });
    }

    // A value that is not worth keeping is given to those who wait for it, and made again for the next.
    template <class Make, class WorthKeeping>
    [[nodiscard]] std::shared_ptr<const Value> get_if(const Key& key, Make make, WorthKeeping worth_keeping) {
        const std::shared_ptr<Slot> slot = slot_of(key);
        std::call_once(slot->made, [&] { slot->value = std::make_shared<const Value>(make()); });
        if (!worth_keeping(*slot->value)) {
            const std::lock_guard lock(mutex_);
            slots_.remove(slot);
        }
        return slot->value;
    }

  private:
    struct Slot {
        explicit Slot(const Key& k) : key(k) {}
        const Key key;
        std::once_flag made;
        std::shared_ptr<const Value> value;
    };

    std::shared_ptr<Slot> slot_of(const Key& key) {
        const std::lock_guard lock(mutex_);
        const auto found = std::find_if(slots_.begin(), slots_.end(), [&](const std::shared_ptr<Slot>& slot) {
            return slot->key == key;
        });
        if (found != slots_.end())
            slots_.splice(slots_.begin(), slots_, found);
        else
            slots_.push_front(std::make_shared<Slot>(key));
        while (slots_.size() > most_)
            slots_.pop_back();
        return slots_.front();
    }

    const std::size_t most_;
    std::mutex mutex_;
    std::list<std::shared_ptr<Slot>> slots_;  // guarded by mutex_; most recently used first
};

}  // namespace drtv::bake
