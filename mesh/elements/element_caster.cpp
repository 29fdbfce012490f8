#include "mesh/elements/element_caster.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "mesh/elements/element_tree.h"
#include "mesh/elements/quad_weights.h"
#include "mesh/patches/round_grid.h"
#include "scene/facet_textures.h"

namespace lightwell {
namespace {

using Eigen::Array4f;
using Eigen::Vector3d;

bool is_front_polygon(const PatchMesh& mesh, int patch) {
  const int facet = mesh.facet[mesh.first_element[patch]];
  return mesh.is_back[patch] == 0 && round_grid_of(mesh, facet) == nullptr;
}

// (alpha, beta) of QuadShape, of the quadrilateral with corners `c`.
Eigen::Vector2d shape_of_quad(const PatchMesh& mesh, const std::array<int, 4>& c) {
  const Vector3d p0 = mesh.position(c[0]);
  return in_terms_of<Vector3d>(mesh.position(c[1]) - p0, mesh.position(c[3]) - p0,
                               mesh.position(c[2]) - p0);
}

// Weights of the same place for the element on the other side, whose corners run (0, 3, 2, 1) or
// (0, 2, 1).
Array4f turned_weights(const Array4f& w, bool is_triangle) {
  return is_triangle ? Array4f(w[0], w[2], w[1], 0.0f) : Array4f(w[0], w[3], w[2], w[1]);
}

}  // namespace

ElementHit hit_behind(const PatchMesh& mesh, const ElementHit& hit) {
  ElementHit other = hit;
  other.element = mesh.twin[hit.element];
  other.from_back = !hit.from_back;
  other.weights = turned_weights(hit.weights, mesh.corner_count(hit.element) == 3);
  return other;
}

namespace {

// Sets the element and weights of `hit` at a point of a round shape.
void find_on_round(const PatchMesh& mesh, const RoundGrid& grid, const Vector3d& point,
                   ElementHit& hit) {
  const RoundGridPoint found = round_grid_point(grid, point);
  hit.element = grid.element[found.ring * grid.sectors + found.sector];
  hit.weights = round_weights(grid, found);
  if (!hit.from_back) return;
  hit.element = mesh.twin[hit.element];
  const bool is_triangle = ends_north(grid, found.ring) || ends_south(grid, found.ring);
  hit.weights =
      hit.element < 0 ? Array4f(Array4f::Zero()) : turned_weights(hit.weights, is_triangle);
}

// The primitives of a ray caster in its order: triangles, quadrilaterals, round shapes.
struct Primitives {
  std::vector<int> element{};  // on the front; of a round shape, the index of its grid
  std::vector<QuadShape> quad_shape{};
};

// The geometry of the facets of one part. `group_of` numbers these facets and is -1 for others.
template <class GroupOf>
CastGeometry cast_geometry(const PatchMesh& mesh, const GroupOf& group_of, Primitives& primitives) {
  CastGeometry geometry;
  std::vector<int> number(mesh.vertex_count(), -1);
  const auto vertex = [&](int v) {
    if (number[v] < 0) {
      number[v] = static_cast<int>(geometry.vertices.size());
      geometry.vertices.push_back(mesh.position(v));
    }
    return number[v];
  };
  const auto add = [&](int element, int facet) {
    geometry.group.push_back(group_of(facet));
    primitives.element.push_back(element);
  };
  const bool any_holes = mesh.textures && mesh.textures->has_holes();
  for (const int corner_count : {3, 4}) {
    for (int p = 0; p < mesh.patch_count(); ++p) {
      if (!is_front_polygon(mesh, p)) continue;
      for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
        if (mesh.corner_count(e) != corner_count || group_of(mesh.facet[e]) < 0) continue;
        const auto& c = mesh.corners[e];
        if (corner_count == 3) {
          geometry.triangles.push_back({vertex(c[0]), vertex(c[1]), vertex(c[2])});
        } else {
          geometry.quads.push_back({vertex(c[0]), vertex(c[1]), vertex(c[2]), vertex(c[3])});
          const Eigen::Vector2f shape = shape_of_quad(mesh, c).cast<float>();
          primitives.quad_shape.push_back({shape.x(), shape.y()});
        }
        add(e, mesh.facet[e]);
        if (any_holes) geometry.has_holes.push_back(mesh.textures->has_holes(mesh.facet[e]));
      }
    }
  }
  for (std::size_t g = 0; g < mesh.round_grids.size(); ++g) {
    if (group_of(mesh.round_grids[g].facet) < 0) continue;
    geometry.round_shapes.push_back(mesh.round_grids[g].shape);
    add(static_cast<int>(g), mesh.round_grids[g].facet);
  }
  return geometry;
}

}  // namespace

