#include "scene/rays/ray_caster.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell::ray_caster_test {
namespace {

using Eigen::Vector3d;

double uniform(std::uint64_t i, std::uint64_t purpose) {
  return random_uniform(random_key(i, purpose));
}

Vector3d random_point(std::uint64_t i, std::uint64_t purpose) {
  return {uniform(i, 10 * purpose), uniform(i, 10 * purpose + 1), uniform(i, 10 * purpose + 2)};
}

Vector3d random_direction(std::uint64_t i, std::uint64_t purpose) {
  const double z = 2.0 * uniform(i, 10 * purpose) - 1.0;
  const double phi = 2.0 * std::numbers::pi * uniform(i, 10 * purpose + 1);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

Hit closest(const RayCaster& caster, const Ray& ray) {
  Hit hit;
  caster.closest_hits({&ray, 1}, {&hit, 1});
  return hit;
}

bool is_blocked(const RayCaster& caster, const Ray& ray) {
  std::uint8_t blocked = 2;
  caster.occluded({&ray, 1}, {&blocked, 1});
  return blocked != 0;
}

// The unit cube's faces x0 x1 y0 y1 z0 z1 (groups 0 to 5), facing inwards, cut into n x n cells:
// triangles on every other face, quadrilaterals on the others.
CastGeometry box(int n) {
  CastGeometry g;
  std::vector<int> quad_groups;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const int first = static_cast<int>(g.vertices.size());
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        Vector3d p;
        p[axis] = face % 2;
        p[u] = static_cast<double>(i) / n;
        p[v] = static_cast<double>(j) / n;
        g.vertices.push_back(p);
      }
    }
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        std::array<int, 4> q = {first + j * (n + 1) + i, first + j * (n + 1) + i + 1,
                                first + (j + 1) * (n + 1) + i + 1, first + (j + 1) * (n + 1) + i};
        if (face % 2 == 1) std::swap(q[1], q[3]);
        if (axis == 0) {
          g.triangles.push_back({q[0], q[1], q[2]});
          g.triangles.push_back({q[0], q[2], q[3]});
          g.group.insert(g.group.end(), 2, face);
        } else {
          g.quads.push_back(q);
          quad_groups.push_back(face);
        }
      }
    }
  }
  g.group.insert(g.group.end(), quad_groups.begin(), quad_groups.end());
  return g;
}

// Number of `rays` rays from inside the box towards target(i) that hit nothing or a back side.
int count_escapes(const RayCaster& caster, int rays, const std::function<Vector3d(int)>& target) {
  std::atomic<int> escaped{0};
  parallel_for(rays, 10'000, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Vector3d origin = random_point(static_cast<std::uint64_t>(i), 1);
      const Hit hit = closest(caster, {.origin = origin, .direction = target(i) - origin});
      if (hit.primitive < 0 || hit.from_back) ++escaped;
    }
  });
  return escaped;
}

constexpr int cells = 7;

// A grid point of the walls x = 0 and x = 1, moved along y by `share` of a cell.
Vector3d wall_point(int i, double share) {
  const Vector3d cell = (random_point(static_cast<std::uint64_t>(i), 3) * cells).array().floor();
  return {i % 2 == 0 ? 0.0 : 1.0, (cell.y() + share) / cells, cell.z() / cells};
}

TEST(RayCaster, NoRayLeavesAClosedRoom) {
  const RayCaster caster(box(cells));
  const auto anywhere = [](int i) {
    return Vector3d(2.0 * random_direction(static_cast<std::uint64_t>(i), 2));
  };
  EXPECT_EQ(count_escapes(caster, 1'000'000, anywhere), 0);
}

TEST(RayCaster, NoRayPassesBetweenTwoTrianglesThatShareAnEdge) {
  const RayCaster caster(box(cells));
  const auto edge = [](int i) {
    return wall_point(i, random_uniform(random_key(static_cast<std::uint64_t>(i), 99)));
  };
  EXPECT_EQ(count_escapes(caster, 1'000'000, edge), 0);
}

