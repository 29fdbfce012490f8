#include "radiosity/gather/patch_power.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lightwell {
namespace {

constexpr double most_factor = 1.25;  // of the factors that PatchPowers finds

}  // namespace

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

PatchPowers::PatchPowers(const PatchMesh& mesh, Eigen::ArrayXXd balanced,
                         Eigen::ArrayXXd at_vertices)
    : balanced_(std::move(balanced)),
      at_vertices_(std::move(at_vertices)),
      least_(notable_share(mesh) * balanced_.sum()) {}

double PatchPowers::error(int p) const {
  return std::abs(balanced_.row(p).sum() - at_vertices_.row(p).sum());
}

bool PatchPowers::is_pool(int p) const {
  const double balanced = balanced_.row(p).sum(), found = at_vertices_.row(p).sum();
  return balanced > most_factor * found || found > most_factor * balanced;
}

Eigen::ArrayXf PatchPowers::factor(std::span<const int> patches) const {
  Eigen::ArrayXd balanced = Eigen::ArrayXd::Zero(balanced_.cols()), found = balanced;
  for (const int p : patches) {
    balanced += balanced_.row(p).transpose();
    found += at_vertices_.row(p).transpose();
  }
  const Eigen::ArrayXd ratio = (found > 0.0).select(balanced / found.max(1e-300), 1.0);
  return ratio.max(1.0 / most_factor).min(most_factor).cast<float>();
}

std::vector<int> corners_of_patch(const PatchMesh& mesh, int patch) {
  std::vector<int> vertices;
  for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) vertices.push_back(mesh.corners[e][c]);
  }
  return vertices;
}

BandArray with_pools(const PatchMesh& mesh, const BandArray& even, BandArray gathered) {
  const PatchPowers powers(mesh, patch_integral(mesh, even), patch_integral(mesh, gathered));
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (!powers.is_peak(p)) continue;
    for (const int v : corners_of_patch(mesh, p)) gathered.row(v) = even.row(v);
  }
  return gathered;
}

}  // namespace lightwell