struct ElementCaster::Part {
  std::vector<int> facets{};  // by group; empty: groups are the scene's facets
  Primitives primitives{};
  std::optional<RayCaster> caster{};  // none if the part is empty
  // Ends of the triangles and of the quadrilaterals among the primitives; round
  // shapes follow.
  int triangles = 0, polygons = 0;

  template <class GroupOf>
  Part(const PatchMesh& mesh, std::vector<int> facets_of_groups, const GroupOf& group_of)
      : facets(std::move(facets_of_groups)) {
    CastGeometry geometry = cast_geometry(mesh, group_of, primitives);
    if (mesh.textures && mesh.textures->has_holes()) {
      geometry.is_hole = [textures = mesh.textures, own = facets](int group,
                                                                  const Vector3d& point) {
        return textures->is_hole(own.empty() ? group : own[group], point);
      };
    }
    if (geometry.group.empty()) return;
    caster.emplace(geometry);
    triangles = caster->triangle_count();
    polygons = triangles + caster->quad_count();
  }

  // The element hit for a primitive's hit. Elements are those of `mesh`: the mesh of this part, or
  // its refinement with `tree`.
  template <bool with_weights>
  ElementHit element_hit(const PatchMesh& mesh, const ElementTree* tree, const Ray& ray,
                         const Hit& hit) const {
    if (hit.primitive < 0) return {};
    ElementHit result{.facet = facets.empty() ? hit.group : facets[hit.group],
                      .element = primitives.element[hit.primitive],
                      .from_back = hit.from_back,
                      .t = hit.t};
    if (hit.primitive >= polygons) {
      const RoundGrid& grid = mesh.round_grids[result.element];
      find_on_round(mesh, grid, ray.origin + hit.t * ray.direction, result);
      return result;
    }
    if (tree || with_weights) {
      if (hit.primitive < triangles) {
        find_in_triangle(tree, hit, result);
      } else {
        find_in_quad(tree, hit, result);
      }
    }
    if (!hit.from_back) return result;
    const bool is_triangle = mesh.corner_count(result.element) == 3;
    result.element = mesh.twin[result.element];
    if (!with_weights) return result;
    result.weights =
        result.element < 0 ? Array4f(Array4f::Zero()) : turned_weights(result.weights, is_triangle);
    return result;
  }

  static void find_in_triangle(const ElementTree* tree, const Hit& hit, ElementHit& result) {
    if (!tree) {
      result.weights = {1.0f - hit.u - hit.v, hit.u, hit.v, 0.0f};
      return;
    }
    const ElementTree::ElementPoint found = tree->in_triangle(result.element, hit.u, hit.v);
    result.element = found.element;
    result.weights = found.weights;
  }

  void find_in_quad(const ElementTree* tree, const Hit& hit, ElementHit& result) const {
    const QuadShape& shape =
        primitives.quad_shape[static_cast<std::size_t>(hit.primitive - triangles)];
    const Eigen::Vector2d at = bilinear_coordinates(shape, hit.u, hit.v);
    if (!tree) {
      result.weights = bilinear_weights(at);
      return;
    }
    const ElementTree::ElementPoint found = tree->in_quad(result.element, shape, at);
    result.element = found.element;
    result.weights = found.weights;
  }

