#include "scene/rays/ray_caster.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "scene/rays/embree_scene.h"
#include "scene/rays/float_rounding.h"

namespace lightwell {

struct RayCaster::Impl : EmbreeScene {
  using EmbreeScene::EmbreeScene;

  // A ray that starts on a group begins past the plane of the group by the bound of rounding, so
  // that the ray rarely meets that plane and needs a second query. If another surface may lie on
  // the plane ahead, the ray begins as far before the plane: the other surface, such as the table
  // under a block of glass, is then still ahead. Elsewhere such a start would be a leak: a ray from
  // the floor of a box, close to a wall, would pass under the wall.
  void set_ray(RTCRay& r, const Ray& ray, unsigned id) const {
    Eigen::Vector3d origin = ray.origin - center;
    r.tnear = 0.0f;
    if (ray.origin_group >= 0) {
      const Eigen::Vector3d& normal = planes->normal(ray.origin_group);
      const double own = rounding_of(ray.origin_group);
      const double past = starts_covered(ray) ? -own : own;
      origin += std::copysign(1.0, normal.dot(ray.direction)) * past * normal;
      r.tnear = std::numeric_limits<float>::min();
    }
    r.org_x = static_cast<float>(origin.x());
    r.org_y = static_cast<float>(origin.y());
    r.org_z = static_cast<float>(origin.z());
    r.dir_x = static_cast<float>(ray.direction.x());
    r.dir_y = static_cast<float>(ray.direction.y());
    r.dir_z = static_cast<float>(ray.direction.z());
    r.tfar = static_cast<float>(ends_covered(ray) ? past_target(ray) : before_target(ray));
    if (!is_in_range(origin)) make_empty(r);
    r.time = 0.0f;
    r.mask = ~0u;
    r.id = id;
    r.flags = 0;
  }

  // Embree refuses larger coordinates, and a ray from there meets nothing: the scene is smaller
  // than the rounding of the ray's origin.
  static bool is_in_range(const Eigen::Vector3d& origin) {
    constexpr double largest = 1e18;
    return (origin.array().abs() < largest).all();
  }

  static void make_empty(RTCRay& r) {
    r.org_x = r.org_y = r.org_z = r.tfar = 0.0f;
    r.tnear = std::numeric_limits<float>::min();
  }

  bool starts_covered(const Ray& ray) const {
    return planes->has_overlaps(ray.origin_group) &&
           planes->may_be_covered(ray.origin_group, ray.origin, ray.direction);
  }

  bool ends_covered(const Ray& ray) const {
    return ray.target_group >= 0 && planes->has_overlaps(ray.target_group);
  }

  // Rounding may move a surface that lies on the target behind the target. `counts` drops all else
  // that is met there.
  double past_target(const Ray& ray) const {
    constexpr double at_most = 1e-3;  // of the ray's length, where the ray grazes the target
    return ray.t_max + std::min(target_depth(ray), at_most * ray.t_max);
  }

  // A ray ends before the plane of its target, as it starts past its own plane. The target would
  // otherwise answer every other unblocked ray, which would be cast three times. Objects that stand
  // on the target must still hide the target, so rays that graze the target keep their full length
  // and are cast again. Round shapes have no plane.
  double before_target(const Ray& ray) const {
    constexpr double at_most = 1e-4;  // of the ray's length
    if (ray.target_group < 0) return ray.t_max;
    const double depth = target_depth(ray);
    return depth < at_most * ray.t_max ? ray.t_max - depth : ray.t_max;
  }

  // Largest displacement of the target by rounding, along a ray.
  double target_depth(const Ray& ray) const {
    const double along = std::abs(planes->normal(ray.target_group).dot(ray.direction));
    return coplanar_roundings * rounding_towards(ray) / along;
  }

  // Rounding where a ray meets its target.
  double rounding_towards(const Ray& ray) const {
    return std::max(rounding_of(ray.target_group), rounding_at(ray.origin));
  }

