#include "radiosity/refine/emitter_visibility_list.h"

#include <gtest/gtest.h>

#include "scene/sampling.h"

namespace lightwell::emitter_visibility_list_test {
namespace {

TEST(EmitterVisibilityList, KeepsABitOfEachLight) {
  for (const int lights : {0, 1, 8, 9, 63, 64, 1000}) {
    constexpr int count = 20;
    const std::uint64_t some = lights >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << lights) - 1;
    const auto visibility = [&](int i) {
      const auto key = static_cast<std::uint64_t>(i);
      return EmitterVisibility{.noisy = 0.25 * i,
                               .drawn_noise = 0.5 * i,
                               .whole = random_key(key, 1) & some,
                               .hidden = random_key(key, 2) & some};
    };
    EmitterVisibilityList list(lights);
    list.resize(count / 2);
    for (int i = 0; i < count / 2; ++i) list.set(i, visibility(i));
    list.resize(count);
    for (int i = count / 2; i < count; i += 2) list.set(i, visibility(i));
    list.shrink_to_fit();
    for (int i = 0; i < count; ++i) {
      const bool is_set = i < count / 2 || (i - count / 2) % 2 == 0;
      const EmitterVisibility expected = is_set ? visibility(i) : EmitterVisibility{},
                              found = list[i];
      EXPECT_EQ(found.noisy, expected.noisy) << lights << ' ' << i;
      EXPECT_EQ(found.drawn_noise, expected.drawn_noise) << lights << ' ' << i;
      EXPECT_EQ(found.whole, expected.whole) << lights << ' ' << i;
      EXPECT_EQ(found.hidden, expected.hidden) << lights << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace lightwell::emitter_visibility_list_test
