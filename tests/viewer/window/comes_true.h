#pragma once

#include <chrono>
#include <thread>

namespace lightwell::test {

/// Waits until `what` is true; false if that exceeds a time beyond every step of these tests.
template <class Claim>
bool comes_true(Claim&& what) {
  for (int i = 0; i < 6000; ++i) {
    if (what()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace lightwell::test
