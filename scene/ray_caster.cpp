#include "scene/ray_caster.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>

#include "scene/parallel.h"

namespace lightwell {
namespace {

// Embree hands this back to the sphere callback, which needs the origin in double and its group.
#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
#else
using EmbreeContext = RTCIntersectContext;
#endif
struct QueryContext : EmbreeContext {
  const Ray* rays = nullptr;     // recentred; a lane's ray is rays[its id]
  const void* caster = nullptr;  // RayCaster::Impl, for the filter
};

void init(QueryContext& context, const Ray* rays) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&context);
#else
  rtcInitIntersectContext(&context);
#endif
  context.rays = rays;
}

void intersect(RTCScene scene, QueryContext& context, RTCRayHit& query,
               RTCFilterFunctionN filter = nullptr) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
  if (filter) {
    arguments.flags =
        static_cast<RTCRayQueryFlags>(arguments.flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
  }
  arguments.filter = filter;
  arguments.context = &context;
  rtcIntersect1(scene, &query, &arguments);
#else
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  context.filter = filter;
  rtcIntersect1(scene, &context, &query);
#endif
}

constexpr int packet_size = 16;

void intersect(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit16& query) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &context;
  rtcIntersect16(valid, scene, &query, &arguments);
#else
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, &query);
#endif
}

void occlude(RTCScene scene, QueryContext& context, const int* valid, RTCRay16& query) {
#if RTC_VERSION_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &context;
  rtcOccluded16(valid, scene, &query, &arguments);
#else
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &context, &query);
#endif
}

struct SphereSet {
  std::vector<Sphere> spheres;
  std::vector<int> group;
};

// The nearest root of |o + t d - c| = r in (0, t_max); for a ray that starts on this sphere the
// root at its own origin is the one of smaller magnitude and does not count. Negative: none.
double sphere_root(const Sphere& sphere, const Ray& ray, bool starts_here) {
  const Eigen::Vector3d oc = ray.origin - sphere.center;
  const double a = ray.direction.squaredNorm();
  const double half_b = oc.dot(ray.direction);
  // The perpendicular distance form keeps digits when the origin is far away (Haines et al. 2019,
  // "Precision improvements for ray/sphere intersection").
  const Eigen::Vector3d perpendicular = oc - (half_b / a) * ray.direction;
  const double discriminant = a * (sphere.radius * sphere.radius - perpendicular.squaredNorm());
  if (!(discriminant > 0.0)) return -1.0;
  const double root = std::sqrt(discriminant);
  const double low = (-half_b - root) / a, high = (-half_b + root) / a;
  if (starts_here) return std::abs(low) > std::abs(high) ? low : high;
  return low > 0.0 ? low : high;
}

void sphere_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& set = *static_cast<const SphereSet*>(args->geometryUserPtr);
  const Sphere& s = set.spheres[args->primID];
  const auto r = static_cast<float>(s.radius * (1.0 + 1e-6));
  args->bounds_o->lower_x = static_cast<float>(s.center.x()) - r;
  args->bounds_o->lower_y = static_cast<float>(s.center.y()) - r;
  args->bounds_o->lower_z = static_cast<float>(s.center.z()) - r;
  args->bounds_o->upper_x = static_cast<float>(s.center.x()) + r;
  args->bounds_o->upper_y = static_cast<float>(s.center.y()) + r;
  args->bounds_o->upper_z = static_cast<float>(s.center.z()) + r;
}

void sphere_intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& set = *static_cast<const SphereSet*>(args->geometryUserPtr);
  const Ray* rays = static_cast<const QueryContext*>(args->context)->rays;
  RTCRayN* query = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (!args->valid[lane]) continue;
    const Ray& ray = rays[RTCRayN_id(query, args->N, lane)];
    const double t =
        sphere_root(set.spheres[args->primID], ray, set.group[args->primID] == ray.origin_group);
    if (!(t > RTCRayN_tnear(query, args->N, lane) && t < RTCRayN_tfar(query, args->N, lane))) {
      continue;
    }
    RTCRayN_tfar(query, args->N, lane) = static_cast<float>(t);
    RTCHitN_geomID(hit, args->N, lane) = args->geomID;
    RTCHitN_primID(hit, args->N, lane) = args->primID;
    RTCHitN_u(hit, args->N, lane) = RTCHitN_v(hit, args->N, lane) = 0.0f;
  }
}

