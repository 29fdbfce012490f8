#include "radiosity/refine/gather_noise.h"

#include <cmath>

#include "radiosity/gather/patch_power.h"
#include "radiosity/refine/error_reference.h"

namespace lightwell {

Eigen::ArrayXf vertex_variance(const PatchMesh& mesh, const Eigen::ArrayXf& ray_variance,
                               const Eigen::ArrayXf& rays) {
  const std::vector<int> patch = vertex_patches(mesh);
  const Eigen::ArrayXd of_patch = patch_integral(mesh, ray_variance).col(0);
  Eigen::ArrayXf variance(mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double area = mesh.area[patch[v]],
                 of_a_ray = area > 0.0 ? of_patch[patch[v]] / area : 0.0;
    variance[v] = static_cast<float>(of_a_ray / double{rays[v]});
  }
  return variance;
}

Eigen::ArrayXf gather_noise(const PatchMesh& mesh, const BandArray& irradiance,
                            const Eigen::ArrayXf& variance, const SceneParts& parts) {
  const Eigen::ArrayXd reference = error_references(mesh, irradiance, parts);
  Eigen::ArrayXf noise = Eigen::ArrayXf::Zero(mesh.element_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e);
    if (!(reference[e] > 0.0)) continue;
    double of_corners = 0.0;
    for (int c = 0; c < n; ++c) of_corners += double{variance[mesh.corners[e][c]]} / n;
    // The mean over the element of the sum of squared interpolation weights: the share that is left
    // of the variance of independent errors at the corners.
    const double interpolated = n == 4 ? 4.0 / 9.0 : 1.0 / 2.0;
    noise[e] = static_cast<float>(std::sqrt(of_corners * interpolated) / reference[e]);
  }
  return noise;
}

std::vector<double> rms_noises(const PatchMesh& mesh, const Eigen::ArrayXf& noise,
                               const SceneParts& parts) {
  std::vector<double> sum(static_cast<std::size_t>(parts.judged_count()), 0.0), area(sum);
  const std::vector<char> judged = judged_patches(mesh, parts);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int patch = mesh.patch[e];
    if (judged[static_cast<std::size_t>(patch)] == 0 || !parts.is_looked_at(patch)) continue;
    const int part = parts.judged_with(mesh.patch[e]);
    sum[part] += mesh.element_area[e] * std::pow(double{noise[e]}, 2);
    area[part] += mesh.element_area[e];
  }
  for (std::size_t p = 0; p < sum.size(); ++p) {
    sum[p] = area[p] > 0.0 ? std::sqrt(sum[p] / area[p]) : 0.0;
  }
  return sum;
}

double rms_noise(const PatchMesh& mesh, const Eigen::ArrayXf& noise) {
  return rms_noises(mesh, noise, {}).front();
}

}  // namespace lightwell
