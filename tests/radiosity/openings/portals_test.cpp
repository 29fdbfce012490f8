// Light through a slit is that of the closed form, without a lottery.
#include "radiosity/openings/portals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/patches/patch_outline.h"
#include "radiosity/closed_forms/polygon_exchange.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solve.h"
#include "scene/io/read_scene.h"
#include "tests/radiosity/openings/test_rooms.h"

namespace lightwell::portals_test {
namespace {

using Eigen::Quaterniond, Eigen::Vector3d;

const Quaterniond askew(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));

constexpr int dim_floor = 4, dim_ceiling = 5;  // facets of RoomsWithSlit
constexpr int door_floor = 0;                  // facet of RoomsBesideDoor

struct Lit {
  explicit Lit(double width, const Quaterniond& turn = Quaterniond::Identity(), float rho = 0.5f)
      : rooms(width, turn, rho),
        mesh(build_patches(rooms.scene, {.max_patch_size = 1.0})),
        caster(mesh),
        light(rooms.scene, mesh),
        radiosity(rooms.bright_room(mesh)) {}

  std::shared_ptr<const Portals> portals() const {
    return find_portals(rooms.scene, caster, brightness_of_vertices(mesh, radiosity));
  }

  test::RoomsWithSlit rooms;
  PatchMesh mesh;
  ElementCaster caster;
  DirectLight light;
  BandArray radiosity;
};

struct Statistics {
  double mean = 0.0, deviation = 0.0;
};

Statistics gathered(const Lit& lit, const std::shared_ptr<const Portals>& portals,
                    const GatherPoint& point, int rays, int replicas) {
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < replicas; ++i) {
    const double E =
        gather_indirect(
            {lit.rooms.scene, lit.caster, lit.light}, lit.radiosity, std::array{point},
            {.rays = rays, .replica = static_cast<std::uint64_t>(i), .portals = portals})
            .indirect(0, 0);
    sum += E / replicas;
    squares += E * E / replicas;
  }
  return {sum, std::sqrt(std::max(0.0, squares - sum * sum))};
}

// The irradiance that comes through a slit is about B A / A_seen: slits count where that is more
// than a thousandth of what errors are relative to, and not where nothing is judged.
TEST(Portals, CountWhereTheirLightMatters) {
  for (const Quaterniond& turn : {Quaterniond::Identity(), askew}) {
    const Lit lit(0.01, turn);
    const std::vector<float> brightness = brightness_of_vertices(lit.mesh, lit.radiosity);
    const std::vector<Opening> openings =
        narrow_openings(lit.caster, find_openings(lit.rooms.scene), narrow_for_rows);
    ASSERT_FALSE(openings.empty());
    const auto count = [&](float reference) {
      const std::vector<float> of_elements(brightness.size(), reference);
      return notable_openings(lit.caster, brightness, of_elements, openings).size();
    };
    double area = 0.0;
    for (const Opening& opening : openings) area += opening.area();
    const double seen = 88.6, B = *std::ranges::max_element(brightness);
    const double each = B * area / static_cast<double>(openings.size()) / seen;
    EXPECT_EQ(count(0.0f), openings.size());
    EXPECT_EQ(count(std::numeric_limits<float>::infinity()), 0u);
    // The box of what 16 paths see has a tenth of the surface of the room to all of it, and pieces
    // of the slit differ in length by less than ten times.
    EXPECT_EQ(count(static_cast<float>(1e3 * each / 100.0)), openings.size());
    EXPECT_EQ(count(static_cast<float>(1e3 * each * 100.0)), 0u);
  }
}

