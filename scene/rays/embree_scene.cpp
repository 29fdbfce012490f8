#include "scene/rays/embree_scene.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <utility>

#include "scene/parallel.h"
#include "scene/rays/float_rounding.h"
#include "scene/round_shape.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

constexpr double near_roundings = 8.0;  // from a group to those that lie on it, along the normal

// Area of triangles and quads, m^2.
double area(const CastGeometry& source) {
  double sum = 0.0;
  const auto add = [&](int a, int b, int c) {
    const auto& v = source.vertices;
    sum += 0.5 * (v[b] - v[a]).cross(v[c] - v[a]).norm();
  };
  for (const auto& t : source.triangles) add(t[0], t[1], t[2]);
  for (const auto& q : source.quads) {
    add(q[0], q[1], q[2]);
    add(q[0], q[2], q[3]);
  }
  return sum;
}

template <class Visit>
void for_each_primitive_box(const CastGeometry& source, Visit visit) {
  std::size_t primitive = 0;
  const auto box_of = [&](std::span<const int> polygon) {
    Eigen::AlignedBox3d box;
    for (const int v : polygon) box.extend(source.vertices[v]);
    return box;
  };
  for (const auto& triangle : source.triangles) visit(source.group[primitive++], box_of(triangle));
  for (const auto& quad : source.quads) visit(source.group[primitive++], box_of(quad));
  for (const auto& shape : source.round_shapes) visit(source.group[primitive++], bounds(shape));
}

Eigen::Vector3d middle(const CastGeometry& source, std::span<const int> polygon) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int v : polygon) mean += source.vertices[v] / static_cast<double>(polygon.size());
  return mean;
}

}  // namespace

EmbreeScene::EmbreeScene(const CastGeometry& geometry) : EmbreeScene() {
  triangles = static_cast<int>(geometry.triangles.size());
  quads = static_cast<int>(geometry.quads.size());
  const int total = triangles + quads + static_cast<int>(geometry.round_shapes.size());
  if (static_cast<int>(geometry.group.size()) != total) {
    throw std::invalid_argument(
        fmt::format("RayCaster: {} groups given for {} primitives", geometry.group.size(), total));
  }
  group = geometry.group;

  find_roundings(geometry);
  planes = std::make_unique<CoplanarGroups>(geometry, rounding);

  // One thread builds, whatever the user's limit. The order inside Embree's leaves must not depend
  // on the number of threads: the order decides which of two primitives wins on a shared edge.
  const ThreadLimit one(1);
#ifdef LIGHTWELL_STD_THREADS
  device = rtcNewDevice("threads=1");
#else
  device = rtcNewDevice(nullptr);
#endif
  if (!device && rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (!device) {
    throw std::runtime_error(
        "Embree, which casts the rays, could not be started: it needs a processor with SSE2, and "
        "some hundred megabytes of memory");
  }
  scene = rtcNewScene(device);
  // Allows the filter, without measurable cost where none is given.
#if RTC_VERSION_MAJOR >= 4
  constexpr int filter_flag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
  constexpr int filter_flag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif
  rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | filter_flag));
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
  add_polygons(geometry);
  add_round_shapes(geometry);
  rtcCommitScene(scene);
  check();
  find_hidden(geometry);
}

EmbreeScene::~EmbreeScene() {
  if (scene) rtcReleaseScene(scene);
  if (device) rtcReleaseDevice(device);
}

// A backdrop far away must not coarsen the coordinates of a room.
void EmbreeScene::find_roundings(const CastGeometry& source) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for_each_primitive_box(source, [&](int g, const Eigen::AlignedBox3d& box) {
    if (g >= static_cast<int>(boxes.size())) boxes.resize(g + std::size_t{1});
    boxes[g].extend(box);
  });
  std::vector<Eigen::AlignedBox3d> known = boxes;
  std::erase_if(known, [](const auto& box) { return box.isEmpty(); });
  if (known.empty()) return;
  Eigen::AlignedBox3d all;
  for (const Eigen::AlignedBox3d& box : known) all.extend(box);
  const Eigen::AlignedBox3d scenery = scenery_box(known);
  center = scenery.center();
  rounding = ray_rounding(scenery.diagonal().norm());
  if (scenery.contains(all)) return;
  for (const Eigen::AlignedBox3d& box : boxes) {
    roundings.push_back(box.isEmpty() ? rounding : std::max(rounding, ray_rounding(box, center)));
  }
}

