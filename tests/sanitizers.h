// Differences that sanitizers make to a program that tests measure.
#pragma once

namespace lightwell::test {

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
// They take memory for shadow bytes and keep freed blocks.
inline constexpr bool memory_is_its_own = false;
// At most, as their manuals give it; for bounds on seconds.
inline constexpr double slowdown = 15.0;
#else
inline constexpr bool memory_is_its_own = true;
inline constexpr double slowdown = 1.0;
#endif

}  // namespace lightwell::test
