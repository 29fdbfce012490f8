#include "radiosity/gather/gap_sizes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lightwell {

double widest_between(double absorbed) {
  constexpr double of_typical = 0.2;
  return std::sqrt(std::clamp(absorbed / of_typical, 0.0, 1.0));
}

std::vector<float> gap_sizes(const PatchMesh& mesh) {
  const auto side = [&](int e) {
    const bool is_back = mesh.is_back[static_cast<std::size_t>(mesh.patch[e])] != 0;
    return 2 * static_cast<std::size_t>(mesh.facet[e]) + (is_back ? 1 : 0);
  };
  std::vector<double> facet_area;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (side(e) >= facet_area.size()) facet_area.resize(side(e) + 1, 0.0);
    facet_area[side(e)] += mesh.element_area[e];
  }
  std::vector<float> sizes;
  sizes.reserve(static_cast<std::size_t>(mesh.element_count()));
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double area = std::min(mesh.area[mesh.patch[e]], 4.0 * facet_area[side(e)]);
    sizes.push_back(static_cast<float>(std::sqrt(area)));
  }
  return sizes;
}

std::vector<float> facet_absorptances(const PatchMesh& mesh) {
  std::vector<float> absorbed;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto facet = static_cast<std::size_t>(mesh.facet[e]);
    if (facet >= absorbed.size()) absorbed.resize(facet + 1, 0.0f);
    const float least = mesh.reflectance.row(mesh.patch[e]).minCoeff();
    absorbed[facet] = std::max(absorbed[facet], 1.0f - least);
  }
  return absorbed;
}

}  // namespace lightwell
