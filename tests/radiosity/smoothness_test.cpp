// Smooth light must look smooth with any mesh: no Mach bands, no streaks from slivers, no jumps
// between elements, and the same light in any unit of length.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "mesh/cleaning/planar_regions.h"
#include "tests/radiosity/lit_places.h"

namespace lightwell::smoothness_test {
namespace {

using Eigen::Vector3d;
using test::direct_alone, test::even, test::lamp_loop, test::Lit, test::lit_floor;

// Largest error of second differences of irradiance at points one element of even size apart, as a
// share of E.
double second_differences_off(const SolveOptions& options) {
  const Loop lamp = lamp_loop({0.1, -0.2, 1.5}, 0.25);
  const Lit lit(lit_floor({-1, -1}, {1, 1}, lamp), options);
  const int n =
      2 * static_cast<int>(std::ceil(1.0 / lit.element_size));  // elements along the floor
  const double h = 2.0 / n;
  const Vector3d up = Vector3d::UnitZ();
  const auto truth = [&](double x, double y) { return point_to_polygon({x, y, 0}, up, lamp); };
  double share = 0.0;
  for (int i = 2; i < n - 1; ++i) {
    for (int k = 1; k < n; ++k) {
      const double x = -1 + i * h, y = -1 + k * h;
      const double ours = lit.irradiance({x - h, y, 0}) - 2 * lit.irradiance({x, y, 0}) +
                          lit.irradiance({x + h, y, 0});
      const double exact = truth(x - h, y) - 2 * truth(x, y) + truth(x + h, y);
      share = std::max(share, std::abs(ours - exact) / truth(x, y));
    }
  }
  std::printf("Mach bands: second differences off by %.1e of E\n", share);
  return share;
}

TEST(MachBands, SecondDifferencesAreThoseOfTheClosedForm) {
  // Vertices are gathered a hundredth of an element to one side, which changes a second difference
  // by h^3 (Exxx + Exxy) / 100, 1.7e-6 of E with h = 26 mm and third derivatives below 5 E. Four
  // floats add 2.4e-7. The second differences themselves are 1e-3 of E.
  EXPECT_LT(second_differences_off(even(direct_alone())), 2e-6);
}

// In elements of twice the size, 5.2 cm, which refinement leaves, every other point is in the
// middle of an element and off by h^2 / 8 (Exx + Eyy), 1.4e-3 of E with 2 / m^2 each; its
// neighbours are off by as much the other way. Differences are visible from 1e-2.
TEST(MachBands, OfRefinedElementsAreBelowWhatIsSeen) {
  EXPECT_LT(second_differences_off(direct_alone()), 2.8e-3);
}

// Noise of the gather makes bands too; changes of brightness are visible from about one percent.
TEST(MachBands, GatheredLightKeepsThemBelowWhatIsSeen) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const int light = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 20.0f));
  test::add_box(scene, {-1, -1, 0}, {1, 1, 2}, {grey, grey, grey, grey, grey, grey}, true);
  test::add_polygon(scene, "lamp", light, lamp_loop({0, 0, 1.9}, 0.2));
  const Lit lit(scene, {.error_points = 0});
  const int n = 2 * static_cast<int>(std::ceil(1.0 / lit.element_size));
  const double h = 2.0 / n;
  double most = 0.0, squares = 0.0;
  int count = 0;
  for (int i = 3; i <= n - 3; ++i) {  // nearer to the walls light itself changes as much
    for (int k = 3; k <= n - 3; ++k, ++count) {
      const double x = -1 + i * h, y = -1 + k * h;
      const double E = lit.irradiance({x, y, 0});
      const double second =
          (lit.irradiance({x - h, y, 0}) - 2 * E + lit.irradiance({x + h, y, 0})) / E;
      most = std::max(most, std::abs(second));
      squares += second * second;
    }
  }
  const double rms = std::sqrt(squares / count);
  std::printf("Mach bands in a room: %.1e of E in the root mean square, %.1e at most\n", rms, most);
  EXPECT_LT(rms, 0.0033);  // three of them are a percent
  EXPECT_LT(most, 0.01);
}

