// The shadow artefacts that radiosity pictures are known for (Baum, Mann, Smith & Winget 1991,
// "Making radiosity usable"), each in a small scene at default sizes. Unless a test gathers,
// irradiance is read off the mesh, as by probes and by pictures with interpolation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "mesh/build_patches.h"
#include "radiosity/direct_light/direct_light.h"
#include "tests/radiosity/lit_places.h"

namespace lightwell::artefacts_test {
namespace {

using Eigen::Vector3d;
using test::add_black, test::direct_alone, test::lamp_loop, test::Lit, test::lit_floor;

struct Contour {
  double farthest = 0.0;  // from the true line, in elements
  int crossings = 0;      // of 101 lines across it
};

// A lamp of 2 mm over a screen whose edge runs askew to the floor's mesh: a penumbra of a tenth of
// an element.
Contour shadow_edge(bool discontinuity) {
  const Vector3d middle(0.013, 0.007, 2);
  const Loop lamp = lamp_loop(middle, 0.001);
  Scene scene = lit_floor({-1, -1}, {1, 1}, lamp);
  const double angle = 0.47;
  const Vector3d along(std::cos(angle), std::sin(angle), 0),
      across(-std::sin(angle), std::cos(angle), 0), up = Vector3d::UnitZ();
  test::add_polygon(
      scene, "screen", add_black(scene),
      {up - 1.2 * along, up + 1.2 * along, up + 1.2 * along + across, up - 1.2 * along + across});
  SolveOptions options = direct_alone();
  options.mesh.discontinuity = discontinuity;
  const Lit lit(scene, options);
  Contour contour;
  const double step = lit.element_size / 64.0;
  for (int i = 0; i <= 100; ++i) {
    // The edge seen from the lamp's middle; a plane through it and the edge halves the lamp.
    const Vector3d line = 2.0 * up - middle + (i - 50) * 0.0131 * along;
    bool was_lit = true;
    for (int k = -192; k <= 192; ++k) {
      const Vector3d at = line + k * step * across;
      const bool is_lit = lit.irradiance(at) > 0.5 * point_to_polygon(at, up, lamp);
      if (is_lit != was_lit) {
        ++contour.crossings;
        contour.farthest = std::max(contour.farthest, std::abs(k - 0.5) / 64.0);
      }
      was_lit = is_lit;
    }
  }
  std::printf("shadow edge: element %.4f m, half value at most %.3f elements off, %d crossings\n",
              lit.element_size, contour.farthest, contour.crossings);
  return contour;
}

// Values at vertices are the whole light or nothing. In a cell with both, the half value lies
// within half a cell of any line that separates its lit from its dark corners. The penumbra adds
// half its width, 0.05 elements.
TEST(ShadowEdges, StayWithinHalfAnElementOfTheTruth) {
  const Contour contour = shadow_edge(false);
  EXPECT_EQ(contour.crossings, 101);
  EXPECT_LT(contour.farthest, 0.55);
}

// Vertices lie on both bounds of the penumbra, which is 0.09 elements wide, so the half value lies
// between.
TEST(ShadowEdges, FollowTheTruthWhereTheMeshIsCutAlongThem) {
  const Contour contour = shadow_edge(true);
  EXPECT_EQ(contour.crossings, 101);
  EXPECT_LT(contour.farthest, 0.05);
}

// A panel without thickness that stands on the floor or goes through it, and ends inside it.
class Panel : public testing::TestWithParam<double> {};  // how deep it goes below the floor

TEST_P(Panel, NeitherDarkensTheLitSideNorLightensTheDarkOne) {
  const Loop lamp = lamp_loop({-0.7, 0, 1.6}, 0.1);
  Scene scene = lit_floor({-1, -1}, {1, 1}, lamp);
  const Vector3d along = Vector3d(0.2, 1, 0).normalized(), out = Vector3d(-1, 0.2, 0).normalized();
  const Vector3d foot(0.1037, 0.011, -GetParam()), top(0.1037, 0.011, 0.5);
  test::add_polygon(scene, "panel", add_black(scene),
                    {foot - 0.6 * along, foot + 0.6 * along, top + 0.6 * along, top - 0.6 * along});
  const Lit lit(scene, direct_alone());
  double darkest = 0.0, brightest = 0.0;
  for (int i = 0; i <= 100; ++i) {
    const Vector3d at = Vector3d(0.1037, 0.011, 0) + (i - 50) * 0.0113 * along;
    for (const double distance : {0.02, 0.3}) {
      const Vector3d lit_place = at + distance * lit.element_size * out;
      const double truth = point_to_polygon(lit_place, Vector3d::UnitZ(), lamp);
      darkest = std::max(darkest, std::abs(lit.irradiance(lit_place) / truth - 1.0));
    }
    if (std::abs(i - 50) > 40) continue;  // light passes around the panel's ends
    const double leak = lit.irradiance(at - 0.02 * lit.element_size * out);
    brightest = std::max(brightest, leak / point_to_polygon(at, Vector3d::UnitZ(), lamp));
  }
  std::printf("panel %.1f m deep: lit side off by %.1e, dark side %.1e\n", GetParam(), darkest,
              brightest);
  // Vertices lie 2 % of half an element's diagonal inside the element, 1.4 % of 3 cm, and light
  // falls off by at most 1.7 a metre: 7e-4. Interpolation adds h^2 / 8 (Exx + Eyy) / E, 3e-4. A
  // mixture with the dark side would be off by a half.
  EXPECT_LT(darkest, 1e-3);
  EXPECT_EQ(brightest, 0.0);
}
INSTANTIATE_TEST_SUITE_P(Depths, Panel, testing::Values(0.0, 0.1));

// Floor and ceiling are one polygon each, under and over a partition without thickness that runs
// askew to their mesh. Surfaces beyond the partition see no emitter and nothing that reflects
// light.
TEST(LightLeaks, NothingPassesUnderAPartitionThatParts) {
  Scene scene;
  const int white = test::add_material(scene, test::diffuse(scene.bands, 0.7f));
  Material both_sides = test::diffuse(scene.bands, 0.7f);
  both_sides.one_sided = false;
  const int sheet = test::add_material(scene, both_sides);
  const int light = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 20.0f));
  test::add_box(scene, {0, 0, 0}, {4, 2, 2}, {white, white, white, white, white, white}, true);
  test::add_polygon(scene, "partition", sheet,
                    {{1.71, 0, 0}, {2.23, 2, 0}, {2.23, 2, 2}, {1.71, 0, 2}});
  test::add_polygon(scene, "lamp", light, lamp_loop({0.8, 1, 1.9}, 0.2));
  const Lit lit(scene, {.gather = {.rays = 64}, .error_points = 0});
  const Vector3d along = Vector3d(0.52, 2, 0).normalized(), into_dark(along.y(), -along.x(), 0);
  double dark = 0.0, least_lit = 1e9;
  for (int i = 20; i <= 180; ++i) {
    const Vector3d foot = Vector3d(1.71, 0, 0) + i * 0.01 * Vector3d(0.26, 1, 0);
    for (const double distance : {0.02, 0.5, 3.0}) {
      const Vector3d off = distance * lit.element_size * into_dark;
      dark = std::max(dark, lit.irradiance(foot + off));
      least_lit = std::min(least_lit, lit.irradiance(foot - 0.02 * lit.element_size * into_dark));
    }
  }
  std::printf("partition: dark side %.1e, lit side at least %.3f W/m2\n", dark, least_lit);
  EXPECT_EQ(dark, 0.0);
  EXPECT_GT(least_lit, 0.1);
}
/// A box of `half` edges in metres, turned at random, with corners to eight digits, as in a file.
struct TurnedBox {
  Eigen::Matrix3d axes;
  Vector3d middle, half;