void sphere_occluded(const RTCOccludedFunctionNArguments* args) {
  const auto& set = *static_cast<const SphereSet*>(args->geometryUserPtr);
  const Ray* rays = static_cast<const QueryContext*>(args->context)->rays;
  const int group = set.group[args->primID];
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (!args->valid[lane]) continue;
    const Ray& ray = rays[RTCRayN_id(args->ray, args->N, lane)];
    if (group == ray.target_group) continue;
    const double t = sphere_root(set.spheres[args->primID], ray, group == ray.origin_group);
    if (t > RTCRayN_tnear(args->ray, args->N, lane) && t < RTCRayN_tfar(args->ray, args->N, lane)) {
      RTCRayN_tfar(args->ray, args->N, lane) = -std::numeric_limits<float>::infinity();
    }
  }
}

enum Kind { triangles, quads, spheres, kind_count };

// The plane and extent of a group's triangles and quads.
struct GroupPlane {
  int group = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // first component that is not 0 is positive
  double distance = 0.0;
  Eigen::AlignedBox3d box{};
};

std::vector<GroupPlane> group_planes(const CastGeometry& geometry, int groups) {
  std::vector<GroupPlane> planes(groups);
  const auto add = [&](int group, const auto& polygon) {
    GroupPlane& plane = planes[group];
    for (const int v : polygon) plane.box.extend(geometry.vertices[v]);
    if (!plane.normal.isZero()) return;
    const Eigen::Vector3d& a = geometry.vertices[polygon[0]];
    const Eigen::Vector3d n =
        (geometry.vertices[polygon[1]] - a).cross(geometry.vertices[polygon[2]] - a);
    if (!(n.norm() > 0.0)) return;
    plane.group = group;
    plane.normal = n.normalized();
    constexpr double rounding = 1e-9;
    for (int c = 0; c < 3; ++c) {
      if (std::abs(plane.normal[c]) < rounding) continue;
      if (plane.normal[c] < 0.0) plane.normal = -plane.normal;
      break;
    }
    plane.distance = plane.normal.dot(a);
  };
  const int triangle_count = static_cast<int>(geometry.triangles.size());
  for (int i = 0; i < triangle_count; ++i) add(geometry.group[i], geometry.triangles[i]);
  for (std::size_t i = 0; i < geometry.quads.size(); ++i) {
    add(geometry.group[triangle_count + static_cast<int>(i)], geometry.quads[i]);
  }
  std::erase_if(planes, [](const GroupPlane& p) { return p.normal.isZero(); });
  return planes;
}

// Which groups have another in their own plane, within `tolerance`, whose box overlaps. Where very
// many lie in one plane all count as touched: that only costs them the second query.
std::vector<char> touched_groups(const CastGeometry& geometry, double tolerance) {
  int groups = 0;
  for (const int g : geometry.group) groups = std::max(groups, g + 1);
  std::vector<GroupPlane> planes = group_planes(geometry, groups);
  std::sort(planes.begin(), planes.end(), [](const GroupPlane& a, const GroupPlane& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.group < b.group;
  });
  std::vector<char> touched(groups, 0);
  constexpr std::size_t many = 256;
  constexpr double parallel = 1.0 - 1e-9;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const GroupPlane& a = planes[i];
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const GroupPlane& b = planes[j];
      if (b.distance - a.distance > tolerance) break;
      const bool overlaps = a.normal.dot(b.normal) > parallel && a.box.intersects(b.box);
      if (j - i > many || overlaps) touched[a.group] = touched[b.group] = 1;
      if (j - i > many) break;
    }
  }
  return touched;
}

}  // namespace