  // True if the plane of a hit coincides with that of group `with` where the ray meets the hit.
  bool is_coplanar(const RTCHit& hit, double off_plane, int with, double with_rounding) const {
    const int met = group[primitive(hit)];
    return std::abs(off_plane) <= coplanar_roundings * std::max(with_rounding, rounding_of(met)) &&
           planes->are_parallel(with, met);
  }

  // True if a hit is the surface that the ray meets. False for the ray's own plane, and for
  // surfaces on that plane that lie before the plane; for surfaces hidden by another; for the
  // target, and for surfaces on its plane that lie behind the target; and past the end of the ray.
  bool counts(const RTCHit& hit, float t, const Ray& ray, int target) const {
    const bool is_past = target >= 0 && t > static_cast<float>(ray.t_max);
    const int p = primitive(hit), g = group[p];
    if (hit.geomID == round_id) return target < 0 || (g != target && !is_past);
    if (g == ray.origin_group || (target >= 0 && g == target)) return false;
    if (ray.origin_group >= 0) {
      const double along = planes->normal(ray.origin_group).dot(ray.direction);
      if (is_coplanar(hit, t * along, ray.origin_group, rounding_of(ray.origin_group))) {
        return planes->order(g, ray.origin_group) * along > 0.0;
      }
    }
    if (is_any_hidden && hidden[p] != 0) {
      const Eigen::Vector3d facing(hit.Ng_x, hit.Ng_y, hit.Ng_z);
      const bool is_back = facing.dot(ray.direction) > 0.0;
      if ((hidden[p] & (is_back ? from_back : from_front)) != 0) return false;
    }
    if (target >= 0 && planes->has_overlaps(target)) {
      const Eigen::Vector3d at = ray.origin + static_cast<double>(t) * ray.direction;
      if (is_coplanar(hit, planes->height(target, at), target, rounding_towards(ray))) {
        return planes->order(g, target) * planes->normal(target).dot(ray.direction) < 0.0;
      }
    }
    return !is_past;
  }

  static void skip_what_does_not_count(const RTCFilterFunctionNArguments* args) {
    assert(args->N == 1);
    const auto& context = *static_cast<const QueryContext*>(args->context);
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const auto& caster = *static_cast<const Impl*>(context.caster);
    const Ray& ray = context.rays[RTCRayN_id(args->ray, 1, 0)];
    const float t = RTCRayN_tfar(args->ray, 1, 0);
    if (!caster.counts(hit, t, ray, context.target)) args->valid[0] = 0;
  }

  // Filter for packets of shadow rays: hits that do not count block no ray.
  static void skip_what_does_not_block(const RTCFilterFunctionNArguments* args) {
    const auto& context = *static_cast<const QueryContext*>(args->context);
    const auto& caster = *static_cast<const Impl*>(context.caster);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
      if (args->valid[i] == 0) continue;
      RTCHit hit;
      hit.geomID = RTCHitN_geomID(args->hit, n, i);
      hit.primID = RTCHitN_primID(args->hit, n, i);
      hit.Ng_x = RTCHitN_Ng_x(args->hit, n, i);
      hit.Ng_y = RTCHitN_Ng_y(args->hit, n, i);
      hit.Ng_z = RTCHitN_Ng_z(args->hit, n, i);
      const Ray& ray = context.rays[RTCRayN_id(args->ray, n, i)];
      const float t = RTCRayN_tfar(args->ray, n, i);
      if (!caster.counts(hit, t, ray, ray.target_group)) args->valid[i] = 0;
    }
  }

  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const {
    // All queries are written before Embree reads the first: a vector load of words just stored one
    // by one would stall.
    constexpr std::size_t batch = 32;
    std::array<RTCRayHit, batch> queries;
    QueryContext context;
    init(context, nullptr);
    for (std::size_t begin = 0; begin < rays.size(); begin += batch) {
      const std::size_t size = std::min(batch, rays.size() - begin);
      context.rays = rays.data() + begin;
      for (std::size_t i = 0; i < size; ++i) {
        set_ray(queries[i].ray, context.rays[i], static_cast<unsigned>(i));
        clear(queries[i].hit);
      }
      for (std::size_t i = 0; i < size; ++i) intersect(scene, context, queries[i]);
      for (std::size_t i = 0; i < size; ++i) {
        answer(context.rays[i], queries[i], hits[begin + i]);
      }
    }
  }