TEST(RayCaster, AVertexIsHitLikelyThoughNotSurely) {
  // Within rounding of a vertex the signs of the edge tests around it are random, and the ray
  // passes if all agree. Embree 3.13 lets 1 in 1e4 such rays through; the bound is ten times as
  // many. Only rays aimed at a vertex come so near.
  const RayCaster caster(box(cells));
  constexpr int rays = 200'000;
  EXPECT_LT(count_escapes(caster, rays, [](int i) { return wall_point(i, 0.0); }), rays / 1000);
}

TEST(RayCaster, HitsLieOnTheWallsAndCoordinatesReproduceThem) {
  const CastGeometry g = box(3);
  const RayCaster caster(g);
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const Ray ray{.origin = random_point(i, 4), .direction = 2.0 * random_direction(i, 5)};
    const Hit hit = closest(caster, ray);
    ASSERT_GE(hit.primitive, 0);
    const Vector3d p = ray.origin + hit.t * ray.direction;
    // Float coordinates in a room of size 1 have errors of 1e-7, of which a few add up.
    const double wall = std::min(p.cwiseAbs().minCoeff(), (p.array() - 1.0).abs().minCoeff());
    EXPECT_LT(wall, 1e-6);
    Vector3d q;
    const auto triangles = static_cast<int>(g.triangles.size());
    const double u = hit.u, v = hit.v;
    if (hit.primitive < triangles) {
      const auto& t = g.triangles[static_cast<std::size_t>(hit.primitive)];
      q = (1 - u - v) * g.vertices[t[0]] + u * g.vertices[t[1]] + v * g.vertices[t[2]];
    } else {
      const auto& c = g.quads[static_cast<std::size_t>(hit.primitive - triangles)];
      q = (1 - u) * (1 - v) * g.vertices[c[0]] + u * (1 - v) * g.vertices[c[1]] +
          u * v * g.vertices[c[2]] + (1 - u) * v * g.vertices[c[3]];
    }
    EXPECT_LT((p - q).norm(), 2e-6) << "primitive " << hit.primitive;
  }
}

TEST(RayCaster, FrontIsTheCounterClockwiseSide) {
  const CastGeometry g{
      .vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}, .group = {0}};
  const RayCaster caster(g);
  EXPECT_FALSE(closest(caster, {.origin = {0.2, 0.2, 1}, .direction = {0, 0, -1}}).from_back);
  EXPECT_TRUE(closest(caster, {.origin = {0.2, 0.2, -1}, .direction = {0, 0, 1}}).from_back);
}

// Packets of 16 rays, of which every other one begins beyond what single precision can tell.
TEST(RayCaster, RaysFromBeyondSinglePrecisionMeetNothing) {
  const RayCaster caster(box(5));
  for (const double far : {1e19, 1e39, 1e300}) {
    std::vector<Ray> rays;
    for (int i = 0; i < 40; ++i) {
      const Vector3d origin(i % 2 == 0 ? far : 0.5, 0.5, 0.5);
      rays.push_back({.origin = origin, .direction = -Vector3d::UnitX()});
    }
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size(), 2);
    caster.closest_hits(rays, hits);
    caster.occluded(rays, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(hits[i].primitive < 0, i % 2 == 0) << far;
      EXPECT_EQ(blocked[i], i % 2) << far;
      EXPECT_EQ(closest(caster, rays[i]).primitive < 0, i % 2 == 0) << far;
      EXPECT_EQ(is_blocked(caster, rays[i]), i % 2 != 0) << far;
    }
  }
}

TEST(RayCaster, TheOriginsOwnPlaneIsNeverMet) {
  const RayCaster caster(box(5));
  // The origin is behind its plane by up to more than float rounding.
  for (const double behind : {0.0, 1e-9, 1e-7, 1e-6}) {
    for (std::uint64_t i = 0; i < 5'000; ++i) {
      Vector3d origin = random_point(i, 6),
               direction = cosine_direction(static_cast<float>(uniform(i, 71)),
                                            static_cast<float>(uniform(i, 72)));
      origin.z() = -behind;
      const Hit hit =
          closest(caster, {.origin = origin, .direction = direction, .origin_group = 4});
      if (direction.z() < 1e-3) continue;  // may leave below the side walls' lower edge
      ASSERT_GE(hit.primitive, 0) << behind << ", ray " << i;
      EXPECT_GT(hit.t, 1e-6);
      EXPECT_GT((origin + hit.t * direction).z(), 0.0);
    }
  }
  const Ray without{.origin = {0.5, 0.51, -1e-6}, .direction = {0, 0, 1}};
  EXPECT_LT(closest(caster, without).t, 1e-5) << "the plane is there for rays of no group";
}