struct RayCaster::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double rounding = 0.0;  // how far float coordinates move a point at most, metres
  std::vector<int> group;
  std::vector<char> is_touched;  // per group: another group lies in its plane, overlapping it
  SphereSet sphere_set;
  std::array<int, kind_count> count{};
  std::array<int, kind_count> first{};             // primitive number of a kind's first member
  std::array<int, kind_count> kind_of_geometry{};  // geomID -> Kind

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void check() const {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE) {
      throw std::runtime_error(fmt::format(
          "Embree could not build the ray-casting scene (error {}): {}", static_cast<int>(error),
          error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory; use a larger patch size"
                                           : "please report the scene"));
    }
  }

  void attach(RTCGeometry geometry, Kind kind) {
    rtcCommitGeometry(geometry);
    kind_of_geometry[rtcAttachGeometry(scene, geometry)] = kind;
    rtcReleaseGeometry(geometry);
  }

  template <std::size_t N>
  void add_polygons(const CastGeometry& source, const std::vector<std::array<int, N>>& polygons,
                    Kind kind) {
    if (polygons.empty()) return;
    const RTCGeometry geometry =
        rtcNewGeometry(device, N == 3 ? RTC_GEOMETRY_TYPE_TRIANGLE : RTC_GEOMETRY_TYPE_QUAD);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                          RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                          source.vertices.size()));
    auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, N == 3 ? RTC_FORMAT_UINT3 : RTC_FORMAT_UINT4,
        N * sizeof(unsigned), polygons.size()));
    check();
    for (const Eigen::Vector3d& vertex : source.vertices) {
      for (int c = 0; c < 3; ++c) *v++ = static_cast<float>(vertex[c] - center[c]);
    }
    for (const auto& polygon : polygons) {
      for (int corner : polygon) *index++ = static_cast<unsigned>(corner);
    }
    attach(geometry, kind);
  }

  Ray recentred(Ray ray) const {
    ray.origin -= center;
    return ray;
  }

  // An origin that lies exactly in its own plane, as on every axis-aligned wall, meets that plane
  // at exactly 0, at the cost of a second query; so rays begin just above 0, unless another surface
  // lies on their own and must be met there.
  float nearest(const Ray& ray) const {
    const bool alone = ray.origin_group >= 0 && !starts_touched(ray);
    return alone ? std::numeric_limits<float>::min() : 0.0f;
  }

  bool starts_touched(const Ray& ray) const {
    return ray.origin_group >= 0 && ray.origin_group < static_cast<int>(is_touched.size()) &&
           is_touched[ray.origin_group] != 0;
  }

  RTCRay embree_ray(const Ray& ray) const {
    RTCRay r;
    r.org_x = static_cast<float>(ray.origin.x());
    r.org_y = static_cast<float>(ray.origin.y());
    r.org_z = static_cast<float>(ray.origin.z());
    r.dir_x = static_cast<float>(ray.direction.x());
    r.dir_y = static_cast<float>(ray.direction.y());
    r.dir_z = static_cast<float>(ray.direction.z());
    r.tnear = nearest(ray);
    r.tfar = static_cast<float>(ray.t_max);
    r.time = 0.0f;
    r.mask = ~0u;
    r.id = 0;
    r.flags = 0;
    return r;
  }

  int primitive(const RTCHit& hit) const {
    return first[kind_of_geometry[hit.geomID]] + static_cast<int>(hit.primID);
  }

  // A sphere leaves its own origin out itself, and its far side does count.
  bool is_own_plane(const RTCHit& hit, const Ray& ray) const {
    return kind_of_geometry[hit.geomID] != spheres && group[primitive(hit)] == ray.origin_group;
  }

  static void skip_own_plane(const RTCFilterFunctionNArguments* args) {
    assert(args->N == 1);
    const auto& context = *static_cast<const QueryContext*>(args->context);
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const auto& caster = *static_cast<const Impl*>(context.caster);
    if (caster.is_own_plane(hit, *context.rays)) args->valid[0] = 0;
  }

  // Own-plane hits are mostly rounding at the ray's very start; they are rare, so stepping past
  // them here is cheaper than a filter callback on every candidate (measured 15 % of the ray rate).
  // A ray that starts a little before its own plane is another matter: stepping would also pass
  // what lies in that plane, the table under a block of glass. `ray` is recentred.
  Hit closest(const Ray& ray, int skipped_group) const {
    QueryContext context;
    init(context, &ray);
    context.caster = this;
    RTCRayHit query;
    query.ray = embree_ray(ray);
    // Where another surface lies on the own one, stepping past the own would step past both.
    RTCFilterFunctionN filter = starts_touched(ray) ? skip_own_plane : nullptr;
    constexpr int max_steps = 16;  // coincident own-plane primitives at one point
    for (int step = 0; step < max_steps; ++step) {
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      intersect(scene, context, query, filter);
      if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
      const int p = primitive(query.hit);
      const bool own = is_own_plane(query.hit, ray);
      if (!own && (skipped_group < 0 || group[p] != skipped_group)) {
        return make_hit(ray, query, p, kind_of_geometry[query.hit.geomID] == spheres);
      }
      if (own && query.ray.tfar * ray.direction.norm() > rounding) {
        filter = skip_own_plane;
      } else {
        // At least a normal number: Embree flushes denormals, and would meet the same place again.
        query.ray.tnear =
            std::max(std::numeric_limits<float>::min(),
                     std::nextafter(query.ray.tfar, std::numeric_limits<float>::infinity()));
      }
      query.ray.tfar = static_cast<float>(ray.t_max);
      if (!(query.ray.tnear < query.ray.tfar)) return {};
    }
    return {};
  }

  // At most one packet. Shadow rays come from one point to one emitter, so a packet of them goes
  // down the tree together (measured 3 to 4 times the rate of single rays).
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    const int lanes = static_cast<int>(rays.size());
    std::array<Ray, packet_size> local;
    alignas(64) std::array<int, packet_size> valid{};
    RTCRayHit16 query;
    for (int i = 0; i < packet_size; ++i) {
      if (i < lanes) local[i] = recentred(rays[i]);
      valid[i] = i < lanes ? -1 : 0;
      set_lane(query.ray, i, embree_ray(local[std::min(i, lanes - 1)]));
    }
    QueryContext context;
    init(context, local.data());
    RTCRay16 shadow = query.ray;
    occlude(scene, context, valid.data(), shadow);

    // A "blocked" may be the ray's own plane or its target: only then is the closest hit needed.
    bool any = false;
    for (int i = 0; i < lanes; ++i) {
      blocked[i] = shadow.tfar[i] < 0.0f;
      valid[i] = blocked[i] ? -1 : 0;
      any = any || blocked[i];
      query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (!any) return;
    intersect(scene, context, valid.data(), query);
    for (int i = 0; i < lanes; ++i) {
      if (!blocked[i]) continue;
      const unsigned geometry = query.hit.geomID[i];
      if (geometry == RTC_INVALID_GEOMETRY_ID) {
        blocked[i] = 0;
        continue;
      }
      const int p = first[kind_of_geometry[geometry]] + static_cast<int>(query.hit.primID[i]);
      const bool own = kind_of_geometry[geometry] != spheres && group[p] == local[i].origin_group;
      if (own || group[p] == local[i].target_group) {
        blocked[i] = closest(local[i], local[i].target_group).primitive >= 0;
      }
    }
  }

  static void set_lane(RTCRay16& packet, int i, const RTCRay& ray) {
    packet.org_x[i] = ray.org_x;
    packet.org_y[i] = ray.org_y;
    packet.org_z[i] = ray.org_z;
    packet.dir_x[i] = ray.dir_x;
    packet.dir_y[i] = ray.dir_y;
    packet.dir_z[i] = ray.dir_z;
    packet.tnear[i] = ray.tnear;
    packet.tfar[i] = ray.tfar;
    packet.time[i] = ray.time;
    packet.mask[i] = ray.mask;
    packet.id[i] = static_cast<unsigned>(i);
    packet.flags[i] = ray.flags;
  }

  Hit make_hit(const Ray& ray, const RTCRayHit& query, int p, bool is_sphere) const {
    Hit hit{.primitive = p, .t = query.ray.tfar, .u = query.hit.u, .v = query.hit.v};
    if (is_sphere) {
      const Sphere& sphere = sphere_set.spheres[query.hit.primID];
      hit.t = sphere_root(sphere, ray, group[p] == ray.origin_group);
      hit.from_back = (ray.origin + hit.t * ray.direction - sphere.center).dot(ray.direction) > 0.0;
    } else {
      const Eigen::Vector3d normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
      hit.from_back = normal.dot(ray.direction) > 0.0;
    }
    return hit;
  }
};

