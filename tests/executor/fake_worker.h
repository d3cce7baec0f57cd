// What the fake worker does with a request, by the sector's `i` or the first byte of a map's digest.
#pragma once

#include <cstdint>

namespace drtv::test::fake {

inline constexpr std::int32_t good = 1;          // answered; probes is the sector's j
inline constexpr std::int32_t deadly = 600;      // ends the worker by SIGKILL
inline constexpr std::int32_t quits = 601;       // ends it with status 3
inline constexpr std::int32_t silent = 602;      // is never answered
inline constexpr std::int32_t gated = 603;       // answered once the gate's file exists
inline constexpr std::int32_t fails_once = 604;  // a retryable failure, then answered
inline constexpr std::int32_t always_later = 605;
inline constexpr std::int32_t hopeless = 606;    // a failure not to be retried
inline constexpr std::int32_t unknown_id = 607;  // answers another id first
inline constexpr std::int32_t twice = 608;       // answered twice

inline constexpr std::uint8_t silent_map = 1, deadly_map = 2;

}  // namespace drtv::test::fake
