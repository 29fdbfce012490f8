#include "mesh/patches/patch_sampler.h"

#include <Eigen/Geometry>
#include <bit>
#include <cmath>

#include "mesh/patches/inset.h"
#include "mesh/patches/round_grid.h"
#include "scene/facet_textures.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Least share of the element or grid by which samples stay inside. A point nearer to a contact line
// than single precision resolves may lie, for a ray, on the other side of what stands there, and
// would carry light through.
constexpr double least_share = 1e-4;

}  // namespace

PatchSampler::PatchSampler(const PatchMesh& mesh, int patch)
    : mesh_(mesh),
      patch_(patch),
      round_(round_grid_of(mesh, mesh.facet[mesh.first_element[patch]])),
      is_flat_(!round_ && mesh.facet_of(patch) >= 0) {
  if (mesh.textures && mesh.textures->has_holes()) {
    for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
      has_holes_ = has_holes_ || mesh.textures->has_holes(mesh.facet[e]);
    }
  }
  if (is_flat_) {
    normal_ = element_center(mesh, mesh.first_element[patch]).normal;
    grid_ = element_grid(mesh, patch);
  }
  if (!grid_) {
    add_parts(mesh.first_element[patch], mesh.first_element[patch + 1]);
    return;
  }
  const Vector3d along_row = grid_->columns * grid_->step, across = grid_->rows * grid_->rise;
  const double off_border =
      0.5 * along_row.cross(across).norm() / std::max(along_row.norm(), across.norm());
  const double inset = inset_share(mesh, off_border, least_share);
  corner_ = grid_->origin + 0.5 * inset * (along_row + across);
  along_row_ = (1.0 - inset) * along_row;
  across_ = (1.0 - inset) * across;
}

PatchSampler::PatchSampler(const PatchMesh& mesh, int patch, int element)
    : mesh_(mesh),
      patch_(patch),
      round_(round_grid_of(mesh, mesh.facet[element])),
      is_flat_(!round_),
      has_holes_(mesh.textures && mesh.textures->has_holes(mesh.facet[element])),
      normal_(element_center(mesh, element).normal) {
  add_parts(element, element + 1);
}

void PatchSampler::add_parts(int first_element, int end_element) {
  for (int e = first_element; e < end_element; ++e) {
    if (round_) {
      area_ += mesh_.element_area[e];
      parts_.push_back({.element = e, .area_up_to = area_});
      continue;
    }
    const auto [element, mean, normal] = element_center(mesh_, e);
    const double inset = inset_share(mesh_, e, least_share);
    // Shrunk edges, not edges between shrunk corners: rounding would leave needles without area.
    const Vector3d first = mesh_.position(mesh_.corners[e][0]);
    const auto edge_to = [&](int i) -> Vector3d {
      return (1.0 - inset) * (mesh_.position(mesh_.corners[e][i]) - first);
    };
    for (int i = 2; i < mesh_.corner_count(e); ++i) {
      const Vector3d first_edge = edge_to(i - 1), second_edge = edge_to(i);
      area_ += 0.5 * first_edge.cross(second_edge).norm();
      parts_.push_back({.element = e,
                        .area_up_to = area_,
                        .corner = first + inset * (mean - first),
                        .first_edge = first_edge,
                        .second_edge = second_edge,
                        .normal = is_flat_ ? normal_ : normal});
    }
  }
}

PatchPoint PatchSampler::point_beside_holes(double u, double v) const {
  PatchPoint point = any_point(u, v);
  const FacetTextures& textures = *mesh_.textures;
  const auto key = std::pair(std::bit_cast<std::uint64_t>(u), std::bit_cast<std::uint64_t>(v));
  // If one point in twenty is no hole, 4 % of the samples still end in a hole.
  constexpr std::uint64_t most_tries = 64;
  for (std::uint64_t i = 0; i < most_tries; ++i) {
    const int facet = mesh_.facet[point.element];
    if (!textures.has_holes(facet) || !textures.is_hole(facet, point.position)) break;
    point = any_point(random_uniform(random_key(key.first, key.second, 2 * i)),
                      random_uniform(random_key(key.first, key.second, 2 * i + 1)));
  }
  return point;
}

PatchPoint PatchSampler::point_on_part(double u, double v) const {
  const double area = u * area_;
  // Parts are mostly of one size, so a first guess saves the search.
  std::size_t i =
      std::min(static_cast<std::size_t>(u * static_cast<double>(parts_.size())), parts_.size() - 1);
  while (i > 0 && area < parts_[i - 1].area_up_to) --i;
  while (i + 1 < parts_.size() && area >= parts_[i].area_up_to) ++i;
  const Part& part = parts_[i];
  const double before = i == 0 ? 0.0 : parts_[i - 1].area_up_to;
  u = std::clamp((area - before) / (part.area_up_to - before), 0.0, 1.0);
  if (!round_) {
    // The square root makes the density even towards the corner.
    const double s = std::sqrt(u);
    return {.element = part.element,
            .position = part.corner + s * ((1.0 - v) * part.first_edge + v * part.second_edge),
            .normal = part.normal};
  }
  const RoundGridPoint cell =
      round_grid_point(*round_, element_center(mesh_, part.element).position);
  const Vector3d at = even_point(*round_, cell.ring, cell.sector, u, v);
  return {
      .element = part.element, .position = at, .normal = round_normal(mesh_, *round_, patch_, at)};
}

Ray cosine_ray(const PatchMesh& mesh, const PatchPoint& from, float u, float v) {
  Vector3d a, b;
  tangent_frame(from.normal, a, b);
  const Vector3d d = cosine_direction(u, v);
  return {.origin = from.position,
          .direction = d.x() * a + d.y() * b + d.z() * from.normal,
          .origin_group = mesh.facet[from.element]};
}

}  // namespace lightwell
