#include "raytrace/shading/shown_radiance.h"

#include <cstddef>
#include <numbers>

#include "mesh/patches/pictured_emission.h"
#include "scene/coat.h"
#include "scene/facet_textures.h"
#include "scene/specular.h"

namespace lightwell {
namespace {

// Share of light that a specular material mirrors or lets pass.
Spectrum passed_on(const Material& material) {
  return material.dielectric ? crossing_share(*material.dielectric) : mean_mirrored(material);
}
std::vector<Spectrum> passed_on(const std::vector<Material>& materials) {
  std::vector<Spectrum> shares;
  shares.reserve(materials.size());
  for (const Material& material : materials) shares.push_back(passed_on(material));
  return shares;
}

// Replaces the emission of facets that shine by a picture, which drawn pictures have, by its mean
// over the facet.
void even_out_emission(const PatchMesh& mesh, BandArray& B) {
  if (!mesh.textures || !mesh.textures->has_emission()) return;
  const auto shines = [&](int e) {
    return mesh.textures->has_emission(mesh.facet[e]) &&
           (mesh.emission.row(mesh.patch[e]) > 0.0f).any();
  };
  const BandArray M = vertex_emission(mesh), mean = facet_emission(mesh);
  std::vector<char> done(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!shines(e)) continue;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const int v = mesh.corners[e][c];
      if (done[static_cast<std::size_t>(v)]++ != 0) continue;
      B.row(v) += mean.row(mesh.facet[e]) - M.row(v);
    }
  }
}

}  // namespace

const Material* find_material(const PatchMesh& mesh, const std::vector<Material>& materials,
                              int element) {
  const auto m = static_cast<std::size_t>(mesh.material[mesh.patch[element]]);
  return m < materials.size() ? &materials[m] : nullptr;
}

BandArray shown_radiance(const PatchMesh& mesh, const RadiositySolution& solution,
                         const std::vector<Material>& materials) {
  const BandArray E = solution.irradiance();
  BandArray B = vertex_radiosity(mesh, solution);
  even_out_emission(mesh, B);
  const std::vector<Spectrum> shares = passed_on(materials);
  std::vector<char> done(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Material* material = find_material(mesh, materials, e);
    if (!material || !material->is_specular()) continue;
    const Spectrum& share = shares[static_cast<std::size_t>(material - materials.data())];
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const int v = mesh.corners[e][c];
      if (!done[v]) B.row(v) += share.transpose() * E.row(v);
      done[v] = 1;
    }
  }
  return B / std::numbers::pi_v<float>;
}

BandArray shown_radiance(const SolvedScene& solved, const std::vector<Material>& materials) {
  return shown_radiance(solved.mesh, solved.solution, materials);
}

Spectrum shown_reflectance(const PatchMesh& mesh, const std::vector<Material>& materials,
                           int patch) {
  Spectrum share = mesh.reflectance.row(patch).transpose();
  const Material* material = find_material(mesh, materials, mesh.first_element[patch]);
  if (!material || !material->is_specular()) return share;
  return share + passed_on(*material);
}

}  // namespace lightwell