// A tenth of a metre of wall, 1 mm in front of it, around a crack of 1 mm or none at all. The walls
// send nearly all paths back. Those that get through end five widths of the opening, 0.5 m, from
// where they begin or farther, and 0.42 m from the opening's middle. Their light, B A of 0.01 W,
// spreads over 2 pi (0.42 m)^2 = 1.1 m2 or more, to less than 9.1e-3 W/m2: less than a thousandth
// of 10 W/m2, even if one path alone tells where it goes.
TEST(Portals, CountNotWhereHardlyAnyLightGetsThrough) {
  for (const double crack : {0.0, 1e-3}) {
    const Lit lit(1e-3);
    const std::vector<float> brightness = brightness_of_vertices(lit.mesh, lit.radiosity);
    std::vector<Opening> openings;
    for (int i = 0; i < 32; ++i) {
      openings.push_back({.center = {3.999, crack > 0.0 ? 2.8995 : 1.0, 0.3 + 0.04 * i},
                          .along = 0.05 * Vector3d::UnitZ(),
                          .across = 0.05 * Vector3d::UnitY(),
                          .normal = -Vector3d::UnitX()});
    }
    const auto count = [&](float reference) {
      const std::vector<float> of_elements(brightness.size(), reference);
      return notable_openings(lit.caster, brightness, of_elements, openings).size();
    };
    EXPECT_EQ(count(10.0f), 0u);
    // Nothing gets through a wall, however small the light is that matters.
    const std::size_t in_darkness = count(0.0f);
    EXPECT_TRUE(crack > 0.0 ? in_darkness > 0 : in_darkness == 0) << in_darkness;
  }
}

// In a black room behind a slit, E = B F with the form factor F from the point to the slit.
TEST(Portals, GiveWhatTheFormFactorOfTheSlitSays) {
  for (const double width : {1e-3, 0.01, 0.1, 0.3}) {
    for (const Quaterniond& turn : {Quaterniond::Identity(), askew}) {
      const Lit lit(width, turn, 0.0f);
      const auto portals = lit.portals();
      ASSERT_NE(portals, nullptr);
      for (const Vector3d& place :
           {Vector3d(4.6, 2.5, 0), Vector3d(6, 4, 0), Vector3d(7.5, 0.5, 0)}) {
        const GatherPoint point{
            .position = turn * place, .normal = turn * Vector3d::UnitZ(), .facet = dim_floor};
        const double F = point_to_polygon(point.position, point.normal, lit.rooms.slit());
        constexpr int replicas = 64;
        const Statistics E = gathered(lit, portals, point, 256, replicas);
        // Four standard errors of the mean, and the rounding of float sums.
        EXPECT_NEAR(E.mean, F, 4.0 * E.deviation / std::sqrt(replicas) + 1e-5 * F) << width;
        // 64 aimed rays leave the variation of the form factor's kernel over the slit, a fraction
        // of the light, and that of rays that pass beside it: a tenth. Without aimed rays, one of
        // 256 / F rays passes.
        EXPECT_LT(E.deviation, 0.1 * F) << width << ", " << place.transpose();
      }
    }
  }
}

TEST(Portals, AreNoneWhereBothRoomsAreLitAlike) {
  Lit lit(0.01);
  for (int v = 0; v < lit.mesh.vertex_count(); ++v) {
    lit.radiosity.row(v) = lit.radiosity(v, 0) > 0.0f ? 12.0f : 1.0f;
  }
  EXPECT_EQ(lit.portals(), nullptr);
}

// Such as that between the lamp and the ceiling, whose crevice is dark.
TEST(Portals, AreNoneInTheCornellBox) {
  const Scene scene = read_scene(LIGHTWELL_CORNELL "/cornell.toml");
  const SolvedScene solved =
      solve_scene(scene, {.gather = {.rays = 16}, .refine = {.tolerance = 0.0}, .error_points = 0});
  const ElementCaster caster(solved.mesh);
  const DirectLight light(scene, solved.mesh);
  EXPECT_EQ(
      find_portals(scene, caster,
                   brightness_of_patches(solved.mesh, light, solved.solution.patch_radiosity)),
      nullptr);
  EXPECT_TRUE(narrow_openings(caster, find_openings(scene), narrow_for_rows).empty());
}

// Points in the bright room do not aim at the slit.
TEST(Portals, AreSeenFromTheirDimSide) {
  const Lit lit(0.01);
  const auto portals = lit.portals();
  ASSERT_NE(portals, nullptr);
  EXPECT_TRUE(portals->view({2, 2, 0}, {0, 0, 1}, 64).is_empty());
  EXPECT_FALSE(portals->view({6, 2, 0}, {0, 0, 1}, 64).is_empty());
  EXPECT_FALSE(portals->view_both_ways({2, 2, 0}, {0, 0, 1}, 64).is_empty());
  EXPECT_TRUE(portals->part({2, 2, 1}, {6, 2, 1}));
  EXPECT_FALSE(portals->part({2, 2, 1}, {3, 1, 1}));
}

