#include "scene/facet_normals.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "scene/sampling.h"

namespace lightwell {
namespace {

// Smallest cosine between a smooth normal and its facet's normal; normals in files may be
// arbitrary.
constexpr double least_cosine = 1e-3;

}  // namespace

FacetNormals::FacetNormals(const Scene& scene) {
  const auto has_normals = [](const Surface& surface) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    return mesh && !mesh->normal_maps.empty();
  };
  if (std::ranges::none_of(scene.surfaces, has_normals)) return;
  const auto add = [&](double x) { hash_ = random_key(hash_, std::bit_cast<std::uint64_t>(x)); };
  for (const Surface& surface : scene.surfaces) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    if (!has_normals(surface)) {
      entries_.insert(entries_.end(), mesh ? mesh->facets.size() : 1, Entry{});
      continue;
    }
    const int first_map = static_cast<int>(maps_.size());
    maps_.insert(maps_.end(), mesh->normal_maps.begin(), mesh->normal_maps.end());
    for (const NormalMap& map : mesh->normal_maps) {
      for (const double x : map.gradient.reshaped()) add(x);
      for (const double x : map.offset) add(x);
    }
    for (const Facet& facet : mesh->facets) {
      Entry entry{.is_given = true, .first_corner = static_cast<int>(corners_.size())};
      if (facet.normal_map >= 0) {
        entry.map = first_map + facet.normal_map;
        if (facet.holes.empty()) {
          for (const int v : facet.boundary) {
            corners_.push_back(mesh->vertices[static_cast<std::size_t>(v)]);
          }
        }
      }
      entry.corners = static_cast<int>(corners_.size()) - entry.first_corner;
      add(entry.map);
      entries_.push_back(entry);
    }
  }
}

Eigen::Vector3d FacetNormals::at(int facet, const Eigen::Vector3d& point,
                                 const Eigen::Vector3d& normal) const {
  if (entries_.empty() || entry(facet).map < 0) return normal;
  Eigen::Vector3d smooth = maps_[static_cast<std::size_t>(entry(facet).map)].at(point);
  const double length = smooth.norm();
  if (!(length > 0.0)) return normal;
  smooth /= length;
  const double cosine = smooth.dot(normal);
  if (cosine < 0.0) smooth = -smooth;
  return std::abs(cosine) >= least_cosine ? smooth : normal;
}

double FacetNormals::height(int facet, const Eigen::Vector3d& point,
                            const Eigen::Vector3d& normal) const {
  if (entries_.empty() || entry(facet).corners == 0) return 0.0;
  const Entry& here = entry(facet);
  const Eigen::Vector3d n = at(facet, point, normal);
  double least = std::numeric_limits<double>::infinity();
  for (int i = here.first_corner; i < here.first_corner + here.corners; ++i) {
    const Eigen::Vector3d& corner = corners_[static_cast<std::size_t>(i)];
    // The slope of a height is the normal's component in the plane over the component along the
    // facet's normal.
    const Eigen::Vector3d m = at(facet, corner, normal);
    const Eigen::Vector3d slopes = n / n.dot(normal) + m / m.dot(normal);
    least = std::min(least, 0.5 * (corner - point).dot(slopes));
  }
  return std::max(0.0, least);
}

Eigen::Vector3d on_its_side(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal,
                            bool crosses) {
  const double height = direction.dot(normal);
  const bool is_wrong = crosses ? height > 0.0 : height < 0.0;
  return is_wrong ? Eigen::Vector3d(direction - 2.0 * height * normal) : direction;
}

}  // namespace lightwell