TEST(RayCaster, AFanOfManyOwnTrianglesIsPassedToo) {
  // 400 triangles of one group meet in the origin, below a wall.
  CastGeometry g{.vertices = {{0, 0, 0}}};
  constexpr int n = 400;
  for (int i = 0; i < n; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / n;
    g.vertices.emplace_back(std::cos(phi), std::sin(phi), 0.0);
    g.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
    g.group.push_back(0);
  }
  const int wall = static_cast<int>(g.vertices.size());
  for (const Vector3d& p : {Vector3d(-9, -9, 1), Vector3d(9, -9, 1), Vector3d(0, 9, 1)})
    g.vertices.push_back(p);
  g.triangles.push_back({wall, wall + 1, wall + 2});
  g.group.push_back(1);
  const RayCaster caster(g);
  for (const double z : {0.0, -1e-9, -1e-7, -1e-6}) {
    for (std::uint64_t i = 0; i < 1000; ++i) {
      Vector3d direction = random_direction(i, 8);
      direction.z() = std::abs(direction.z()) + 0.3;
      const Hit hit =
          closest(caster, {.origin = {0, 0, z}, .direction = direction, .origin_group = 0});
      ASSERT_EQ(hit.primitive, n) << z << ", ray " << i;
    }
  }
}

CastGeometry one_sphere(const Vector3d& center, double radius) {
  return {.round_shapes = {Sphere{.center = center, .radius = radius}}, .group = {0}};
}

TEST(RayCasterSphere, DistanceIsExact) {
  const Vector3d center(0.3, -0.2, 5.0);
  for (const double radius : {1e-3, 0.1, 2.0}) {
    const RayCaster caster(one_sphere(center, radius));
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const Vector3d origin = center + 7.0 * random_direction(i, 9);
      // A point of the sphere that faces the origin, so that the first root is the one aimed at.
      Vector3d n = random_direction(i, 11);
      if (n.dot(origin - center) < 0.0) n = -n;
      const Vector3d target = center + 0.99 * radius * n;
      const Vector3d d = target - origin;
      const Vector3d oc = origin - center;
      // Reference in long double: |oc + t d|^2 = r^2.
      const long double a = d.squaredNorm(), b = oc.dot(d), c = oc.squaredNorm() - radius * radius;
      const long double expected = (-b - std::sqrt(b * b - a * c)) / a;
      const Hit hit = closest(caster, {.origin = origin, .direction = d});
      ASSERT_EQ(hit.primitive, 0);
      EXPECT_FALSE(hit.from_back);
      EXPECT_NEAR(hit.t, static_cast<double>(expected), 1e-9);  // t is about 1
    }
  }
}

TEST(RayCasterSphere, RaysFromItsSurfaceMeetTheFarSideOrNothing) {
  const Vector3d center(100.0, -20.0, 3.0);
  constexpr double radius = 0.7;
  const RayCaster caster(one_sphere(center, radius));
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Vector3d n = random_direction(i, 12), d = random_direction(i, 13);
    const Ray ray{.origin = center + radius * n, .direction = d, .origin_group = 0};
    const Hit hit = closest(caster, ray);
    const double cosine = n.dot(d);
    if (cosine > 1e-6) {
      EXPECT_EQ(hit.primitive, -1) << "outwards";
    }
    if (cosine < -1e-6) {
      ASSERT_EQ(hit.primitive, 0) << "inwards, ray " << i;
      // The chord is -2 r cos; the rounding of an origin at 100 m is 1e-14 of the chord.
      EXPECT_NEAR(hit.t, -2.0 * radius * cosine, 1e-9 * radius);
      EXPECT_TRUE(hit.from_back);
    }
    EXPECT_EQ(is_blocked(caster, ray), hit.primitive >= 0);
  }
}