  template <bool with_weights>
  void cast(const PatchMesh& mesh, const ElementTree* tree, std::span<const Ray> rays,
            std::span<ElementHit> hits) const {
    constexpr std::size_t batch = 64;  // fits the stack and the first-level cache
    if (!caster) {
      std::ranges::fill(hits, ElementHit{});
      return;
    }
    if (rays.size() == 1) {  // as ray trees do; a whole buffer would cost a third of the ray
      Hit hit;
      caster->closest_hits(rays, {&hit, 1});
      hits[0] = element_hit<with_weights>(mesh, tree, rays[0], hit);
      return;
    }
    std::array<Hit, batch> buffer;
    for (std::size_t begin = 0; begin < rays.size(); begin += batch) {
      const std::size_t count = std::min(batch, rays.size() - begin);
      caster->closest_hits(rays.subspan(begin, count), std::span(buffer).first(count));
      for (std::size_t i = 0; i < count; ++i) {
        hits[begin + i] = element_hit<with_weights>(mesh, tree, rays[begin + i], buffer[i]);
      }
    }
  }
};

struct ElementCaster::Bodies {
  struct FacetBody {
    int body = -1;  // -1: the facet stands still
    int group = -1;
  };
  std::vector<RigidMotion> motions{};
  std::vector<Part> parts{};
  std::vector<FacetBody> of_facet{};  // by facet
};

ElementCaster::ElementCaster(const PatchMesh& mesh)
    : mesh_(mesh),
      still_(
          std::make_shared<const Part>(mesh, std::vector<int>(), [](int facet) { return facet; })) {
  find_hidden();
}

ElementCaster::ElementCaster(const PatchMesh& mesh, const Scene& scene) : mesh_(mesh) {
  auto bodies = std::make_shared<Bodies>();
  std::vector<int> body_of(scene.motions.size(), -1);
  std::vector<std::vector<int>> facets;  // by body
  const std::vector<FacetRef> refs = scene_facets(scene);
  for (std::size_t f = 0; f < refs.size(); ++f) {
    const int motion = scene.surfaces[static_cast<std::size_t>(refs[f].surface)].motion;
    Bodies::FacetBody& found = bodies->of_facet.emplace_back();
    if (motion < 0) continue;
    int& body = body_of[static_cast<std::size_t>(motion)];
    if (body < 0) {
      body = static_cast<int>(facets.size());
      facets.emplace_back();
      bodies->motions.push_back(scene.motions[static_cast<std::size_t>(motion)]);
    }
    std::vector<int>& own = facets[static_cast<std::size_t>(body)];
    found = {.body = body, .group = static_cast<int>(own.size())};
    own.push_back(static_cast<int>(f));
  }
  const auto& of_facet = bodies->of_facet;
  still_ = std::make_shared<const Part>(mesh, std::vector<int>(), [&](int facet) {
    return of_facet[static_cast<std::size_t>(facet)].body < 0 ? facet : -1;
  });
  for (std::size_t b = 0; b < facets.size(); ++b) {
    bodies->parts.emplace_back(mesh, std::move(facets[b]), [&](int facet) {
      const Bodies::FacetBody& found = of_facet[static_cast<std::size_t>(facet)];
      return found.body == static_cast<int>(b) ? found.group : -1;
    });
  }
  poses_.resize(bodies->parts.size());
  if (!bodies->parts.empty()) bodies_ = std::move(bodies);
  find_hidden();
}

