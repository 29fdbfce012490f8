#include "mesh/patches/inset.h"

#include <algorithm>

#include "scene/rays/float_rounding.h"

namespace lightwell {

double least_inset(double diagonal) {
  // Rays begin up to 4 roundings off their facet (EmbreeScene). A point 16 off a contact line is as
  // high below a surface that crosses at 14.5 degrees, whose sine is 1 / 4.
  constexpr double roundings = 16.0;
  return roundings * float_rounding(diagonal);
}

double off_border(const PatchMesh& mesh, int element) {
  const auto& corners = mesh.corners[static_cast<std::size_t>(element)];
  const int n = mesh.corner_count(element);
  double longest = 0.0;
  for (int i = 0; i < n; ++i) {
    const int from = corners[static_cast<std::size_t>(i)],
              to = corners[static_cast<std::size_t>((i + 1) % n)];
    longest = std::max(longest, (mesh.position(to) - mesh.position(from)).norm());
  }
  return 0.5 * mesh.element_area[element] / longest;
}

double inset_share(const PatchMesh& mesh, int element, double share) {
  return inset_share(mesh, off_border(mesh, element), share);
}

double inset_share(const PatchMesh& mesh, double off_border, double share) {
  constexpr double most = 0.5;
  return std::max(share, std::min(most, mesh.least_inset / off_border));
}

}  // namespace lightwell