  TurnedBox(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const Eigen::Quaterniond turn(normal(random), normal(random), normal(random), normal(random));
    axes = turn.normalized().toRotationMatrix();
    std::uniform_real_distribution<double> place(-0.35, 0.35), size(0.2, 0.6);
    for (int c = 0; c < 3; ++c) middle[c] = place(random), half[c] = size(random);
  }
  bool holds(const Vector3d& p) const {
    return ((axes.transpose() * (p - middle)).cwiseAbs().array() < half.array()).all();
  }
  void add(Scene& scene, int material) const {
    const auto first = scene.surfaces.size();
    test::add_box(scene, -half, half, {material, material, material, material, material, material},
                  false);
    for (std::size_t s = first; s < scene.surfaces.size(); ++s) {
      for (Vector3d& v : std::get<PolygonMesh>(scene.surfaces[s].shape).vertices) {
        v = ((middle + axes * v) * 1e8).array().round() * 1e-8;
      }
    }
  }
};

// Two boxes that run through each other below a panel; their sheets reflect on both sides. Contact
// lines cross edges everywhere, and gaps close in wedges.
TEST(LightLeaks, BoxesThatRunThroughEachOtherAreDarkInside) {
  constexpr double reflectance = 0.5, exitance = 100.0;
  constexpr int rays = 64;
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    std::mt19937 random(seed);
    Scene scene;
    Material both_sides = test::diffuse(scene.bands, static_cast<float>(reflectance));
    both_sides.one_sided = false;
    const int sheet = test::add_material(scene, both_sides);
    const int light = test::add_material(scene, test::diffuse(scene.bands, 0.0f, exitance));
    const std::array<TurnedBox, 2> boxes{TurnedBox(random), TurnedBox(random)};
    for (const TurnedBox& box : boxes) box.add(scene, sheet);
    test::add_polygon(scene, "lamp", light, lamp_loop({0, 0, 3}, 2.0));
    const Lit lit(scene, {.gather = {.rays = rays}, .error_points = 0});
    const PatchMesh& mesh = lit.solved.mesh;
    double dark = 0.0, dark_area = 0.0;
    for (int e = 0; e < mesh.element_count(); ++e) {
      const PatchPoint at = element_center(mesh, e);
      // Beyond the eight digits of the corners.
      constexpr double above = 1e-6;
      const Vector3d place = at.position + above * at.normal;
      if (!boxes[0].holds(place) && !boxes[1].holds(place)) continue;
      dark_area += mesh.element_area[e];
      for (int c = 0; c < mesh.corner_count(e); ++c) {
        dark = std::max<double>(dark, lit.E.row(mesh.corners[e][c]).maxCoeff());
      }
    }
    EXPECT_GT(dark_area, 1.0) << seed;
    // One of 64 rays that leaves a box brings rho E / 64 of the place it meets, which has more than
    // a hundredth of the most light of all.
    EXPECT_LT(dark, reflectance * lit.E.maxCoeff() / (100.0 * rays)) << seed;
  }
}

