#include "radiosity/refine/emitter_visibility_list.h"

#include <algorithm>

namespace lightwell {

EmitterVisibilityList::EmitterVisibilityList(int lights)
    : bytes_((std::clamp(lights, 0, 64) + 7) / 8) {}

void EmitterVisibilityList::resize(int count) {
  noisy_.resize(static_cast<std::size_t>(count), 0.0f);
  drawn_noise_.resize(static_cast<std::size_t>(count), 0.0f);
  bits_.resize(static_cast<std::size_t>(count) * 2 * static_cast<std::size_t>(bytes_), 0);
}

void EmitterVisibilityList::shrink_to_fit() {
  noisy_.shrink_to_fit();
  drawn_noise_.shrink_to_fit();
  bits_.shrink_to_fit();
}

void EmitterVisibilityList::set(int index, const EmitterVisibility& visibility) {
  noisy_[static_cast<std::size_t>(index)] = static_cast<float>(visibility.noisy);
  drawn_noise_[static_cast<std::size_t>(index)] = static_cast<float>(visibility.drawn_noise);
  std::uint8_t* whole = bits_.data() + std::ptrdiff_t{index} * 2 * bytes_;
  for (int i = 0; i < bytes_; ++i) {
    whole[i] = static_cast<std::uint8_t>(visibility.whole >> (8 * i));
    whole[bytes_ + i] = static_cast<std::uint8_t>(visibility.hidden >> (8 * i));
  }
}

EmitterVisibility EmitterVisibilityList::operator[](int index) const {
  EmitterVisibility visibility{
      .noisy = double{noisy_[static_cast<std::size_t>(index)]},
      .drawn_noise = double{drawn_noise_[static_cast<std::size_t>(index)]}};
  const std::uint8_t* whole = bits_.data() + std::ptrdiff_t{index} * 2 * bytes_;
  for (int i = 0; i < bytes_; ++i) {
    visibility.whole |= std::uint64_t{whole[i]} << (8 * i);
    visibility.hidden |= std::uint64_t{whole[bytes_ + i]} << (8 * i);
  }
  return visibility;
}

}  // namespace lightwell
