#include "scene/colour_matching.h"

#include "scene/spectrum_samples.h"

namespace lightwell {

std::array<double, 3> colour_matching(double low, double high) {
  static const auto functions = spectra_of_table(scene_data::colour_matching);
  return {mean(functions[0], low, high), mean(functions[1], low, high),
          mean(functions[2], low, high)};
}

}  // namespace lightwell