ElementCaster::ElementCaster(const PatchMesh& mesh, const ElementCaster& base,
                             std::shared_ptr<const ElementTree> tree)
    : mesh_(mesh), still_(base.still_), tree_(std::move(tree)), hidden_(base.hidden_) {
  if (base.moves() || base.tree_)
    throw std::invalid_argument("the base caster has split elements or surfaces that move");
  if (!tree_) return;
  std::vector<std::uint8_t> hidden(static_cast<std::size_t>(mesh_.element_count()), 0);
  for (std::size_t e = 0; e + 1 < tree_->first_element.size(); ++e) {
    std::fill(hidden.begin() + tree_->first_element[e],
              hidden.begin() + tree_->first_element[e + 1], (*base.hidden_)[e]);
  }
  hidden_ = std::make_shared<const std::vector<std::uint8_t>>(std::move(hidden));
}

ElementCaster ElementCaster::at(double time) const {
  ElementCaster result = *this;
  for (std::size_t b = 0; b < poses_.size(); ++b) {
    result.poses_[b].forth = bodies_->motions[b].at(time);
    result.poses_[b].back = result.poses_[b].forth.inverse();
  }
  return result;
}

const Eigen::Isometry3d* ElementCaster::pose_of(int facet) const {
  if (!bodies_) return nullptr;
  const int body = bodies_->of_facet[static_cast<std::size_t>(facet)].body;
  return body < 0 ? nullptr : &poses_[static_cast<std::size_t>(body)].forth;
}

void ElementCaster::find_hidden() {
  std::vector<std::uint8_t> hidden(static_cast<std::size_t>(mesh_.element_count()), 0);
  for (int primitive = 0; primitive < still_->polygons; ++primitive) {
    hidden[still_->primitives.element[primitive]] =
        static_cast<std::uint8_t>((still_->caster->is_hidden(primitive, false) ? 1 : 0) |
                                  (still_->caster->is_hidden(primitive, true) ? 2 : 0));
  }
  hidden_ = std::make_shared<const std::vector<std::uint8_t>>(std::move(hidden));
}

bool ElementCaster::meets_first(int facet, int other, const Vector3d& direction) const {
  return still_->caster->meets_first(facet, other, direction);
}

int ElementCaster::hidden_elements(int patch) const {
  const bool is_back = mesh_.is_back[patch] != 0;
  int count = 0;
  for (int e = mesh_.first_element[patch]; e < mesh_.first_element[patch + 1]; ++e) {
    count += is_hidden(is_back ? mesh_.twin[e] : e, is_back) ? 1 : 0;
  }
  return count;
}

// `ray` as the caster of `body` expects it (-1: the caster of everything that stands still): moved
// to the body's rest pose; group numbers of other bodies become -1.
Ray ElementCaster::ray_for(int body, const Ray& ray) const {
  Ray result = ray;
  for (int* group : {&result.origin_group, &result.target_group}) {
    if (*group < 0) continue;
    const Bodies::FacetBody& found = bodies_->of_facet[static_cast<std::size_t>(*group)];
    if (found.body != body) {
      *group = -1;
    } else if (body >= 0) {
      *group = found.group;
    }
  }
  if (body < 0) return result;
  const Eigen::Isometry3d& back = poses_[static_cast<std::size_t>(body)].back;
  result.origin = back * ray.origin;
  result.direction = back.linear() * ray.direction;
  return result;
}

template <bool with_weights>
void ElementCaster::cast_at_bodies(std::span<const Ray> rays, std::span<ElementHit> hits) const {
  constexpr std::size_t batch = 64;
  std::array<Ray, batch> own;
  std::array<ElementHit, batch> met;
  for (std::size_t begin = 0; begin < rays.size(); begin += batch) {
    const std::size_t count = std::min(batch, rays.size() - begin);
    for (int body = -1; body < static_cast<int>(poses_.size()); ++body) {
      for (std::size_t i = 0; i < count; ++i) {
        own[i] = ray_for(body, rays[begin + i]);
        if (body >= 0 && hits[begin + i].facet >= 0) own[i].t_max = hits[begin + i].t;
      }
      const Part& part = body < 0 ? *still_ : bodies_->parts[static_cast<std::size_t>(body)];
      part.cast<with_weights>(mesh_, nullptr, {own.data(), count}, {met.data(), count});
      for (std::size_t i = 0; i < count; ++i) {
        if (body < 0 || met[i].facet >= 0) hits[begin + i] = met[i];
      }
    }
  }
}

