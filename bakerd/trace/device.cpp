#include "bakerd/trace/device.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <immintrin.h>
#include <glm/vec3.hpp>

namespace drtv::trace {

// GLM's own vector code takes approximate square roots and reciprocals.
static_assert(GLM_CONFIG_SIMD == GLM_DISABLE);

std::string_view isa_class() {
    return "x86-64-avx2";
}

tl::expected<std::shared_ptr<Device>, std::string> Device::open() {
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") ||
        !__builtin_cpu_supports("bmi2")) {
        return tl::unexpected(std::string("this CPU lacks AVX2, which bakerd needs"));
    }
    RTCDevice handle = rtcNewDevice("isa=avx2");
    if (handle == nullptr)
        return tl::unexpected(fmt::format("Embree cannot open a device: error {}",
                                          static_cast<int>(rtcGetDeviceError(nullptr))));
    if (rtcGetDeviceProperty(handle, RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED) == 0) {
        rtcReleaseDevice(handle);
        return tl::unexpected(
            std::string("this Embree was built without filter functions, which bakerd needs"));
    }
    return std::shared_ptr<Device>(new Device(handle));
}

Device::~Device() {
    rtcReleaseDevice(handle_);
}

FloatMode::FloatMode() : saved_(_mm_getcsr()) {
    _mm_setcsr(saved_ | _MM_FLUSH_ZERO_ON | 0x0040u);
}  // FTZ | DAZ
FloatMode::~FloatMode() {
    _mm_setcsr(saved_);
}

}  // namespace drtv::trace
