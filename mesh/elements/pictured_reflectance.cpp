#include "mesh/elements/pictured_reflectance.h"

#include <cmath>

#include "mesh/patches/patch_textures.h"
#include "scene/facet_textures.h"

namespace lightwell {

PicturedReflectance::PicturedReflectance(const PatchMesh& mesh) : mesh_(mesh) {
  if (mesh.textures && !mesh.textures->is_empty()) at_vertices_ = vertex_reflectance(mesh);
}

bool PicturedReflectance::is_pictured(int element) const {
  if (at_vertices_.size() == 0 || !mesh_.textures->is_textured(mesh_.facet[element])) return false;
  return !(mesh_.emission.row(mesh_.patch[element]) > 0.0f).any();
}

bool PicturedReflectance::varies(int element) const {
  return is_pictured(element) && mesh_.patch_behind(mesh_.patch[element]) < 0;
}

bool PicturedReflectance::varies_on_sheet(int element) const {
  return is_pictured(element) && mesh_.patch_behind(mesh_.patch[element]) >= 0;
}

Spectrum PicturedReflectance::factor(const Ray& ray, const ElementHit& hit,
                                     double solid_angle) const {
  Spectrum at_corners = Spectrum::Zero(at_vertices_.cols());
  for (int c = 0; c < mesh_.corner_count(hit.element); ++c) {
    at_corners += hit.weights[c] * at_vertices_.row(mesh_.corners[hit.element][c]).transpose();
  }
  const Spectrum here = reflectance(ray, hit, solid_angle);
  return (at_corners > 0.0f).select(here / at_corners, 1.0f);
}

Spectrum PicturedReflectance::reflectance(const Ray& ray, const ElementHit& hit,
                                          double solid_angle) const {
  const int facet = mesh_.facet[hit.element], patch = mesh_.patch[hit.element];
  const Eigen::Vector3d normal = element_center(mesh_, hit.element).normal;
  const double cosine = std::abs(normal.dot(ray.direction));
  const double area = hit.t * hit.t * solid_angle;  // across the ray
  if (mesh_.textures->has_pattern(facet) || !(4.0 * area < cosine * mesh_.area[patch])) {
    return mesh_.reflectance.row(patch).transpose();
  }
  // The corners are those of the surface at rest, which the picture lies on.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (int c = 0; c < mesh_.corner_count(hit.element); ++c) {
    point += double{hit.weights[c]} * mesh_.position(mesh_.corners[hit.element][c]);
  }
  Eigen::Matrix<double, 3, 2> footprint;
  footprint.col(0) = std::sqrt(area / cosine) * normal.unitOrthogonal();
  footprint.col(1) = normal.cross(footprint.col(0));
  return mesh_.textures->reflectance(facet, point, footprint);
}

}  // namespace lightwell