  void answer(const Ray& ray, const RTCRayHit& query, Hit& hit) const {
    constexpr int no_target = -1;
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
      hit = {};
    } else if (counts(query.hit, query.ray.tfar, ray, no_target)) {
      set_hit(ray, query, hit);
    } else {
      hit = closest(ray, no_target);
    }
  }

  // Hits that do not count are rare, so a second query with a filter is cheaper than a filter on
  // every candidate of every ray (measured: 15 % of the ray rate). A step past such a hit would
  // also pass surfaces in the same plane, such as the table under a block of glass.
  Hit closest(const Ray& ray, int target) const {
    QueryContext context;
    init(context, &ray);
    context.caster = this;
    context.target = target;
    RTCRayHit query;
    set_ray(query.ray, ray, 0);
    constexpr int max_steps = 16;
    for (int step = 0; step < max_steps; ++step) {
      clear(query.hit);
      intersect(scene, context, query, skip_what_does_not_count);
      if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
      if (query.hit.geomID != round_id || target < 0 || group[primitive(query.hit)] != target) {
        Hit hit;
        set_hit(ray, query, hit);
        return hit;
      }
      // Round shapes have no filter. tnear is at least a normal number: Embree flushes denormals
      // and would meet the same point again.
      query.ray.tnear =
          std::max(std::numeric_limits<float>::min(),
                   std::nextafter(query.ray.tfar, std::numeric_limits<float>::infinity()));
      query.ray.tfar = static_cast<float>(ray.t_max);
      if (!(query.ray.tnear < query.ray.tfar)) return {};
    }
    return {};
  }

  // Rays of several packets that Embree reports as blocked. The blocker may be a ray's own plane or
  // target, so the closest hit decides. Queries for the few rays of a single packet cost as much as
  // all else.
  struct Suspects {
    RTCRay16 rays{};
    std::array<std::size_t, packet_size> number{};
    int count = 0;
  };

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    Suspects suspects;
    for (std::size_t begin = 0; begin < rays.size(); begin += packet_size) {
      cast_packet(rays, begin, blocked, suspects);
    }
    confirm(rays, suspects, blocked);
  }

  // Shadow rays run from one point to one emitter, so the rays of a packet visit the tree together
  // (measured: 3 to 4 times the rate of single rays).
  void cast_packet(std::span<const Ray> rays, std::size_t begin, std::span<std::uint8_t> blocked,
                   Suspects& suspects) const {
    const int lanes = static_cast<int>(std::min<std::size_t>(packet_size, rays.size() - begin));
    alignas(64) std::array<int, packet_size> valid{};
    alignas(64) std::array<float, packet_size> end;
    RTCRay16 shadow;
    for (int i = 0; i < packet_size; ++i) {
      // Lanes without a ray must hold numbers, too.
      const std::size_t number = begin + static_cast<std::size_t>(std::min(i, lanes - 1));
      valid[i] = i < lanes ? -1 : 0;
      RTCRay ray;
      set_ray(ray, rays[number], static_cast<unsigned>(number));
      set_lane(shadow, i, ray);
      end[i] = ray.tfar;
    }
    QueryContext context;
    init(context, rays.data());
    context.caster = this;
    occlude(scene, context, valid.data(), shadow, skip_what_does_not_block);
    for (int i = 0; i < lanes; ++i) {
      const std::size_t number = begin + static_cast<std::size_t>(i);
      blocked[number] = shadow.tfar[i] < 0.0f;
      if (!blocked[number] || round_set.shapes.empty()) continue;
      if (suspects.count == packet_size) confirm(rays, suspects, blocked);
      const int to = suspects.count++;
      suspects.number[static_cast<std::size_t>(to)] = number;
      copy_lane(shadow, i, suspects.rays, to);
      suspects.rays.tfar[to] = end[i];
    }
  }

  void confirm(std::span<const Ray> rays, Suspects& suspects,
               std::span<std::uint8_t> blocked) const {
    if (suspects.count == 0) return;
    alignas(64) std::array<int, packet_size> valid{};
    RTCRayHit16 query;
    query.ray = suspects.rays;
    for (int i = 0; i < packet_size; ++i) {
      valid[i] = i < suspects.count ? -1 : 0;
      query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    QueryContext context;
    init(context, rays.data());
    intersect(scene, context, valid.data(), query);
    for (int i = 0; i < suspects.count; ++i) {
      const std::size_t number = suspects.number[static_cast<std::size_t>(i)];
      const unsigned geometry = query.hit.geomID[i];
      if (geometry == RTC_INVALID_GEOMETRY_ID) {
        blocked[number] = 0;
        continue;
      }
      RTCHit hit;
      hit.geomID = geometry;
      hit.primID = query.hit.primID[i];
      hit.Ng_x = query.hit.Ng_x[i];
      hit.Ng_y = query.hit.Ng_y[i];
      hit.Ng_z = query.hit.Ng_z[i];
      const Ray& ray = rays[number];
      if (!counts(hit, query.ray.tfar[i], ray, ray.target_group)) {
        blocked[number] = closest(ray, ray.target_group).primitive >= 0;
      }
    }
    suspects.count = 0;
  }

  static void copy_lane(const RTCRay16& from, int i, RTCRay16& to, int j) {
    to.org_x[j] = from.org_x[i];
    to.org_y[j] = from.org_y[i];
    to.org_z[j] = from.org_z[i];
    to.dir_x[j] = from.dir_x[i];
    to.dir_y[j] = from.dir_y[i];
    to.dir_z[j] = from.dir_z[i];
    to.tnear[j] = from.tnear[i];
    to.time[j] = from.time[i];
    to.mask[j] = from.mask[i];
    to.id[j] = from.id[i];
    to.flags[j] = from.flags[i];
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
    packet.id[i] = ray.id;
    packet.flags[i] = ray.flags;
  }

  // Sets the hit in place: a copy would wait for the parts just stored one by one.
  void set_hit(const Ray& ray, const RTCRayHit& query, Hit& hit) const {
    const int p = primitive(query.hit);
    hit.primitive = p;
    hit.group = group[p];
    hit.u = query.hit.u;
    hit.v = query.hit.v;
    if (const CellSheet* met = sheet(query.hit)) {
      const CellSheets::CellPoint cell = sheets.cell_point(*met, hit.u, hit.v);
      hit.primitive = triangles + cell.quad;
      hit.u = cell.u;
      hit.v = cell.v;
    }
    if (query.hit.geomID == round_id) {
      const RoundShape& shape = round_set.shapes[query.hit.primID];
      hit.t = round_root(shape, ray, group[p] == ray.origin_group);
      const Eigen::Vector3d at = ray.origin + hit.t * ray.direction;
      hit.from_back = front_normal(shape, at).dot(ray.direction) > 0.0;
    } else {
      const Eigen::Vector3d normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
      hit.t = query.ray.tfar;
      hit.from_back = normal.dot(ray.direction) > 0.0;
    }
  }
};

RayCaster::RayCaster(const CastGeometry& geometry) : impl_(std::make_unique<Impl>(geometry)) {}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

void RayCaster::closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const {
  assert(rays.size() == hits.size());
  impl_->closest_hits(rays, hits);
}

void RayCaster::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
  assert(rays.size() == blocked.size());
  impl_->occluded(rays, blocked);
}

bool RayCaster::meets_first(int group, int other, const Eigen::Vector3d& direction) const {
  const CoplanarGroups& planes = *impl_->planes;
  return planes.order(group, other) * planes.normal(group).dot(direction) < 0.0;
}

bool RayCaster::is_hidden(int primitive, bool from_back) const {
  if (primitive >= static_cast<int>(impl_->hidden.size())) return false;
  return (impl_->hidden[primitive] & (from_back ? Impl::from_back : Impl::from_front)) != 0;
}

int RayCaster::triangle_count() const {
  return impl_->triangles;
}
int RayCaster::quad_count() const {
  return impl_->quads;
}
int RayCaster::round_count() const {
  return static_cast<int>(impl_->round_set.shapes.size());
}

}  // namespace lightwell