// A table leg of 2 cm or less, on elements of 5 cm and patches of 10; `shift` moves the leg over
// the mesh.
struct Leg {
  explicit Leg(double shift, double thickness = 0.02)
      : low(0.307 + shift, 0.231 + 0.7 * shift, 0),
        high(low + Vector3d(thickness, thickness, 0.7)) {}
  Vector3d low, high;
  Vector3d lamp_middle{-0.9, -0.4, 2.2};
  double lamp_half = 0.15;
  Loop lamp() const { return lamp_loop(lamp_middle, lamp_half); }
  Vector3d foot() const { return 0.5 * (low + Vector3d(high.x(), high.y(), 0)); }
  Scene scene() const {
    Scene scene = lit_floor({-2, -2}, {2, 2}, lamp());
    const int black = add_black(scene);
    test::add_box(scene, low, high, {black, black, black, black, black, black}, false);
    return scene;
  }
};

bool hides(const Leg& leg, const Vector3d& from, const Vector3d& to) {
  double enters = 0.0, leaves = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = to[axis] - from[axis];
    const double a = (leg.low[axis] - from[axis]) / way, b = (leg.high[axis] - from[axis]) / way;
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  return enters < leaves;
}

// Irradiance of the floor by 64 x 64 rays to the lamp, without any code of the library.
double beside_leg(const Leg& leg, const Vector3d& at) {
  constexpr int n = 64;
  double sum = 0.0;
  for (int i = 0; i < n * n; ++i) {
    const Vector3d offset((i % n + 0.5) / n - 0.5, (i / n + 0.5) / n - 0.5, 0);
    const Vector3d to = leg.lamp_middle + 2.0 * leg.lamp_half * offset;
    const Vector3d way = to - at;
    if (!hides(leg, at, to)) sum += way.z() * way.z() / std::pow(way.squaredNorm(), 2);
  }
  return sum * std::pow(2.0 * leg.lamp_half / n, 2) / std::numbers::pi;
}

