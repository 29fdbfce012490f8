#include "raytrace/shading/facet_shapes.h"

#include <cmath>

#include "scene/disjoint_sets.h"
#include "scene/sampling.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

// Returns the smooth surface of each facet: facets that share mesh vertices belong together, so
// that the facets of a tessellated column do not count as edges.
std::vector<int> smooth_surfaces(const PatchMesh& mesh, int facet_count) {
  DisjointSets surfaces(static_cast<std::size_t>(facet_count));
  std::vector<int> facet_of_vertex(mesh.vertex_count(), -1);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int facet = mesh.facet[e];
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      int& other = facet_of_vertex[mesh.corners[e][c]];
      if (other < 0) other = facet;
      surfaces.join(facet, other);
    }
  }
  std::vector<int> result;
  for (int f = 0; f < facet_count; ++f) result.push_back(surfaces.root(f));
  return result;
}

// Returns the part of SpecularSegment::chain that stands for a facet. Facets of one plane have the
// same; so have all facets of a curved surface.
std::uint64_t chain_key(bool is_curved, int surface, const Eigen::Vector3d& normal,
                        const Eigen::Vector3d& point, double diagonal) {
  constexpr double steps = 1e5;  // of directions, and of distances to scenery_length()
  if (is_curved) return random_key(static_cast<std::uint64_t>(surface), 1);
  const auto rounded = [](double x) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::llround(steps * x)));
  };
  return random_key(random_key(rounded(normal.x()), rounded(normal.y()), rounded(normal.z())),
                    rounded(normal.dot(point) / diagonal), 2);
}

}  // namespace

FacetShapes::FacetShapes(const Scene& scene, const PatchMesh& mesh, const FacetNormals& normals) {
  for (const FacetRef& ref : scene_facets(scene)) {
    const Surface& surface = scene.surfaces[ref.surface];
    FacetShape shape{.material = surface.material};
    if (const auto round = round_shape(surface)) {
      shape.round = static_cast<int>(round_.size());
      round_.push_back(*round);
    } else {
      const auto& polygons = std::get<PolygonMesh>(surface.shape);
      const Facet& facet = polygons.facets[ref.facet];
      shape.point = polygons.vertices[facet.boundary.front()];
      shape.normal = facet_normal(polygons, facet);
    }
    facets_.push_back(shape);
  }
  const auto joined = smooth_surfaces(mesh, static_cast<int>(facets_.size()));
  const double diagonal = scenery_length(scene);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    FacetShape& shape = facets_[f];
    shape.smooth_surface = joined[f];
    shape.chain = chain_key(shape.round >= 0 || normals.is_given(static_cast<int>(f)), joined[f],
                            shape.normal, shape.point, diagonal);
  }
}

Eigen::Vector3d FacetShapes::normal_against(const Eigen::Vector3d& direction, int facet,
                                            const Eigen::Vector3d& point) const {
  const FacetShape& shape = (*this)[facet];
  const Eigen::Vector3d normal = shape.round < 0 ? shape.normal : front_normal(round(shape), point);
  return normal.dot(direction) > 0.0 ? Eigen::Vector3d(-normal) : normal;
}

Eigen::Vector3d FacetShapes::smooth_normal(const PatchMesh& mesh, const FacetNormals& normals,
                                           const ElementHit& hit, const Eigen::Vector3d& point,
                                           const Eigen::Vector3d& normal) const {
  if ((*this)[hit.facet].round >= 0) return normal;
  if (normals.is_given(hit.facet)) return normals.at(hit.facet, point, normal);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int c = 0; c < mesh.corner_count(hit.element); ++c) {
    sum += hit.weights[c] * mesh.vertex_normal[mesh.corners[hit.element][c]];
  }
  return sum.norm() > 0.0 ? Eigen::Vector3d(sum.normalized()) : normal;
}

}  // namespace lightwell
