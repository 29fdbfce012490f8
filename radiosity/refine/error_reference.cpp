#include "radiosity/refine/error_reference.h"

#include <algorithm>
#include <numeric>

namespace lightwell {

namespace {

constexpr double bright = 4.0;

}  // namespace

double error_reference(double mean_irradiance, double own_irradiance) {
  return std::max(mean_irradiance, own_irradiance / bright);
}

NoiseGoal noise_goal(double mean_irradiance, double share) {
  return {.irradiance = share * mean_irradiance, .share = share / bright};
}

std::vector<char> judged_patches(const PatchMesh& mesh, const SceneParts& parts) {
  BandArray light = mesh.reflectance;
  if (mesh.transmittance.size() > 0) light += mesh.transmittance;
  const bool any = (light > 0.0f).any();
  if (!any) light = mesh.emission;
  std::vector<char> judged(static_cast<std::size_t>(mesh.patch_count()), 0);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    judged[static_cast<std::size_t>(p)] =
        (light.row(p) > 0.0f).any() == any && parts.is_judged(p) ? 1 : 0;
  }
  return judged;
}

PartMeans::PartMeans(const SceneParts& parts)
    : parts_(parts),
      sum_(static_cast<std::size_t>(parts.judged_count()), 0.0),
      area_(sum_),
      judged_by_(sum_) {}

void PartMeans::add(int patch, double area, double irradiance) {
  const int part = parts_.judged_with(patch);
  sum_[part] += area * irradiance;
  area_[part] += area;
}

void PartMeans::finish() {
  constexpr double least = 1e-4;
  constexpr double small = 0.02;  // share of all area
  const double all = std::accumulate(area_.begin(), area_.end(), 0.0);
  double most = 0.0;
  for (std::size_t p = 0; p < sum_.size(); ++p) {
    judged_by_[p] = area_[p] > 0.0 ? sum_[p] / area_[p] : 0.0;
    if (area_[p] >= small * all) most = std::max(most, judged_by_[p]);
  }
  least_ = least * most;
  for (double& mean : judged_by_) mean = std::max(mean, least_);
}

namespace {

// Mean of the bands over the corners of an element.
double own_irradiance(const PatchMesh& mesh, const BandArray& irradiance, int element) {
  const int n = mesh.corner_count(element);
  double own = 0.0;
  for (int c = 0; c < n; ++c) {
    own += irradiance.row(mesh.corners[element][c]).cast<double>().mean() / n;
  }
  return own;
}

}  // namespace

PartMeans part_means(const PatchMesh& mesh, const BandArray& irradiance, const SceneParts& parts) {
  PartMeans means(parts);
  const std::vector<char> judged = judged_patches(mesh, parts);
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (judged[static_cast<std::size_t>(mesh.patch[e])] == 0) continue;
    means.add(mesh.patch[e], mesh.element_area[e], own_irradiance(mesh, irradiance, e));
  }
  means.finish();
  return means;
}

Eigen::ArrayXd error_references(const PatchMesh& mesh, const BandArray& irradiance,
                                const SceneParts& parts) {
  const PartMeans means = part_means(mesh, irradiance, parts);
  Eigen::ArrayXd references(mesh.element_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    references[e] =
        error_reference(means.of_patch(mesh.patch[e]), own_irradiance(mesh, irradiance, e));
  }
  return references;
}

double squared_range(const PatchMesh& mesh, const BandArray& irradiance, int element) {
  Spectrum low = irradiance.row(mesh.corners[element][0]).transpose(), high = low;
  for (int c = 1; c < mesh.corner_count(element); ++c) {
    const Spectrum E = irradiance.row(mesh.corners[element][c]).transpose();
    low = low.min(E);
    high = high.max(E);
  }
  return (high - low).cast<double>().square().mean();
}

}  // namespace lightwell