// Points at a twentieth of the leg's thickness from the two faces that are turned away from the
// lamp.
std::vector<Vector3d> behind_foot(const Leg& leg) {
  std::vector<Vector3d> places;
  const double step = (leg.high.x() - leg.low.x()) / 20.0;
  for (int k = 0; k < 20; ++k) {
    const double t = (k + 0.5) * step;
    places.emplace_back(leg.high.x() + step, leg.low.y() + t, 0);
    places.emplace_back(leg.low.x() + t, leg.high.y() + step, 0);
  }
  return places;
}

struct LegShadow {
  double true_behind = 0.0;  // true value of `behind`
  double behind = 0.0;       // mean irradiance behind the foot, as a share of the unshadowed
  double before = 0.0;       // largest error on the lit side of the foot, as a share of the truth
  double least = 1e9,
         most = 0;     // of strips across the shadow: light taken, as a share of the truth
  double whole = 0.0;  // light taken by all strips together, as a share of the truth
};

LegShadow leg_shadow(const Leg& leg, bool discontinuity) {
  SolveOptions options = direct_alone();
  options.mesh.discontinuity = discontinuity;
  const Lit lit(leg.scene(), options);
  const Vector3d up = Vector3d::UnitZ(), foot = leg.foot();
  const Loop lamp = leg.lamp();
  LegShadow shadow;
  const std::vector<Vector3d> places = behind_foot(leg);
  const double open = point_to_polygon(foot, up, lamp) * static_cast<double>(places.size());
  for (const Vector3d& at : places) {
    shadow.behind += lit.irradiance(at) / open;
    shadow.true_behind += beside_leg(leg, at) / open;
    const Vector3d before = 2.0 * foot - at;
    shadow.before = std::max(
        shadow.before, std::abs(lit.irradiance(before) / point_to_polygon(before, up, lamp) - 1.0));
  }
  Vector3d away = foot - leg.lamp_middle;
  away.z() = 0.0;
  away.normalize();
  const Vector3d across(-away.y(), away.x(), 0);
  double taken = 0.0, truth = 0.0;
  for (int i = 0; i < 40; ++i) {
    double strip = 0.0, true_strip = 0.0;
    for (int k = -30; k <= 30; ++k) {
      const Vector3d at = foot + (0.02 + 0.01 * i) * away + 0.005 * k * across;
      const double unshadowed = point_to_polygon(at, up, lamp);
      strip += unshadowed - lit.irradiance(at);
      true_strip += unshadowed - beside_leg(leg, at);
    }
    taken += strip;
    truth += true_strip;
    shadow.least = std::min(shadow.least, strip / true_strip);
    shadow.most = std::max(shadow.most, strip / true_strip);
  }
  shadow.whole = taken / truth;
  std::printf(
      "leg%s: behind its foot %.3f of the open floor (truth %.3f), before it off by %.1e; shadow "
      "%.3f of the truth, strips %.2f to %.2f\n",
      discontinuity ? ", cut" : "", shadow.behind, shadow.true_behind, shadow.before, shadow.whole,
      shadow.least, shadow.most);
  return shadow;
}

// The leg moves over the mesh by up to half an element.
class ThinLeg : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Shifts, ThinLeg, testing::Values(0.0, 0.013, 0.029));

