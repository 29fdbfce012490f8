#include "scene/facet_relief.h"

#include <Eigen/LU>
#include <bit>
#include <cmath>

#include "scene/sampling.h"

namespace lightwell {
namespace {

// Returns the gradient of the height for slopes of 1 to the right and downwards of the picture.
// Zero where the coordinates do not span the facet.
//
// A position (x, y) in the picture has the gradients of x and y over the facet; the inverse map has
// the edges dp/dx and dp/dy of the picture on the facet. A rise over run s along dp/dx is the
// height s |dp/dx| per unit of x.
Eigen::Matrix<double, 3, 2> gradient_of_slopes(const Relief& relief, const UvMap& uv) {
  const Eigen::Matrix<double, 3, 2> gradients =
      (relief.slopes.placement.leftCols<2>() * uv.gradient).transpose();
  const Eigen::Matrix2d products = gradients.transpose() * gradients;
  constexpr double least_sine = 1e-6;
  const double spanned = products.determinant();
  if (!(spanned > least_sine * least_sine * products(0, 0) * products(1, 1))) {
    return Eigen::Matrix<double, 3, 2>::Zero();
  }
  Eigen::Vector2d per_unit(relief.slopes.picture->width(), relief.slopes.picture->height());
  if (!relief.is_in_metres) {
    const Eigen::Matrix<double, 3, 2> edges = gradients * products.inverse();
    per_unit = edges.colwise().norm();
  }
  return relief.scale * gradients * per_unit.asDiagonal();
}

}  // namespace

FacetRelief::FacetRelief(const Scene& scene) {
  std::vector<int> relief_of_material;
  for (const Material& material : scene.materials) {
    relief_of_material.push_back(material.relief ? static_cast<int>(reliefs_.size()) : -1);
    if (material.relief) reliefs_.push_back(*material.relief);
  }
  if (reliefs_.empty()) return;
  bool any = false;
  for (const Surface& surface : scene.surfaces) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    const int relief = relief_of_material[static_cast<std::size_t>(surface.material)];
    if (!mesh || relief < 0) {
      entry_of_.insert(entry_of_.end(), mesh ? mesh->facets.size() : 1, -1);
      continue;
    }
    const int first = static_cast<int>(entries_.size());
    for (const UvMap& uv : mesh->uv_maps) {
      const Relief& what = reliefs_[static_cast<std::size_t>(relief)];
      entries_.push_back({.relief = relief, .uv = uv, .of_slopes = gradient_of_slopes(what, uv)});
      add_to_hash(entries_.back());
    }
    for (const Facet& facet : mesh->facets) {
      entry_of_.push_back(facet.uv_map >= 0 ? first + facet.uv_map : -1);
      any = any || facet.uv_map >= 0;
    }
  }
  if (!any) entry_of_.clear();
  if (!any) hash_ = 0;
}

void FacetRelief::add_to_hash(const Entry& entry) {
  const auto add = [&](std::uint64_t bits) { hash_ = random_key(hash_, bits); };
  const auto add_numbers = [&](const auto& numbers) {
    for (const double x : numbers.reshaped()) add(std::bit_cast<std::uint64_t>(x));
  };
  const Relief& relief = reliefs_[static_cast<std::size_t>(entry.relief)];
  add(relief.slopes.picture->hash());
  for (const TextureWrap wrap : relief.slopes.wrap) add(static_cast<std::uint64_t>(wrap));
  add(static_cast<std::uint64_t>(relief.slopes.is_smooth));
  add_numbers(relief.slopes.placement);
  add(std::bit_cast<std::uint64_t>(relief.steepest));
  add_numbers(entry.of_slopes);
  add_numbers(entry.uv.gradient);
  add_numbers(entry.uv.offset);
}

Eigen::Vector3d FacetRelief::rise(int facet, const Eigen::Vector3d& point,
                                  const Eigen::Matrix<double, 3, 2>& footprint) const {
  const Entry& entry =
      entries_[static_cast<std::size_t>(entry_of_[static_cast<std::size_t>(facet)])];
  const Relief& relief = reliefs_[static_cast<std::size_t>(entry.relief)];
  const SurfaceTexture& image = relief.slopes;
  const Eigen::Vector2d uv = entry.uv.at(point);
  const Eigen::Array3f shares = image.over(uv, entry.uv.gradient * footprint);
  Eigen::Vector2d slope = relief.steepest * (2.0 * shares.head<2>().cast<double>() - 1.0).matrix();
  const Eigen::Vector2d place = image.placement.leftCols<2>() * uv + image.placement.col(2);
  for (const int axis : {0, 1}) {
    // Every other repetition of a mirrored picture slopes the other way.
    const bool is_mirrored = image.wrap[static_cast<std::size_t>(axis)] == TextureWrap::mirror &&
                             std::fmod(std::floor(place[axis]), 2.0) != 0.0;
    if (is_mirrored) slope[axis] = -slope[axis];
  }
  const Eigen::Vector3d rise = entry.of_slopes * slope;
  const double length = rise.norm();
  return length > steepest_relief ? Eigen::Vector3d(rise * (steepest_relief / length)) : rise;
}

}  // namespace lightwell
