#include "radiosity/gather/body_exits.h"

#include <algorithm>
#include <cmath>

#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/round_grid.h"
#include "radiosity/gather/vertex_points.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {

using Eigen::Vector3d;

// The way from a vertex to another corner of an element of the vertex.
struct BodyExits::Way {
  int towards = -1, patch = -1;
  Vector3d to = Vector3d::Zero();
};

namespace {

// The vertices of round shapes, in rising order.
std::vector<int> round_vertices(const PatchMesh& mesh) {
  std::vector<int> vertices;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!round_grid_of(mesh, mesh.facet[e])) continue;
    for (int c = 0; c < mesh.corner_count(e); ++c) vertices.push_back(mesh.corners[e][c]);
  }
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// A ray that ends before its own shape, which the ray meets where the point ahead lies on it.
Ray ray_before(const Vector3d& from, int facet, const Vector3d& to) {
  constexpr double far = 0.999;
  return {.origin = from, .direction = to - from, .t_max = far, .origin_group = facet};
}

// The point of a shape nearest to a place, on the side of a patch.
GatherPoint point_near(const PatchMesh& mesh, int patch, int facet, const Vector3d& place) {
  const RoundGrid& grid = *round_grid_of(mesh, facet);
  const Vector3d at = nearest_on(grid.shape, place);
  return {.position = at, .normal = round_normal(mesh, grid, patch, at), .facet = facet};
}

// A cosine-distributed ray of an even sequence (Roberts 2018, "R2"), the same for all vertices.
Ray even_ray(const GatherPoint& from, int number) {
  constexpr double along = 0.7548776662466927, across = 0.5698402909980532;
  const auto part = [&](double step) {
    const double sum = 0.5 + number * step;
    return static_cast<float>(sum - std::floor(sum));
  };
  Vector3d a, b;
  tangent_frame(from.normal, a, b);
  const Vector3d d = cosine_direction(part(along), part(across));
  return {.origin = from.position,
          .direction = d.x() * a + d.y() * b + d.z() * from.normal,
          .origin_group = from.facet};
}

GatherPoint place_of(const PatchMesh& mesh, const Ray& ray, const ElementHit& hit) {
  const Vector3d at = ray.origin + hit.t * ray.direction;
  if (const RoundGrid* grid = round_grid_of(mesh, hit.facet)) {
    return {.position = at,
            .normal = round_normal(mesh, *grid, mesh.patch[hit.element], at),
            .facet = hit.facet};
  }
  return {.position = at, .normal = element_center(mesh, hit.element).normal, .facet = hit.facet};
}

}  // namespace

BodyExits::BodyExits(const LitScene& lit)
    : caster_(lit.caster), has_sky_(lit.direct_light.dome() != nullptr) {
  const PatchMesh& mesh = lit.mesh();
  if (mesh.round_grids.empty()) return;
  for (const FacetRef& facet : scene_facets(lit.scene)) {
    const Surface& surface = lit.scene.surfaces[static_cast<std::size_t>(facet.surface)];
    const Material& material = lit.scene.materials[static_cast<std::size_t>(surface.material)];
    is_clear_.push_back(
        material.dielectric || material.passes_straight() || material.is_translucent() ? 1 : 0);
  }
  const std::vector<int> vertices = round_vertices(mesh);
  std::vector<GatherPoint> points;
  const VertexGatherPoints on_facets(mesh);
  for (const int v : vertices) points.push_back(on_facets.on_facet(v));
  const std::vector<char> meets = find_backs(vertices, points);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (meets[i] == 0) continue;
    if (const auto exit = nearest_exit(vertices[i], points[i])) all_.push_back(*exit);
  }
}

std::vector<BodyExits::Way> BodyExits::ways_from(int vertex, int facet) const {
  const PatchMesh& mesh = caster_.mesh();
  std::vector<Way> ways;
  for (const auto face : mesh.elements->vf_range(HalfedgeMesh::VertexHandle(vertex))) {
    const int e = face.idx();
    if (mesh.facet[e] != facet) continue;
    for (int i = 0; i < mesh.corner_count(e); ++i) {
      const int corner = mesh.corners[e][i];
      const auto is_known = [corner](const Way& way) { return way.towards == corner; };
      if (corner == vertex || std::ranges::any_of(ways, is_known)) continue;
      ways.push_back({corner, mesh.patch[e], mesh.position(corner)});
    }
  }
  return ways;
}