// Portals out of reach have no part in a view of near ones; with all within reach it is view() of a
// single ray.
TEST(Portals, AreNearWithinReach) {
  const Lit lit(0.05);
  const auto portals = lit.portals();
  ASSERT_NE(portals, nullptr);
  const Vector3d from(5.5, 1.2, 0.7), normal = Vector3d(-1, 1, 0).normalized();
  // The slit is 1.5 m away along x.
  EXPECT_TRUE(portals->view_near(from, normal, 1.4).is_empty());
  const Portals::View all = portals->view(from, normal, 1),
                      near = portals->view_near(from, normal, 10.0);
  ASSERT_FALSE(near.is_empty());
  const SobolPoints aims(64);
  for (int i = 0; i < aims.count(); ++i) {
    const Eigen::Array4d u = aims.point(i, 7).cast<double>();
    const Vector3d direction = portals->draw(near, from, u[0], u[1], u[2]).direction;
    EXPECT_EQ(portals->draw(all, from, u[0], u[1], u[2]).direction, direction);
    EXPECT_EQ(portals->density(near, from, direction, 100.0),
              portals->density(all, from, direction, 100.0));
  }
}

// Elements show how light varies near an opening that is not much narrower than the room is long.
TEST(Portals, AreNotNearWhereTheyAreWide) {
  const Vector3d before(4.2, 2.75, 1.0);
  for (const auto& [width, is_near] : {std::pair(0.05, true), {0.35, false}}) {
    const auto portals = Lit(width).portals();
    ASSERT_NE(portals, nullptr);
    EXPECT_EQ(portals->is_near(before, 0.5), is_near) << width;
  }
}

// The mean of f / q over drawn directions is the integral of f over the slit's solid angle: f = cos
// / pi gives the form factor. Here all portals are passed.
TEST(Portals, HaveDirectionsOfTheStatedDensity) {
  const Lit lit(0.05);
  const auto portals = lit.portals();
  ASSERT_NE(portals, nullptr);
  const Vector3d from(5.5, 1.2, 0.7), normal = Vector3d(-1, 1, 0).normalized();
  const Portals::View view = portals->view(from, normal, 64);
  ASSERT_FALSE(view.is_empty());
  const SobolPoints aims(4096);
  double sum = 0.0;
  const Loop slit = lit.rooms.slit();
  for (int i = 0; i < aims.count(); ++i) {
    const Eigen::Array4d u = aims.point(i, 7).cast<double>();
    const Vector3d direction = portals->draw(view, from, u[0], u[1], u[2]).direction;
    const double q = portals->density(view, from, direction, 100.0);
    ASSERT_GT(q, 0.0);
    const Vector3d at = from + (4.0 - from.x()) / direction.x() * direction;
    const bool in_slit = at.y() > 2.85 && at.y() < 2.9 && at.z() > 0.0 && at.z() < 2.0;
    if (in_slit) sum += direction.dot(normal) / (M_PI * q);
  }
  const double F = point_to_polygon(from, normal, slit);
  // A tenth of the directions pass beside the slit, which makes a variation of 0.3 at random; 4
  // standard errors.
  EXPECT_NEAR(sum / aims.count(), F, 4.0 * 0.3 / std::sqrt(4096.0) * F);
}