// A room with a ball and a table.
CastGeometry furnished(double scale, const Vector3d& shift) {
  CastGeometry g = box(4);
  const int first = static_cast<int>(g.vertices.size());
  for (const Vector3d& p : {Vector3d(0.2, 0.2, 0.4), Vector3d(0.7, 0.2, 0.4),
                            Vector3d(0.7, 0.6, 0.4), Vector3d(0.2, 0.6, 0.4)}) {
    g.vertices.push_back(p);
  }
  g.quads.push_back({first, first + 1, first + 2, first + 3});
  g.group.push_back(6);
  g.round_shapes.push_back(Sphere{.center = {0.6, 0.7, 0.75}, .radius = 0.15});
  g.group.push_back(7);
  for (auto& v : g.vertices) v = scale * v + shift;
  for (RoundShape& shape : g.round_shapes) {
    const auto s = std::get<Sphere>(shape);
    shape = Sphere{.center = scale * s.center + shift, .radius = scale * s.radius};
  }
  return g;
}

struct Frame {
  double scale;
  Vector3d shift;
};

class RayCasterIn : public testing::TestWithParam<Frame> {};

TEST_P(RayCasterIn, AnotherFrameSeesTheSame) {
  const auto [scale, shift] = GetParam();
  const RayCaster here(furnished(1.0, Vector3d::Zero())), there(furnished(scale, shift));
  int grazing = 0;
  for (std::uint64_t i = 0; i < 50'000; ++i) {
    const Vector3d origin = random_point(i, 14), direction = random_direction(i, 15);
    const Hit a = closest(here, {.origin = origin, .direction = direction});
    const Hit b =
        closest(there, {.origin = scale * origin + shift, .direction = scale * direction});
    ASSERT_GE(a.primitive, 0);
    ASSERT_GE(b.primitive, 0);
    // Float rounding of 1e-7 decides at a silhouette; one ray in 1e6 comes that close.
    if (std::abs(a.t - b.t) > 1e-5) ++grazing;
  }
  EXPECT_LE(grazing, 1);
}
INSTANTIATE_TEST_SUITE_P(Frames, RayCasterIn,
                         testing::Values(Frame{1e-3, Vector3d::Zero()},
                                         Frame{1e3, Vector3d::Zero()},
                                         Frame{1.0, Vector3d(1e4, -1e4, 1e4)},
                                         Frame{1e-3, Vector3d(10, 10, 10)}));

TEST(RayCaster, OccludedAgreesWithClosestHits) {
  const RayCaster caster(furnished(1.0, Vector3d::Zero()));
  constexpr std::size_t n = 100'000;
  std::vector<Ray> rays(n);
  for (std::size_t i = 0; i < n; ++i) {
    rays[i] = {.origin = random_point(i, 16),
               .direction = random_point(i, 17) - rays[i].origin,
               .t_max = 1.0,
               .origin_group = static_cast<int>(i % 9) - 1};
    rays[i].direction = random_point(i, 17) - rays[i].origin;
  }
  std::vector<std::uint8_t> blocked(n, 2);
  std::vector<Hit> hits(n);
  caster.occluded(rays, blocked);
  caster.closest_hits(rays, hits);
  std::size_t blocked_count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_EQ(blocked[i] == 1, hits[i].primitive >= 0) << i;
    ASSERT_TRUE(hits[i].primitive < 0 || hits[i].t < 1.0 + 1e-6);
    blocked_count += blocked[i];
  }
  // Both results must occur, otherwise the agreement is trivial.
  EXPECT_GT(blocked_count, n / 20);
  EXPECT_LT(blocked_count, n / 2);
}

