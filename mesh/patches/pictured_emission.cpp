#include "mesh/patches/pictured_emission.h"

#include <algorithm>

#include "mesh/patches/patch_textures.h"
#include "scene/facet_textures.h"

namespace lightwell {

PicturedEmission::PicturedEmission(const PatchMesh& mesh) : mesh_(&mesh) {
  if (!mesh.textures || !mesh.textures->has_emission()) return;
  textures_ = mesh.textures.get();
  const Eigen::Index bands = mesh.emission.cols();
  std::vector<Eigen::ArrayXd> sent, pictured;  // W of each facet: of patches, of the picture
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    const auto facet = static_cast<std::size_t>(mesh.facet[e]);
    if (!textures_->has_emission(mesh.facet[e]) || !(mesh.emission.row(p) > 0.0f).any()) continue;
    if (facet >= scale_of_.size()) scale_of_.resize(facet + 1, -1);
    if (scale_of_[facet] < 0) {
      scale_of_[facet] = static_cast<int>(sent.size());
      sent.emplace_back(Eigen::ArrayXd::Zero(bands));
      pictured.emplace_back(Eigen::ArrayXd::Zero(bands));
    }
    const auto i = static_cast<std::size_t>(scale_of_[facet]);
    sent[i] += mesh.element_area[e] * mesh.emission.row(p).transpose().cast<double>();
    pictured[i] += mesh.element_area[e] * mean_emission(mesh, *textures_, e).cast<double>();
  }
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const Eigen::ArrayXd scale =
        (pictured[i] > 0.0).select(sent[i] / pictured[i].max(1e-300), Eigen::ArrayXd::Zero(bands));
    scale_.push_back(scale.cast<float>());
  }
}

bool PicturedEmission::shines(int patch) const {
  const auto facet = static_cast<std::size_t>(mesh_->facet[mesh_->first_element[patch]]);
  return facet < scale_of_.size() && scale_of_[facet] >= 0 &&
         (mesh_->emission.row(patch) > 0.0f).any();
}

Spectrum PicturedEmission::at(int facet, const Eigen::Vector3d& point) const {
  return scale_[static_cast<std::size_t>(scale_of_[static_cast<std::size_t>(facet)])] *
         textures_->emission(facet, point);
}

Spectrum PicturedEmission::over(int facet, const Eigen::Vector3d& point,
                                const Eigen::Matrix<double, 3, 2>& footprint) const {
  return scale_[static_cast<std::size_t>(scale_of_[static_cast<std::size_t>(facet)])] *
         textures_->emission(facet, point, footprint);
}

Spectrum PicturedEmission::of_element(int element) const {
  const int patch = mesh_->patch[element];
  if (!shines(patch)) return mesh_->emission.row(patch).transpose();
  const auto facet = static_cast<std::size_t>(mesh_->facet[element]);
  return scale_[static_cast<std::size_t>(scale_of_[facet])] *
         mean_emission(*mesh_, *textures_, element);
}

Spectrum emission_at(const PatchMesh& mesh, int element, const Eigen::Vector3d& point) {
  const int p = mesh.patch[element], facet = mesh.facet[element];
  const Spectrum M = mesh.emission.row(p).transpose();
  if (!mesh.textures || !mesh.textures->has_emission(facet) || !(M > 0.0f).any()) return M;
  Eigen::ArrayXd power = Eigen::ArrayXd::Zero(M.size());
  for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
    power += mesh.element_area[e] * mean_emission(mesh, *mesh.textures, e).cast<double>();
  }
  const Spectrum mean = (power / mesh.area[p]).cast<float>();
  return (mean > 0.0f).select(M * mesh.textures->emission(facet, point) / mean, 0.0f);
}

BandArray facet_emission(const PatchMesh& mesh) {
  const int facets = mesh.facet.empty() ? 0 : 1 + *std::ranges::max_element(mesh.facet);
  const Eigen::Index bands = mesh.emission.cols();
  Eigen::ArrayXXd power = Eigen::ArrayXXd::Zero(facets, bands);
  Eigen::ArrayXd area = Eigen::ArrayXd::Zero(facets);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto M = mesh.emission.row(mesh.patch[e]);
    if (!(M > 0.0f).any()) continue;
    power.row(mesh.facet[e]) += mesh.element_area[e] * M.cast<double>();
    area[mesh.facet[e]] += mesh.element_area[e];
  }
  for (int f = 0; f < facets; ++f) {
    if (area[f] > 0.0) power.row(f) /= area[f];
  }
  return power.cast<float>();
}

BandArray vertex_emission(const PatchMesh& mesh) {
  const std::vector<int> patch = vertex_patches(mesh);
  BandArray M(mesh.vertex_count(), mesh.emission.cols());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    M.row(v) = mesh.emission.row(patch[static_cast<std::size_t>(v)]);
  }
  if (!mesh.textures || !mesh.textures->has_emission()) return M;
  const PicturedEmission emission(mesh);
  BandArray power = BandArray::Zero(M.rows(), M.cols());
  Eigen::ArrayXf area = Eigen::ArrayXf::Zero(M.rows());
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!emission.shines(mesh.patch[e])) continue;
    const auto weight = static_cast<float>(mesh.element_area[e]);
    const Spectrum of_element = emission.of_element(e);
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      power.row(mesh.corners[e][c]) += weight * of_element.transpose();
      area[mesh.corners[e][c]] += weight;
    }
  }
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (area[v] > 0.0f) M.row(v) = power.row(v) / area[v];
  }
  return M;
}

}  // namespace lightwell