RayCaster::RayCaster(const CastGeometry& geometry) : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  m.count = {static_cast<int>(geometry.triangles.size()), static_cast<int>(geometry.quads.size()),
             static_cast<int>(geometry.spheres.size())};
  m.first = {0, m.count[triangles], m.count[triangles] + m.count[quads]};
  const int total = m.count[triangles] + m.count[quads] + m.count[spheres];
  if (static_cast<int>(geometry.group.size()) != total) {
    throw std::invalid_argument(
        fmt::format("RayCaster: {} groups given for {} primitives", geometry.group.size(), total));
  }
  m.group = geometry.group;

  Eigen::AlignedBox3d box;
  for (const auto& v : geometry.vertices) box.extend(v);
  for (const auto& s : geometry.spheres) box.extend(s.center);
  if (!box.isEmpty()) m.center = box.center();
  constexpr double roundings = 4.0;  // origin, vertices and the intersection's own arithmetic
  if (!box.isEmpty()) {
    m.rounding = roundings * 0.5 * box.diagonal().norm() * std::numeric_limits<float>::epsilon();
  }

  m.is_touched = touched_groups(geometry, m.rounding);

  // One thread builds, whatever the user's limit: the order inside Embree's leaves, and with it
  // which of two primitives wins on a shared edge, must not depend on it.
  const ThreadLimit one(1);