// Per vertex, 1 if a way first meets a back: few vertices that are not covered.
std::vector<char> BodyExits::find_backs(const std::vector<int>& vertices,
                                        const std::vector<GatherPoint>& points) const {
  std::vector<char> meets(vertices.size(), 0);
  constexpr int grain = 256;
  parallel_for(static_cast<int>(vertices.size()), grain, [&](int begin, int end) {
    std::vector<Ray> rays;
    std::vector<std::size_t> of;
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      for (const Way& way : ways_from(vertices[i], points[i].facet)) {
        rays.push_back(ray_before(points[i].position, points[i].facet, way.to));
        of.push_back(i);
      }
    }
    std::vector<ElementHit> hits(rays.size());
    caster_.closest_elements(rays, hits);
    for (std::size_t r = 0; r < rays.size(); ++r) {
      if (is_back(hits[r])) meets[of[r]] = 1;
    }
  });
  return meets;
}

// True if a ray leaves a body where it meets a facet.
bool BodyExits::is_back(const ElementHit& hit) const {
  return hit.facet >= 0 && hit.from_back && is_clear_[static_cast<std::size_t>(hit.facet)] == 0;
}

bool BodyExits::meets_back(const Ray& ray) const {
  ElementHit hit;
  caster_.closest_elements({&ray, 1}, {&hit, 1});
  return is_back(hit);
}

// A place `height` above a point, or half as high as whatever is above.
Vector3d BodyExits::place_above(const GatherPoint& point, double height) const {
  const Ray ray{.origin = point.position,
                .direction = point.normal,
                .t_max = 2.0 * height,
                .origin_group = point.facet};
  ElementHit hit;
  caster_.closest_elements({&ray, 1}, {&hit, 1});
  return point.position + (hit.facet < 0 ? height : 0.5 * hit.t) * point.normal;
}

// True if no diffuse path from a covered vertex comes to where a place outside is seen, and if at
// least a third of what the paths meet are backs. In a body on a floor every other end is a back,
// since no ray goes from a floor to the floor; in a body in the corner of a room three of six sides
// are. A room that a sheet divides meets the sheet's back with one of six sides. A third is more
// than four standard errors of the share among 192 rays from either.
bool BodyExits::is_apart(const GatherPoint& covered, const Vector3d& place) const {
  constexpr int paths = 32, bounces = 6;
  int met = 0, backs = 0;
  for (int path = 0; path < paths; ++path) {
    GatherPoint at = covered;
    for (int bounce = 0; bounce < bounces; ++bounce) {
      const Ray ray = even_ray(at, path * bounces + bounce);
      ElementHit hit;
      caster_.closest_elements({&ray, 1}, {&hit, 1});
      if (hit.facet < 0 && has_sky_) return false;
      if (hit.facet < 0) break;
      ++met;
      backs += hit.from_back ? 1 : 0;
      if (hit.element < 0) break;
      at = place_of(caster_.mesh(), ray, hit);
      const Vector3d way = place - at.position;
      if (!(way.dot(at.normal) > 0.0)) continue;
      const Ray back{
          .origin = at.position, .direction = way, .t_max = 1.0, .origin_group = at.facet};
      std::uint8_t is_blocked = 0;
      caster_.occluded({&back, 1}, {&is_blocked, 1});
      if (is_blocked == 0) return false;
    }
  }
  return 3 * backs >= met;
}

// The first point along a way that begins in a body at `from` from which the rest of the way meets
// no back; empty if there is none, or if the way meets no back at all.
std::optional<GatherPoint> BodyExits::exit_along(const Way& way, const GatherPoint& from) const {
  // The straight way runs below the round shape, which may leave the body later.
  constexpr int most_steps = 8;
  constexpr double clear = 0.02;  // share of the way, by which the point is clear of the body
  GatherPoint at = from;
  for (int step = 0; step < most_steps; ++step) {
    const Ray ray = ray_before(at.position, from.facet, way.to);
    ElementHit hit;
    caster_.closest_elements({&ray, 1}, {&hit, 1});
    if (!is_back(hit)) return step > 0 ? std::optional(at) : std::nullopt;
    const double along = std::min(1.0, hit.t + clear);
    at = point_near(caster_.mesh(), way.patch, from.facet, at.position + along * ray.direction);
  }
  return std::nullopt;
}