TEST(RayCaster, TheTargetDoesNotHideItself) {
  const RayCaster caster(furnished(1.0, Vector3d::Zero()));
  const Vector3d floor(0.5, 0.4, 0.0), ceiling(0.5, 0.4, 1.0), ball(0.6, 0.7, 0.75);
  Ray ray{.origin = floor,
          .direction = ceiling - floor,
          .t_max = 1.0,
          .origin_group = 4,
          .target_group = 5};
  EXPECT_TRUE(is_blocked(caster, ray)) << "the table is between";
  ray.origin = {0.9, 0.1, 0.0};
  EXPECT_FALSE(is_blocked(caster, ray)) << "past the table the ceiling alone is met";
  ray.target_group = -1;
  ray.t_max = 1.001;
  EXPECT_TRUE(is_blocked(caster, ray)) << "which counts where it is no target";
  ray = {.origin = {0.9, 0.9, 0.0},
         .direction = ball - Vector3d(0.9, 0.9, 0.0),
         .t_max = 1.0,
         .origin_group = 4,
         .target_group = 7};
  EXPECT_FALSE(is_blocked(caster, ray))
      << "the ball, entered on the way to its centre, is the target";
  ray.target_group = 5;
  EXPECT_TRUE(is_blocked(caster, ray));
}

TEST(RayCaster, TMaxEndsTheRay) {
  const RayCaster caster(box(1));
  const Ray up{.origin = {0.5, 0.4, 0.5}, .direction = {0, 0, 0.25}};
  EXPECT_NEAR(closest(caster, up).t, 2.0, 1e-6) << "distances are in multiples of the direction";
  Ray shorter = up;
  shorter.t_max = 1.99;
  EXPECT_EQ(closest(caster, shorter).primitive, -1);
  EXPECT_FALSE(is_blocked(caster, shorter));
}

TEST(RayCaster, NothingIsSeenInEmptySpace) {
  const RayCaster caster(CastGeometry{});
  const Ray ray;
  EXPECT_EQ(closest(caster, ray).primitive, -1);
  EXPECT_FALSE(is_blocked(caster, ray));
  EXPECT_EQ(caster.triangle_count() + caster.quad_count() + caster.round_count(), 0);
}

TEST(RayCaster, CountsItsPrimitivesAndRefusesMissingGroups) {
  CastGeometry g = furnished(1.0, Vector3d::Zero());
  const RayCaster caster(g);
  EXPECT_EQ(caster.triangle_count(), 64);
  EXPECT_EQ(caster.quad_count(), 65);
  EXPECT_EQ(caster.round_count(), 1);
  g.group.pop_back();
  EXPECT_THROW(RayCaster{g}, std::invalid_argument);
}

// Rays in a cube of 1 m with sheets closely over its floor meet the same between a ground and a
// cover of 6 km, the middle of whose box lies 1.5 km above the cube.
TEST(RayCaster, ABackdropFarAwayLeavesARoomAsItIs) {
  CastGeometry near = box(2);
  for (const double height : {1e-5, 1e-4, 1e-3}) {
    const int first = static_cast<int>(near.vertices.size()), group = near.group.back() + 1;
    for (const auto& [x, y] :
         {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
      near.vertices.emplace_back(0.2 + 0.6 * x, 0.2 + 0.6 * y, height);
    }
    near.quads.push_back({first, first + 1, first + 2, first + 3});
    near.group.push_back(group);
  }
  CastGeometry wide = near;
  constexpr double r = 3000.0;
  for (const double height : {0.0, r}) {
    const int first = static_cast<int>(wide.vertices.size()), group = wide.group.back() + 1;
    wide.vertices.insert(wide.vertices.end(),
                         {{-r, -r, height}, {r, -r, height}, {r, r, height}, {-r, r, height}});
    wide.quads.push_back({first, first + 1, first + 2, first + 3});
    wide.group.push_back(group);
  }
  const RayCaster small(near), large(wide);
  for (int i = 0; i < 10000; ++i) {
    Vector3d from = random_point(static_cast<std::uint64_t>(i), 1);
    from.z() = 0.0;
    Vector3d to = random_point(static_cast<std::uint64_t>(i), 2);
    Ray ray{.origin = from, .direction = to - from, .t_max = 1.0, .origin_group = 4};
    EXPECT_EQ(is_blocked(large, ray), is_blocked(small, ray)) << from << to;
    ray.t_max = 10.0;
    EXPECT_EQ(closest(large, ray).group, closest(small, ray).group) << from << to;
  }
}

}  // namespace
}  // namespace lightwell::ray_caster_test