void EmbreeScene::check() const {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) {
    throw std::runtime_error(fmt::format(
        "Embree could not build the ray-casting scene (error {}): {}", static_cast<int>(error),
        error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory; use a larger patch size"
                                         : "please report the scene"));
  }
}

void EmbreeScene::attach(RTCGeometry geometry, GeometryId id) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

// Embree keeps a tree for every type of geometry, and a ray visits each. Where there are quads,
// triangles are therefore quads with a repeated last corner; u and v remain the same.
RTCGeometry EmbreeScene::polygon_geometry(const CastGeometry& source,
                                          std::span<const int> primitives,
                                          std::span<const CellSheet> with) const {
  const bool as_quads = quads > 0;
  const std::size_t corners = as_quads ? 4 : 3;
  std::vector<unsigned> index;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<int> number(source.vertices.size(), -1);
  for (const int p : primitives) {
    for (std::size_t c = 0; c < corners; ++c) {
      const int v = p < triangles ? source.triangles[p][std::min<std::size_t>(c, 2)]
                                  : source.quads[p - triangles][c];
      if (number[v] < 0) {
        number[v] = static_cast<int>(vertices.size());
        vertices.push_back(source.vertices[v]);
      }
      index.push_back(static_cast<unsigned>(number[v]));
    }
  }
  for (const CellSheet& sheet : with) {
    for (const Eigen::Vector3d& corner : sheet.corners) {
      index.push_back(static_cast<unsigned>(vertices.size()));
      vertices.push_back(corner);
    }
  }

  const RTCGeometry geometry =
      rtcNewGeometry(device, as_quads ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* to = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices.size()));
  auto* to_index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, as_quads ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
      corners * sizeof(unsigned), index.size() / corners));
  check();
  for (const Eigen::Vector3d& vertex : vertices) {
    for (int c = 0; c < 3; ++c) *to++ = static_cast<float>(vertex[c] - center[c]);
  }
  std::ranges::copy(index, to_index);
  return geometry;
}

// A surface that lies on one cell may hide that cell alone.
bool EmbreeScene::may_join(const CastGeometry& source, int quad) const {
  const auto p = static_cast<std::size_t>(triangles + quad);
  if (!source.has_holes.empty() && source.has_holes[p] != 0) return false;
  if (!planes->has_overlaps(group[p])) return true;
  return !planes->may_be_covered(group[p], middle(source, source.quads[quad]));
}

void EmbreeScene::add_polygons(const CastGeometry& source) {
  // Measured in a hall of 100 boxes: rays are quickest among some thousands of quads. The 600 quads
  // of its walls and boxes take a quarter longer, a million half as long again.
  constexpr double sheets_in_all = 3000.0;
  const double longest = std::sqrt(area(source) / sheets_in_all);
  sheets = join_cells(source, longest, rounding, [&](int quad) { return may_join(source, quad); });
  const auto add = [&](int p) {
    const bool has_holes = !source.has_holes.empty() && source.has_holes[p] != 0;
    (has_holes ? porous : solid).push_back(p);
  };
  for (int p = 0; p < triangles; ++p) add(p);
  for (const int quad : sheets.single) add(triangles + quad);
  sheets.single = {};
  if (!solid.empty() || !sheets.sheets.empty()) {
    attach(polygon_geometry(source, solid, sheets.sheets), polygons_id);
  }
  for (const CellSheet& sheet : sheets.sheets) {
    solid.push_back(triangles + sheets.cells[static_cast<std::size_t>(sheet.first)]);
  }
  if (porous.empty()) return;
  is_hole = source.is_hole;
  const RTCGeometry geometry = polygon_geometry(source, porous, {});
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryIntersectFilterFunction(geometry, skip_holes);
  rtcSetGeometryOccludedFilterFunction(geometry, skip_holes);
  attach(geometry, porous_id);
}

