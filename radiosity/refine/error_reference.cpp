#include "radiosity/refine/error_reference.h"

#include <algorithm>

namespace lightwell {

double error_reference(double mean_irradiance, double own_irradiance) {
  constexpr double bright = 4.0;
  return std::max(mean_irradiance, own_irradiance / bright);
}

Eigen::ArrayXd error_references(const PatchMesh& mesh, const BandArray& irradiance) {
  Eigen::ArrayXd own(mesh.element_count());
  double sum = 0.0, area = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e);
    own[e] = 0.0;
    for (int c = 0; c < n; ++c) {
      own[e] += irradiance.row(mesh.corners[e][c]).cast<double>().mean() / n;
    }
    if (!(mesh.reflectance.row(mesh.patch[e]) > 0.0f).any()) continue;
    sum += mesh.element_area[e] * own[e];
    area += mesh.element_area[e];
  }
  const double mean = area > 0.0 ? sum / area : 0.0;
  own = own.unaryExpr([mean](double E) { return error_reference(mean, E); });
  return own;
}

}  // namespace lightwell