// Portals along a ray are sought in a tree where there are many. The slit is cut into 100 pieces
// that fill it, so each direction passes one, and the mean of cos / (pi q) is the form factor of
// the slit.
TEST(Portals, HaveTheStatedDensityWhereTheyAreMany) {
  const Lit lit(0.05);
  constexpr int pieces = 100;
  std::vector<Opening> openings;
  for (int i = 0; i < pieces; ++i) {
    openings.push_back({.center = {4.0, 2.875, 2.0 * (i + 0.5) / pieces},
                        .along = 1.0 / pieces * Vector3d::UnitZ(),
                        .across = 0.025 * Vector3d::UnitY(),
                        .normal = -Vector3d::UnitX()});
  }
  const Portals portals(lit.caster, brightness_of_vertices(lit.mesh, lit.radiosity), openings);
  ASSERT_EQ(portals.size(), pieces);
  const Vector3d from(5.5, 1.2, 0.7), normal = Vector3d(-1, 1, 0).normalized();
  const Portals::View view = portals.view(from, normal, 64);
  const SobolPoints aims(4096);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < aims.count(); ++i) {
    const Eigen::Array4d u = aims.point(i, 7).cast<double>();
    const Vector3d direction = portals.draw(view, from, u[0], u[1], u[2]).direction;
    const double q = portals.density(view, from, direction, 100.0);
    ASSERT_GT(q, 0.0);
    const double F = direction.dot(normal) / (M_PI * q);
    sum += F;
    squares += F * F;
    // A ray that ends before the slit passes none.
    EXPECT_EQ(portals.density(view, from, direction, 1.4), 0.0);
  }
  const double mean = sum / aims.count(),
               deviation = std::sqrt(squares / aims.count() - mean * mean);
  // Four standard errors of independent draws.
  EXPECT_NEAR(mean, point_to_polygon(from, normal, lit.rooms.slit()),
              4.0 * deviation / std::sqrt(4096.0));
}

// The gap below a door has two openings, one behind the other. A ray aimed at the one behind that
// ends in the gap counts for nothing, although it passes the one before.
TEST(Portals, CountRaysThatPassTheirOwn) {
  const test::RoomsBesideDoor rooms(2e-3);
  const PatchMesh mesh = build_patches(rooms.scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  std::vector<float> brightness;  // of the lit room and of the gap
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double x = element_center(mesh, e).position.x();
    brightness.push_back(x < test::RoomsBesideDoor::depth - 1e-6 ? 1.0f : 0.0f);
  }
  const auto portals = find_portals(rooms.scene, caster, brightness);
  ASSERT_NE(portals, nullptr);
  const Vector3d from(test::RoomsBesideDoor::depth + 0.02, 1.5, 0.0), normal = Vector3d::UnitZ();
  const Portals::View view = portals->view(from, normal, 64);
  ASSERT_FALSE(view.is_empty());
  const SobolPoints aims(4096);
  double sum = 0.0, squares = 0.0;
  int stopped = 0;
  for (int i = 0; i < aims.count(); ++i) {
    const Eigen::Array4d u = aims.point(i, 7).cast<double>();
    const Portals::Aim aim = portals->draw(view, from, u[0], u[1], u[2]);
    if (!(aim.direction.z() > 0.0)) continue;
    ElementHit hit;
    const Ray ray{.origin = from, .direction = aim.direction, .origin_group = door_floor};
    caster.closest_hits({&ray, 1}, {&hit, 1});
    const double q = portals->density(view, from, aim.direction, hit.t);
    if (!portals->passes(aim, from, hit.t)) {
      stopped += q > 0.0 ? 1 : 0;
      continue;
    }
    const double f = aim.direction.z() / (M_PI * q);
    sum += f;
    squares += f * f;
  }
  EXPECT_GT(stopped, 30);  // else the test tells nothing
  const double n = aims.count(), mean = sum / n;
  const double F = point_to_polygon(from, normal, rooms.mouth());
  // Four standard errors of independent directions.
  EXPECT_NEAR(mean, F, 4.0 * std::sqrt((squares / n - mean * mean) / n));
  EXPECT_GT(F, 1e-4);
}

