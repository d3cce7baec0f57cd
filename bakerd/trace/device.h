// The ray tracing device, pinned to one instruction set: Embree's code paths differ in what they round, so
// that a result is named by the class it was made with (docs/design.md, promise 1). Every x86-64 CPU with
// AVX2 is of the same class: what CPUs of different vendors approximate in their own way (`rcpps`) stands in
// no number that counts (triangle.h).
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

struct RTCDeviceTy;

namespace drtv::trace {

// Part of every result's key.
[[nodiscard]] std::string_view isa_class();

class Device {
  public:
    // Fails with a sentence on a CPU without the pinned instruction set.
    [[nodiscard]] static tl::expected<std::shared_ptr<Device>, std::string> open();
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] RTCDeviceTy* handle() const { return handle_; }

  private:
    explicit Device(RTCDeviceTy* handle) : handle_(handle) {}
    RTCDeviceTy* handle_;
};

// Flushes denormals to zero on this thread while it lives; every thread that traces or sums must hold one, so
// that all compute alike (and because denormals are slow).
class FloatMode {
  public:
    FloatMode();
    ~FloatMode();
    FloatMode(const FloatMode&) = delete;
    FloatMode& operator=(const FloatMode&) = delete;

  private:
    unsigned saved_;
};

}  // namespace drtv::trace