#ifdef LIGHTWELL_STD_THREADS
  m.device = rtcNewDevice("threads=1");
#else
  m.device = rtcNewDevice(nullptr);
#endif
  if (!m.device) throw std::runtime_error("Embree could not be started on this processor.");
  m.scene = rtcNewScene(m.device);
  // Allows the filter; costs nothing measurable where none is given.
#if RTC_VERSION_MAJOR >= 4
  constexpr int filter_flag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
  constexpr int filter_flag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif
  rtcSetSceneFlags(m.scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | filter_flag));
  rtcSetSceneBuildQuality(m.scene, RTC_BUILD_QUALITY_MEDIUM);
  m.add_polygons(geometry, geometry.triangles, triangles);
  m.add_polygons(geometry, geometry.quads, quads);
  if (m.count[spheres] > 0) {
    for (Sphere sphere : geometry.spheres) {
      sphere.center -= m.center;
      m.sphere_set.spheres.push_back(sphere);
    }
    m.sphere_set.group.assign(m.group.begin() + m.first[spheres], m.group.end());
    const RTCGeometry user = rtcNewGeometry(m.device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(user, static_cast<unsigned>(m.count[spheres]));
    rtcSetGeometryUserData(user, &m.sphere_set);
    rtcSetGeometryBoundsFunction(user, sphere_bounds, nullptr);
    rtcSetGeometryIntersectFunction(user, sphere_intersect);
    rtcSetGeometryOccludedFunction(user, sphere_occluded);
    m.attach(user, spheres);
  }
  rtcCommitScene(m.scene);
  m.check();
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

void RayCaster::closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const {
  assert(rays.size() == hits.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits[i] = impl_->closest(impl_->recentred(rays[i]), -1);
  }
}

void RayCaster::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
  assert(rays.size() == blocked.size());
  for (std::size_t begin = 0; begin < rays.size(); begin += packet_size) {
    const std::size_t count = std::min<std::size_t>(packet_size, rays.size() - begin);
    impl_->occluded(rays.subspan(begin, count), blocked.subspan(begin, count));
  }
}

int RayCaster::triangle_count() const {
  return impl_->count[triangles];
}
int RayCaster::quad_count() const {
  return impl_->count[quads];
}
int RayCaster::sphere_count() const {
  return impl_->count[spheres];
}

}  // namespace lightwell
