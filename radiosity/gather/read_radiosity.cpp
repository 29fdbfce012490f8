#include "radiosity/gather/read_radiosity.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "mesh/patches/patch_textures.h"
#include "mesh/patches/translucency.h"

namespace lightwell {
namespace {

// True for the vertices of sheets with pictures; empty: there are none.
std::vector<char> vertices_of_pictured_sheets(const PatchMesh& mesh,
                                              const PicturedReflectance& pictures) {
  std::vector<char> chosen;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!pictures.varies_on_sheet(e)) continue;
    chosen.resize(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (int c = 0; c < mesh.corner_count(e); ++c) chosen[mesh.corners[e][c]] = 1;
  }
  return chosen;
}

}  // namespace

BandArray reflected_by_sheets(const PatchMesh& mesh, const PicturedReflectance& pictures,
                              const BandArray& radiosity) {
  const std::vector<char> chosen = vertices_of_pictured_sheets(mesh, pictures);
  if (chosen.empty()) return {};
  const std::vector<int> patch = vertex_patches(mesh), behind = vertices_behind(mesh);
  const BandArray reflectance = vertex_reflectance(mesh);
  const Eigen::Index bands = mesh.reflectance.cols();
  BandArray reflected = BandArray::Zero(radiosity.rows(), radiosity.cols());
  // The difference is divided by rho - tau, and with the difference its noise: twenty times at
  // most.
  constexpr float least = 0.05f;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int other = behind.empty() ? -1 : behind[v];
    if (chosen[v] == 0 || other < 0) continue;
    for (Eigen::Index k = 0; k < radiosity.cols(); ++k) {
      const float rho = reflectance(v, k % bands), tau = mesh.transmittance(patch[v], k % bands);
      const float B = radiosity(v, k), B_behind = radiosity(other, k), all = rho + tau;
      if (!(all > 0.0f)) continue;
      const float sum = (B + B_behind) / all;
      const bool tells = std::abs(rho - tau) >= least * all;
      const float difference = tells ? (B - B_behind) / (rho - tau) : 0.0f;
      // E and E_behind are not negative.
      reflected(v, k) = rho * 0.5f * (sum + std::clamp(difference, -std::abs(sum), std::abs(sum)));
    }
  }
  return reflected;
}

}  // namespace lightwell
