#include "radiosity/gather/patch_power.h"

#include <algorithm>
#include <cmath>

namespace lightwell {

Eigen::ArrayXXd patch_integral(const PatchMesh& mesh, const BandArray& vertex_values) {
  Eigen::ArrayXXd integral = Eigen::ArrayXXd::Zero(mesh.patch_count(), vertex_values.cols());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e);
    for (int c = 0; c < n; ++c) {
      integral.row(mesh.patch[e]) +=
          mesh.element_area[e] / n * vertex_values.row(mesh.corners[e][c]).cast<double>();
    }
  }
  return integral;
}

double notable_share(const PatchMesh& mesh) {
  return std::max(0.002, 4.0 / std::max(1, mesh.patch_count()));
}

BandArray with_pools(const PatchMesh& mesh, const BandArray& even, BandArray gathered) {
  const Eigen::ArrayXd wanted = patch_integral(mesh, even).rowwise().sum();
  const Eigen::ArrayXd found = patch_integral(mesh, gathered).rowwise().sum();
  const double least = notable_share(mesh) * wanted.sum();
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    if (!(std::abs(wanted[p] - found[p]) > least)) continue;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      gathered.row(mesh.corners[e][c]) = even.row(mesh.corners[e][c]);
    }
  }
  return gathered;
}

}  // namespace lightwell
