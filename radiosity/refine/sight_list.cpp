#include "radiosity/refine/sight_list.h"

#include <algorithm>

namespace lightwell {

SightList::SightList(int lights) : bytes_((std::clamp(lights, 0, 64) + 7) / 8) {}

void SightList::resize(int count) {
  noisy_.resize(static_cast<std::size_t>(count), 0.0f);
  bits_.resize(static_cast<std::size_t>(count) * 2 * static_cast<std::size_t>(bytes_), 0);
}

void SightList::shrink_to_fit() {
  noisy_.shrink_to_fit();
  bits_.shrink_to_fit();
}

void SightList::set(int place, const EmitterSight& sight) {
  noisy_[static_cast<std::size_t>(place)] = static_cast<float>(sight.noisy);
  std::uint8_t* whole = bits_.data() + std::ptrdiff_t{place} * 2 * bytes_;
  for (int i = 0; i < bytes_; ++i) {
    whole[i] = static_cast<std::uint8_t>(sight.whole >> (8 * i));
    whole[bytes_ + i] = static_cast<std::uint8_t>(sight.hidden >> (8 * i));
  }
}

EmitterSight SightList::operator[](int place) const {
  EmitterSight sight{.noisy = double{noisy_[static_cast<std::size_t>(place)]}};
  const std::uint8_t* whole = bits_.data() + std::ptrdiff_t{place} * 2 * bytes_;
  for (int i = 0; i < bytes_; ++i) {
    sight.whole |= std::uint64_t{whole[i]} << (8 * i);
    sight.hidden |= std::uint64_t{whole[bytes_ + i]} << (8 * i);
  }
  return sight;
}

}  // namespace lightwell