// Light on the floor behind a door below which 1 mm is open, in units of the radiosity of the
// bright room, at `at` metres from the bright side. In two dimensions the floor (f) and the door's
// lower edge (u), which are h apart, exchange
//
//     E_f(x) = s(x) + rho int_0^d K(x, t) E_u(t) dt     s = (1 - x / sqrt(x^2 + h^2)) / 2
//     E_u(x) = s(x) + rho int_0^oo K(x, t) E_f(t) dt    K = h^2 / (2 ((x - t)^2 + h^2)^(3/2))
//
// where the lower edge sees the bright floor, and the floor the bright room through the gap. The
// unknowns stand in the middles of cells; K is integrated over each cell in closed form.
double behind_a_door(double at, double h, double rho) {
  constexpr int n = 400, beyond = 400;
  constexpr double d = test::RoomsBesideDoor::depth;
  std::vector<double> edge;
  for (int i = 0; i <= n; ++i) edge.push_back(d * i / n);
  for (int i = 0; i <= beyond; ++i) {
    edge.push_back(d + 0.01 * h * std::pow(100.0 / h, static_cast<double>(i) / beyond));
  }
  const auto source = [&](double x) { return 0.5 * (1.0 - x / std::hypot(x, h)); };
  const auto reached = [&](double x, std::size_t cell) {
    const double low = edge[cell] - x, high = edge[cell + 1] - x;
    return 0.5 * (high / std::hypot(high, h) - low / std::hypot(low, h));
  };
  const auto arriving = [&](double x, const std::vector<double>& E, std::size_t cells) {
    double sum = source(x);
    for (std::size_t j = 0; j < cells; ++j) sum += rho * reached(x, j) * E[j];
    return sum;
  };
  const std::size_t all = edge.size() - 1;
  std::vector<double> floor(all, 0.0), lower(n, 0.0);
  for (int sweep = 0; sweep < 20; ++sweep) {  // each leaves at most rho^2 of the error
    for (std::size_t i = 0; i < lower.size(); ++i) {
      lower[i] = arriving(0.5 * (edge[i] + edge[i + 1]), floor, all);
    }
    for (std::size_t i = 0; i < all; ++i) {
      floor[i] = arriving(0.5 * (edge[i] + edge[i + 1]), lower, n);
    }
  }
  return arriving(at, lower, n);
}

TEST(Portals, LightTheFloorBehindADoorAsTheIntegralEquationSays) {
  constexpr double h = 1e-3, depth = test::RoomsBesideDoor::depth;
  const test::RoomsBesideDoor rooms(h);
  const PatchMesh mesh = build_patches(rooms.scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const DirectLight light(rooms.scene, mesh);
  const BandArray B = test::RoomsBesideDoor::bright_room(mesh);
  const auto portals = find_portals(rooms.scene, caster, brightness_of_vertices(mesh, B));
  ASSERT_NE(portals, nullptr);
  for (const double beyond : {5e-4, 2e-3, 0.02}) {
    const GatherPoint point{.position = {depth + beyond, 1.45, 0.0}, .facet = door_floor};
    constexpr int replicas = 16;
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < replicas; ++i) {
      const double E =
          gather_indirect(
              {rooms.scene, caster, light}, B, std::array{point},
              {.rays = 1024, .replica = static_cast<std::uint64_t>(i), .portals = portals})
              .indirect(0, 0);
      sum += E / replicas;
      squares += E * E / replicas;
    }
    const double deviation = std::sqrt(std::max(0.0, squares - sum * sum));
    const double truth = behind_a_door(depth + beyond, h, 0.5);
    // Four standard errors; the gap ends 0.45 m aside, and leaves out 1 - cos(atan(0.06 / 0.45)) of
    // the plane problem's light at most, 0.01.
    EXPECT_NEAR(sum, truth, 4.0 * deviation / std::sqrt(replicas) + 0.01 * truth) << beyond;
    EXPECT_LT(deviation, 0.25 * truth) << beyond;
  }
}

// Exchange of the dim room's patches with the bright room is that with the slit.
TEST(Portals, MakeRowsOfFormFactorsRight) {
  const Lit lit(3e-3);
  const auto portals = lit.portals();
  ASSERT_NE(portals, nullptr);
  const auto exchange = [&](const std::shared_ptr<const Portals>& aimed_at) {
    double squares = 0.0, all = 0.0;
    const auto form_factors = compute_form_factors({lit.rooms.scene, lit.caster, lit.light},
                                                   {.rays_per_patch = 512, .portals = aimed_at});
    const PatchOutline slit = polygon_outline({lit.rooms.slit()});
    for (int i = 0; i < lit.mesh.patch_count(); ++i) {
      const PatchOutline outline = patch_outline(lit.mesh, i);
      if (!(outline.center.x() > 4.0 + 1e-6)) continue;  // bright, or in the slit's plane
      double found = 0.0;
      for (const FormFactor& f : form_factors->row(i)) {
        const int e = lit.mesh.first_element[f.patch];
        if (lit.rooms.is_bright(lit.mesh, e)) found += lit.mesh.area[i] * f.value;
      }
      const double truth = polygon_exchange(outline, slit);
      squares += std::pow(found - truth, 2);
      all += truth * truth;
    }
    return std::sqrt(squares / all);
  };
  const double with = exchange(portals), without = exchange(nullptr);
  // The kernel of the form factor varies over slit and patch by about its mean. So 128 aimed rays
  // of a row leave 1 / sqrt(128) = 0.09; half as much again for chance.
  EXPECT_LT(with, 0.13);
  EXPECT_GT(without, 5.0 * with);
}