template <bool with_weights>
void ElementCaster::cast(std::span<const Ray> rays, std::span<ElementHit> hits) const {
  assert(rays.size() == hits.size());
  if (bodies_) return cast_at_bodies<with_weights>(rays, hits);
  still_->cast<with_weights>(mesh_, tree_.get(), rays, hits);
}

void ElementCaster::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
  if (!bodies_) return still_->caster->occluded(rays, blocked);
  constexpr std::size_t batch = 64;
  std::array<Ray, batch> own;
  std::array<std::uint8_t, batch> is_blocked;
  std::array<std::size_t, batch> number;
  for (std::size_t begin = 0; begin < rays.size(); begin += batch) {
    const std::size_t size = std::min(batch, rays.size() - begin);
    std::fill_n(blocked.begin() + static_cast<std::ptrdiff_t>(begin), size, std::uint8_t{0});
    for (int body = -1; body < static_cast<int>(poses_.size()); ++body) {
      const Part& part = body < 0 ? *still_ : bodies_->parts[static_cast<std::size_t>(body)];
      if (!part.caster) continue;
      std::size_t count = 0;  // of rays not blocked so far
      for (std::size_t i = begin; i < begin + size; ++i) {
        if (blocked[i] != 0) continue;
        own[count] = ray_for(body, rays[i]);
        number[count++] = i;
      }
      part.caster->occluded({own.data(), count}, {is_blocked.data(), count});
      for (std::size_t k = 0; k < count; ++k) blocked[number[k]] = is_blocked[k];
    }
  }
}

void ElementCaster::closest_hits(std::span<const Ray> rays, std::span<ElementHit> hits) const {
  cast<true>(rays, hits);
}

void ElementCaster::closest_elements(std::span<const Ray> rays, std::span<ElementHit> hits) const {
  cast<false>(rays, hits);
}

ElementHit point_on_element(const PatchMesh& mesh, const PatchPoint& point) {
  const bool is_back = mesh.is_back[mesh.patch[point.element]] != 0;
  ElementHit result{
      .facet = mesh.facet[point.element], .element = point.element, .from_back = is_back};
  if (const RoundGrid* grid = round_grid_of(mesh, result.facet)) {
    find_on_round(mesh, *grid, point.position, result);
    return result;
  }
  const auto& c = mesh.corners[point.element];
  const bool is_triangle = mesh.corner_count(point.element) == 3;
  const Vector3d p0 = mesh.position(c[0]);
  const Eigen::Vector2d at = in_terms_of<Vector3d>(
      mesh.position(c[1]) - p0, mesh.position(c[is_triangle ? 2 : 3]) - p0, point.position - p0);
  if (is_triangle) {
    result.weights = Eigen::Array4d(1.0 - at[0] - at[1], at[0], at[1], 0.0).cast<float>();
  } else {
    const Eigen::Vector2d shape = shape_of_quad(mesh, c);
    result.weights = bilinear_weights(bilinear_coordinates(shape[0], shape[1], at[0], at[1], at));
  }
  return result;
}

Spectrum interpolate(const PatchMesh& mesh, const BandArray& vertex_values, const ElementHit& hit) {
  Spectrum value = Spectrum::Zero(vertex_values.cols());
  if (hit.element < 0) return value;
  const auto& c = mesh.corners[hit.element];
  for (int i = 0; i < mesh.corner_count(hit.element); ++i) {
    value += hit.weights[i] * vertex_values.row(c[i]).transpose();
  }
  return value;
}

}  // namespace lightwell
