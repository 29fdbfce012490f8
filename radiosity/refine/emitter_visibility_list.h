#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/direct_light/direct_light.h"

namespace lightwell {

/// A list of EmitterVisibility with a quarter of a byte for each of the first 64 lights that exist,
/// instead of a fixed size.
class EmitterVisibilityList {
 public:
  explicit EmitterVisibilityList(int lights);

  /// New entries equal EmitterVisibility{}.
  void resize(int count);
  void shrink_to_fit();
  void set(int index, const EmitterVisibility& visibility);
  /// The entry, with `noisy` and `drawn_noise` rounded to float.
  EmitterVisibility operator[](int index) const;

 private:
  int bytes_;  // that hold a bit of each light
  std::vector<float> noisy_{}, drawn_noise_{};
  std::vector<std::uint8_t> bits_{};  // whole, hidden, whole, ...
};

}  // namespace lightwell
