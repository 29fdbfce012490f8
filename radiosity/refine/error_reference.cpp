#include "radiosity/refine/error_reference.h"

#include <algorithm>

namespace lightwell {

double error_reference(double mean_irradiance, double own_irradiance) {
  constexpr double bright = 4.0;
  return std::max(mean_irradiance, own_irradiance / bright);
}

std::vector<char> judged_patches(const PatchMesh& mesh) {
  const bool any = (mesh.reflectance > 0.0f).any();
  const BandArray& light = any ? mesh.reflectance : mesh.emission;
  std::vector<char> judged(static_cast<std::size_t>(mesh.patch_count()), 0);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    judged[static_cast<std::size_t>(p)] = (light.row(p) > 0.0f).any() == any ? 1 : 0;
  }
  return judged;
}

Eigen::ArrayXd error_references(const PatchMesh& mesh, const BandArray& irradiance) {
  const std::vector<char> judged = judged_patches(mesh);
  Eigen::ArrayXd own(mesh.element_count());
  double sum = 0.0, area = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e);
    own[e] = 0.0;
    for (int c = 0; c < n; ++c) {
      own[e] += irradiance.row(mesh.corners[e][c]).cast<double>().mean() / n;
    }
    if (judged[static_cast<std::size_t>(mesh.patch[e])] == 0) continue;
    sum += mesh.element_area[e] * own[e];
    area += mesh.element_area[e];
  }
  const double mean = area > 0.0 ? sum / area : 0.0;
  own = own.unaryExpr([mean](double E) { return error_reference(mean, E); });
  return own;
}

}  // namespace lightwell