void EmbreeScene::skip_holes(const RTCFilterFunctionNArguments* args) {
  const auto& caster = *static_cast<const EmbreeScene*>(args->geometryUserPtr);
  const unsigned n = args->N;
  for (unsigned i = 0; i < n; ++i) {
    if (args->valid[i] != -1) continue;
    const Eigen::Vector3f from(RTCRayN_org_x(args->ray, n, i), RTCRayN_org_y(args->ray, n, i),
                               RTCRayN_org_z(args->ray, n, i));
    const Eigen::Vector3f along(RTCRayN_dir_x(args->ray, n, i), RTCRayN_dir_y(args->ray, n, i),
                                RTCRayN_dir_z(args->ray, n, i));
    const double t = RTCRayN_tfar(args->ray, n, i);
    const Eigen::Vector3d point = caster.center + from.cast<double>() + t * along.cast<double>();
    const int primitive = caster.porous[RTCHitN_primID(args->hit, n, i)];
    if (caster.is_hole(caster.group[primitive], point)) args->valid[i] = 0;
  }
}

void EmbreeScene::add_round_shapes(const CastGeometry& source) {
  if (source.round_shapes.empty()) return;
  round_set = {
      .shapes = source.round_shapes,
      .group = {group.end() - static_cast<std::ptrdiff_t>(source.round_shapes.size()), group.end()},
      .center = center,
      .rounding = rounding};
  attach(round_geometry(device, round_set), round_id);
}

// Groups that lie on a plane at `place`, group `on` itself included.
std::vector<int> EmbreeScene::groups_at(const Eigen::Vector3d& place, int on) const {
  struct Search : QueryContext {
    std::vector<int> found;
  } search;
  const Eigen::Vector3d& normal = planes->normal(on);
  const double reach = near_roundings * rounding_of(on);
  const Ray ray{.origin = place - reach * normal, .direction = normal};
  init(search, &ray);  // read by the callback of round shapes
  search.caster = this;
  const Eigen::Vector3d from = ray.origin - center;
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(from.x());
  query.ray.org_y = static_cast<float>(from.y());
  query.ray.org_z = static_cast<float>(from.z());
  query.ray.dir_x = static_cast<float>(normal.x());
  query.ray.dir_y = static_cast<float>(normal.y());
  query.ray.dir_z = static_cast<float>(normal.z());
  query.ray.tfar = static_cast<float>(2.0 * reach);
  query.ray.mask = ~0u;
  clear(query.hit);
  intersect(scene, search, query, [](const RTCFilterFunctionNArguments* args) {
    auto& here = *static_cast<Search*>(args->context);
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const auto& caster = *static_cast<const EmbreeScene*>(here.caster);
    here.found.push_back(caster.group[caster.primitive(hit)]);
    args->valid[0] = 0;  // continue to the next
  });
  return search.found;
}

// Primitives are tested at their centre: exact answers need primitives cut where others end.
void EmbreeScene::find_hidden(const CastGeometry& source) {
  hidden.assign(static_cast<std::size_t>(triangles + quads), 0);
  // Groups with holes hide nothing whole.
  std::vector<char> is_porous(
      group.empty() ? 0 : *std::max_element(group.begin(), group.end()) + std::size_t{1}, 0);
  for (const int p : porous) is_porous[group[p]] = 1;
  const auto look_at = [&](int p, std::span<const int> polygon) {
    const int g = group[p];
    if (!planes->has_overlaps(g)) return;
    const Eigen::Vector3d mean = middle(source, polygon);
    if (!planes->may_be_covered(g, mean)) return;
    const Eigen::Vector3d front =
        (source.vertices[polygon[1]] - source.vertices[polygon[0]])
            .cross(source.vertices[polygon[2]] - source.vertices[polygon[0]]);
    const int facing = front.dot(planes->normal(g)) > 0.0 ? 1 : -1;
    for (const int other : groups_at(mean, g)) {
      if (other == g || is_porous[other] || !planes->are_parallel(g, other)) continue;
      if (std::abs(planes->height(other, mean)) > near_roundings * rounding) continue;
      const int above = planes->order(other, g);
      if (above != 0) hidden[p] |= above == facing ? from_front : from_back;
    }
  };
  for (int i = 0; i < triangles; ++i) look_at(i, source.triangles[i]);
  for (int i = 0; i < quads; ++i) look_at(triangles + i, source.quads[i]);
  is_any_hidden = std::any_of(hidden.begin(), hidden.end(), [](auto sides) { return sides != 0; });
}

}  // namespace lightwell