// The vertex in the mouth of the slit is as bright as the bright room, but only the few millimetres
// around it are: large elements there must not be read.
TEST(Portals, DoNotLetAVertexInTheSlitShine) {
  Lit lit(1e-3);
  const auto portals = lit.portals();
  ASSERT_NE(portals, nullptr);
  int mouth = -1;
  double least = 1.0;
  for (int e = 0; e < lit.mesh.element_count(); ++e) {
    if (lit.mesh.facet[e] != dim_floor) continue;
    for (int c = 0; c < lit.mesh.corner_count(e); ++c) {
      const int v = lit.mesh.corners[e][c];
      const double distance = (lit.mesh.position(v) - Vector3d(4, 2.9, 0)).norm();
      if (distance < least) {
        least = distance;
        mouth = v;
      }
    }
  }
  ASSERT_GE(mouth, 0);
  lit.radiosity.row(mouth) = 1.0f;
  const GatherPoint point{.position = {5.0, 2.7, 2.7}, .normal = {0, 0, -1}, .facet = dim_ceiling};
  const double F = point_to_polygon(point.position, point.normal, lit.rooms.slit());
  const Statistics E = gathered(lit, portals, point, 1024, 8);
  // The floor reflects half of the light of the slit, of which it gets less than half, and of that
  // less than half reaches the point: less than an eighth more.
  EXPECT_NEAR(E.mean, F, 0.125 * F + 4.0 * E.deviation / std::sqrt(8.0));
  EXPECT_LT(E.deviation, 0.5 * F);
}

// Mean irradiance at places of the dim room that the lamp in the bright one does not see.
double mean_behind(double width) {
  test::RoomsWithSlit rooms(width);
  const int lamp = test::add_material(rooms.scene, test::diffuse(rooms.scene.bands, 0.0f, 100.0f));
  test::add_polygon(rooms.scene, "lamp", lamp,
                    {{1.5, 2, 2.6}, {1.5, 3, 2.6}, {2.5, 3, 2.6}, {2.5, 2, 2.6}});
  const SolvedScene solved = solve_scene(rooms.scene, {.mesh = {.max_patch_size = 0.6},
                                                       .gather = {.rays = 64},
                                                       .refine = {.tolerance = 0.0},
                                                       .error_points = 0});
  const ElementCaster caster(solved.mesh);
  const DirectLight light(rooms.scene, solved.mesh);
  const BandArray B = gatherable_radiosity(solved.mesh, light, solved.solution.irradiance());
  std::vector<GatherPoint> points;
  for (const double x : {4.5, 5.5, 6.5, 7.5}) {
    points.push_back({.position = {x, 0.7, 0}, .facet = dim_floor});
    points.push_back({.position = {x, 1.5, 2.7}, .normal = {0, 0, -1}, .facet = dim_ceiling});
  }
  const GatherOptions options{
      .rays = 1024,
      .portals = find_portals(rooms.scene, caster, brightness_of_vertices(solved.mesh, B))};
  return gather_irradiance({rooms.scene, caster, light}, B, points, options).indirect.col(0).mean();
}

// The light behind a slit is proportional to its width: the solid angle of the bright room, seen
// from the slit, does not depend on it. 0.05 for the width of the beam on the floor, which reflects
// most of the light, and as much for the noise of rows.
TEST(Portals, LightARoomInProportionToTheirWidth) {
  const double narrow = mean_behind(1e-3), wide = mean_behind(1e-2);
  EXPECT_NEAR(10.0 * narrow, wide, 0.1 * wide);
}

}  // namespace
}  // namespace lightwell::portals_test