// The nearest exit of a vertex with its gather point; empty if the vertex is not covered.
std::optional<BodyExit> BodyExits::nearest_exit(int vertex, const GatherPoint& point) const {
  const Vector3d from = caster_.mesh().position(vertex);
  std::optional<BodyExit> nearest;
  double off = 0.0;
  for (const Way& way : ways_from(vertex, point.facet)) {
    const std::optional<GatherPoint> exit = exit_along(way, point);
    if (!exit) continue;
    const double distance = (exit->position - from).norm();
    if (nearest && distance >= off) continue;
    const Vector3d back = from - way.to;
    const double share = (exit->position - way.to).dot(back) / back.squaredNorm();
    constexpr double least = 1e-6;  // an exit at the other corner
    nearest = {.vertex = vertex,
               .towards = way.towards,
               .point = *exit,
               .middle = point_near(caster_.mesh(), way.patch, point.facet,
                                    0.5 * (exit->position + way.to)),
               .share = std::clamp(share, least, 1.0)};
    nearest->point.key = nearest->middle.key = static_cast<std::uint64_t>(vertex);
    off = distance;
  }
  if (!nearest || !is_apart(point, place_above(nearest->point, off))) return std::nullopt;
  return nearest;
}

bool BodyExits::covers(const PatchPoint& point) const {
  const PatchMesh& mesh = caster_.mesh();
  for (int i = 0; i < mesh.corner_count(point.element); ++i) {
    const int corner = mesh.corners[point.element][i];
    const auto exit = std::ranges::lower_bound(all_, corner, {}, &BodyExit::vertex);
    if (exit == all_.end() || exit->vertex != corner) continue;
    const Vector3d& outside = exit->point.position;
    if (meets_back(ray_before(point.position, mesh.facet[point.element], outside))) return true;
  }
  return false;
}

void copy_from_outside(const std::vector<BodyExit>& exits, BandArray& values) {
  const BandArray before = exits.empty() ? BandArray() : values;
  for (const BodyExit& exit : exits) values.row(exit.vertex) = before.row(exit.towards);
}

void light_covered_vertices(const LitScene& lit, const std::vector<BodyExit>& exits,
                            const BandArray& radiosity, const GatherOptions& options,
                            GatheredIrradiance& found) {
  if (exits.empty()) return;
  std::vector<GatherPoint> points;
  for (const BodyExit& exit : exits) points.insert(points.end(), {exit.middle, exit.point});
  const GatheredIrradiance outside = gather_irradiance(lit, radiosity, points, options);
  const GatheredIrradiance before = found;
  Eigen::Index row = 0;
  for (const BodyExit& exit : exits) {
    constexpr double least = 0.5;
    const auto gain = static_cast<float>(1.0 / std::max(exit.share, least));
    const Eigen::Index v = exit.vertex, b = exit.towards, middle = row++, end = row++;
    const auto drawn_on = [&](const BandArray& inner, const BandArray& at) {
      // Columns of channels may be more than those of a Spectrum.
      const Eigen::ArrayXf E_b = inner.row(b), E_M = at.row(middle), E_X = at.row(end);
      const Eigen::ArrayXf E = E_b + gain * (E_M - E_b + 0.5f * (E_X - E_b));
      return E.max(0.0f).eval();
    };
    found.direct.row(v) = drawn_on(before.direct, outside.direct);
    found.indirect.row(v) = drawn_on(before.indirect, outside.indirect);
    const float of_b = 1.0f - 1.5f * gain;
    found.variance[v] = of_b * of_b * before.variance[b] +
                        gain * gain * (outside.variance[middle] + 0.25f * outside.variance[end]);
  }
}

}  // namespace lightwell