Loop wall_lamp() {
  return lamp_loop({1.2, -1.5, 2.8}, 0.15);
}

// The wall y = 0 as a fan of slivers from one corner; 0 slivers: one polygon.
Scene walled(int slivers) {
  Scene scene = lit_floor({0, -3}, {3, 0}, wall_lamp());
  PolygonMesh wall{.vertices = {{0, 0, 0}}, .facets = {}};
  const int pieces = std::max(1, slivers - 1);
  for (int i = 0; i <= pieces; ++i) wall.vertices.emplace_back(3, 0, 2.5 * i / pieces);
  wall.vertices.emplace_back(0, 0, 2.5);
  if (slivers == 0) {
    wall.facets = {Facet{.boundary = {0, 1, 2, 3}}};
  } else {
    for (int i = 1; i <= slivers; ++i) wall.facets.push_back(Facet{.boundary = {0, i, i + 1}});
  }
  scene.surfaces.push_back({.name = "wall", .material = 0, .shape = wall});
  return scene;
}

// Irradiance at 3000 points of the wall: all light, and the light straight from the lamp.
struct OnWall {
  std::vector<double> all{}, direct{};
};

// Elements of even size, so that errors by slivers are not mixed with those of refinement.
OnWall on_wall(const Scene& scene) {
  const Lit lit(scene, even({.error_points = 0}));
  OnWall E;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 50; ++k) {
      const Vector3d at(0.05 + i * 0.0489, 0, 0.05 + k * 0.0489);
      E.all.push_back(lit.irradiance(at, -Vector3d::UnitY()));
      E.direct.push_back(lit.direct(at, -Vector3d::UnitY()));
    }
  }
  return E;
}

struct Difference {
  double rms = 0.0, most = 0.0;
};

Difference relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  Difference d;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double off = a[i] / b[i] - 1.0;
    d.most = std::max(d.most, std::abs(off));
    d.rms += off * off / static_cast<double>(a.size());
  }
  d.rms = std::sqrt(d.rms);
  return d;
}

TEST(Slivers, LeaveNoStreaksMergedOrNot) {
  std::vector<double> truth;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 50; ++k) {
      const Vector3d at(0.05 + i * 0.0489, 0, 0.05 + k * 0.0489);
      truth.push_back(point_to_polygon(at, -Vector3d::UnitY(), wall_lamp()));
    }
  }
  const OnWall polygon = on_wall(walled(0));
  for (const bool merged : {true, false}) {
    Scene scene = walled(40);
    if (merged) scene = merge_planar_regions(scene);
    const OnWall fan = on_wall(scene);
    const Difference direct = relative_difference(fan.direct, truth);
    const Difference all = relative_difference(fan.all, polygon.all);
    std::printf("slivers%s: direct light off by %.1e, all against one polygon %.1e, rms %.1e\n",
                merged ? ", merged" : "", direct.most, all.most, all.rms);
    // Elements of 4 cm: h^2 / 8 (Exx + Ezz) / E with light that falls off over 0.5 m, and vertices
    // that are gathered 1.4 % of an element inside.
    EXPECT_LT(direct.most, 4e-3);
    // Vertices lie elsewhere on the wall, so the noise of their 1024 rays, 2e-3, differs.
    EXPECT_LT(all.rms, 2.8e-3);
    EXPECT_LT(all.most, 0.015);
  }
}

// An edge by the positions of its ends, in nanometres, lower end first.
using PointKey = std::array<long long, 3>;
using Edge = std::array<PointKey, 2>;

PointKey key_of(const Vector3d& p) {
  return {std::llround(p.x() * 1e9), std::llround(p.y() * 1e9), std::llround(p.z() * 1e9)};
}