TEST_P(ThinLeg, CastsAnUnbrokenShadowFromItsFoot) {
  const LegShadow shadow = leg_shadow(Leg(GetParam()), false);
  // Along a dark face irradiance rises linearly from 0, at the last vertex in the leg's shadow, to
  // at most the whole light at the far corner, whose element lies beyond the leg. If the face is
  // split in four, that is a half over a quarter of the face. Without a contact line it would be
  // about 1.
  EXPECT_LT(shadow.behind, shadow.true_behind + 0.125);
  // The bound beside a panel, with elements of 5 cm and 0.8 a metre.
  EXPECT_LT(shadow.before, 1e-3);
  // Linear elements spread the shadow at one vertex over two elements. The shadow is 2 to 6
  // elements of 1.2 cm wide, so strips may hold half more than the truth; a shadow broken into dots
  // would have strips of 0.
  EXPECT_GT(shadow.least, 0.75);
  EXPECT_LT(shadow.most, 1.5);
  EXPECT_NEAR(shadow.whole, 1.0, 0.1);
}

// A leg of a fifth of an element: the shadow is 1 to 5 elements of 1.2 cm wide, so strips may hold
// between half of the truth and twice as much.
TEST_P(ThinLeg, OfOneCentimetreDoesSoToo) {
  const LegShadow shadow = leg_shadow(Leg(GetParam(), 0.01), false);
  EXPECT_LT(shadow.behind, shadow.true_behind + 0.25);  // the face in two
  EXPECT_LT(shadow.before, 1e-3);
  EXPECT_GT(shadow.least, 0.5);
  EXPECT_LT(shadow.most, 2.0);
  EXPECT_NEAR(shadow.whole, 1.0, 0.1);
}

// A leg of a tenth of an element: the light that its shadow takes from the floor is below the
// tolerance except at the foot. The shadow must not be lost, and must be dark at the foot.
TEST_P(ThinLeg, OfHalfACentimetreIsNotLost) {
  const LegShadow shadow = leg_shadow(Leg(GetParam(), 0.005), false);
  EXPECT_LT(shadow.behind, 0.5);
  EXPECT_LT(shadow.before, 1e-3);
  EXPECT_GT(shadow.least, 0.0);
  EXPECT_NEAR(shadow.whole, 1.0, 0.5);
}

TEST_P(ThinLeg, TouchesTheFloorWhereTheMeshIsCutAlongItsShadow) {
  const LegShadow shadow = leg_shadow(Leg(GetParam()), true);
  // Vertices lie on the bounds of umbra and penumbra. An uncut bit at the corner leaves 1 of 20
  // points on each face.
  EXPECT_NEAR(shadow.behind, shadow.true_behind, 0.05);
  EXPECT_LT(shadow.before, 1e-3);
  EXPECT_GT(shadow.least, 0.75);
  EXPECT_LT(shadow.most, 1.5);
  EXPECT_NEAR(shadow.whole, 1.0, 0.2);
}

// Pictures by gathering and probes compute light at the point itself, without the mesh.
TEST_P(ThinLeg, IsDarkBehindItsFootWhereLightIsGathered) {
  const Leg leg(GetParam());
  const Scene scene = leg.scene();
  const PatchMesh mesh = build_patches(scene);
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  const Vector3d up = Vector3d::UnitZ();
  const double open = point_to_polygon(leg.foot(), up, leg.lamp());
  double off = 0.0;
  for (const Vector3d& at : behind_foot(leg)) {
    const ShadowOptions shadows{.min_rays = 32, .max_rays = 256};
    const double E =
        direct_light.irradiance(caster, {.at = {at, up, 0}, .key = 1, .shadows = shadows})[0];
    off = std::max(off, std::abs(E - beside_leg(leg, at)) / open);
  }
  std::printf("leg, gathered: off by at most %.3f\n", off);
  // 16 x 16 stratified rays: a straight shadow edge crosses at most 32 of 256 cells, each of which
  // is off by at most a half and 0.3 in the mean square: 0.3 sqrt(32) / 256 = 0.007, times 4.
  EXPECT_LT(off, 0.028);
}

}  // namespace
}  // namespace lightwell::artefacts_test
