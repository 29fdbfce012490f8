#include "mesh/patches/translucency.h"

#include <algorithm>

#include "mesh/patches/patch_textures.h"

namespace lightwell {
namespace {

using Row = Eigen::Array<float, 1, Eigen::Dynamic>;

// A row of values, columns of each channel in turn, times one factor for each band.
Row times(const BandArray& values, int row, const Row& factor) {
  return values.row(row) * factor.replicate(1, values.cols() / factor.cols());
}

}  // namespace

void set_transmittance(const Scene& scene, PatchMesh& mesh) {
  const auto translucent = [](const Material& material) { return material.is_translucent(); };
  if (std::ranges::none_of(scene.materials, translucent)) return;
  mesh.transmittance.setZero(mesh.patch_count(), scene.bands.count());
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material[p])];
    if (translucent(material)) mesh.transmittance.row(p) = material.transmittance.transpose();
  }
  mesh.behind = patches_behind(mesh);
}

std::vector<int> patches_behind(const PatchMesh& mesh) {
  if (mesh.transmittance.size() == 0) return {};
  std::vector<int> behind(static_cast<std::size_t>(mesh.patch_count()), -1);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const int twin = mesh.twin[mesh.first_element[p]];
    if (twin >= 0 && (mesh.transmittance.row(p) > 0.0f).any()) behind[p] = mesh.patch[twin];
  }
  return behind;
}

std::vector<int> vertices_behind(const PatchMesh& mesh) {
  if (mesh.transmittance.size() == 0) return {};
  std::vector<int> behind(static_cast<std::size_t>(mesh.vertex_count()), -1);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int twin = mesh.twin[e];
    if (twin < 0 || mesh.patch_behind(mesh.patch[e]) < 0) continue;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      // The corners of the other side run the other way around.
      const int count = mesh.corner_count(e), turned = (count - c) % count;
      int& other = behind[mesh.corners[e][c]];
      if (other < 0) other = mesh.corners[twin][turned];
    }
  }
  return behind;
}

bool scatters(const PatchMesh& mesh, int patch) {
  return (mesh.reflectance.row(patch) > 0.0f).any() ||
         (mesh.transmittance.size() > 0 && (mesh.transmittance.row(patch) > 0.0f).any());
}

Spectrum scattered_share(const PatchMesh& mesh, int patch) {
  Spectrum share = mesh.reflectance.row(patch).transpose();
  if (mesh.transmittance.size() > 0) share += mesh.transmittance.row(patch).transpose();
  return share;
}

BandArray scattered_by_patches(const PatchMesh& mesh, const BandArray& irradiance) {
  BandArray radiosity(irradiance.rows(), irradiance.cols());
  for (int p = 0; p < mesh.patch_count(); ++p) {
    radiosity.row(p) = times(irradiance, p, mesh.reflectance.row(p));
    const int behind = mesh.patch_behind(p);
    if (behind >= 0) radiosity.row(p) += times(irradiance, behind, mesh.transmittance.row(p));
  }
  return radiosity;
}

BandArray scattered_at_vertices(const PatchMesh& mesh, const BandArray& irradiance) {
  const BandArray rho = vertex_reflectance(mesh);
  BandArray radiosity(irradiance.rows(), irradiance.cols());
  for (int v = 0; v < mesh.vertex_count(); ++v) radiosity.row(v) = times(irradiance, v, rho.row(v));
  add_transmitted(mesh, irradiance, radiosity);
  return radiosity;
}

void add_transmitted(const PatchMesh& mesh, const BandArray& irradiance, BandArray& radiosity) {
  const std::vector<int> behind = vertices_behind(mesh);
  if (behind.empty()) return;
  const std::vector<int> patch = vertex_patches(mesh);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (behind[v] < 0) continue;
    radiosity.row(v) += times(irradiance, behind[v], mesh.transmittance.row(patch[v]));
  }
}

}  // namespace lightwell