// Irradiance at the ends of each edge, from every element along the edge.
std::map<Edge, std::vector<std::array<double, 2>>> edges_of(const Lit& lit, int surface) {
  const PatchMesh& mesh = lit.solved.mesh;
  std::map<Edge, std::vector<std::array<double, 2>>> edges;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.surface[mesh.patch[e]] != surface) continue;
    const int n = mesh.corner_count(e);
    for (int i = 0; i < n; ++i) {
      int a = mesh.corners[e][i], b = mesh.corners[e][(i + 1) % n];
      if (key_of(mesh.position(b)) < key_of(mesh.position(a))) std::swap(a, b);
      edges[{key_of(mesh.position(a)), key_of(mesh.position(b))}].push_back(
          {lit.E(a, 0), lit.E(b, 0)});
    }
  }
  return edges;
}

bool is_on_rim(const Edge& edge) {
  const auto both_at = [&](int axis, double value) {
    return std::abs(edge[0][axis] - value * 1e9) < 10 && std::abs(edge[1][axis] - value * 1e9) < 10;
  };
  return both_at(0, 0) || both_at(0, 3) || both_at(1, -3) || both_at(2, 2.5) ||
         (both_at(1, 0) && both_at(2, 0));
}

// Few rays, so that two vertices at one position would differ by noise.
class Reconstruction : public testing::TestWithParam<double> {};  // tolerance of refinement
INSTANTIATE_TEST_SUITE_P(Refined, Reconstruction, testing::Values(0.0, 0.01, 0.002));

TEST_P(Reconstruction, DoesNotJumpAcrossAnyEdgeInsideASurface) {
  SolveOptions options{.error_points = 0};
  options.gather.rays = 64;
  options.refine.tolerance = GetParam();
  options.refine.max_elements = 1000000;
  const Lit lit(walled(40), options);
  double most = 0.0;
  int inside = 0;
  for (const int surface : {0, 2}) {  // floor and wall
    for (const auto& [edge, sides] : edges_of(lit, surface)) {
      if (sides.size() == 1) {
        EXPECT_TRUE(is_on_rim(edge));  // or a corner would lie inside another element's edge
        continue;
      }
      ASSERT_EQ(sides.size(), 2u);
      ++inside;
      for (const int end : {0, 1}) {
        most = std::max(most, std::abs(sides[0][end] / sides[1][end] - 1.0));
      }
    }
  }
  std::printf("reconstruction: largest jump across %d edges %.1e\n", inside, most);
  EXPECT_GT(inside, GetParam() > 0.0 ? 3000 : 10000);
  EXPECT_LT(most, 1e-6);
}

TEST(Scale, IrradianceIsThatOfTheSameRoomInAnyUnit) {
  const auto irradiance = [](double scale) -> Eigen::ArrayXXd {
    Scene scene = walled(0);
    test::add_box(scene, {0.9, -1.1, 0}, {1.4, -0.6, 0.8}, {0, 0, 0, 0, 0, 0}, false);
    for (Surface& surface : scene.surfaces) {
      for (Vector3d& v : std::get<PolygonMesh>(surface.shape).vertices) v *= scale;
    }
    return solve_scene(scene, even({.error_points = 0})).solution.irradiance().cast<double>();
  };
  const Eigen::ArrayXXd E = irradiance(1.0);
  for (const double scale : {1e-3, 1e3, 1024.0}) {
    const Eigen::ArrayXXd other = irradiance(scale);
    ASSERT_EQ(other.rows(), E.rows());
    const Eigen::ArrayXXd off = (other - E).abs() / E.maxCoeff();
    const double share = (off > 1e-5).cast<double>().mean();
    std::printf("scale %g: off by at most %.1e, more than 1e-5 at a share of %.1e\n", scale,
                off.maxCoeff(), share);
    // At few points, rounding may send one ray of 1024 past the block instead of into it.
    EXPECT_LT(share, 1e-3);
    EXPECT_LT(off.maxCoeff(), 1e-3);
    if (scale == 1024.0) {
      EXPECT_EQ(off.maxCoeff(), 0.0);  // a power of two rounds nothing
    }
  }
}

}  // namespace
}  // namespace lightwell::smoothness_test
