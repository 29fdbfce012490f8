#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/emitters/direct_light.h"

namespace lightwell {

/// Which of the first 64 lights places see, in a quarter of a byte for each light instead of
/// EmitterVisibility's fixed size.
class EmitterVisibilityList {
 public:
  explicit EmitterVisibilityList(int lights);

  void resize(int count);
  void shrink_to_fit();
  void set(int index, const EmitterVisibility& visibility);
  /// Its `noisy` as a float has it.
  EmitterVisibility operator[](int index) const;

 private:
  int bytes_;  // for a bit of each light
  std::vector<float> noisy_{};
  std::vector<std::uint8_t> bits_{};  // whole, hidden, whole, ...
};

}  // namespace lightwell
