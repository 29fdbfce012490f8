#include "radiosity/refine/refine_solution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "mesh/build_patches.h"
#include "scene/parallel.h"
#include "tests/radiosity/lit_places.h"
#include "tests/temporary_folder.h"

namespace lightwell::refine_solution_test {
namespace {

using Eigen::Vector3d;
using test::add_black, test::direct_alone, test::lamp_loop, test::Lit, test::lit_floor;

SolveOptions refined_to(double tolerance) {
  SolveOptions options = direct_alone();
  options.refine.tolerance = tolerance;
  options.refine.max_elements = 1000000;
  return options;
}

Loop small_lamp() {
  return lamp_loop({0.1, -0.2, 0.8}, 0.1);
}

// RMS difference from the closed form over its mean, at 80 x 80 points of the floor.
double floor_error(const Lit& lit, const Loop& lamp) {
  double squares = 0.0, sum = 0.0;
  constexpr int n = 80;
  for (int i = 0; i < n * n; ++i) {
    const Vector3d at(-1 + 2 * (i % n + 0.5) / n, -1 + 2 * (i / n + 0.5) / n, 0);
    const double E = point_to_polygon(at, Vector3d::UnitZ(), lamp);
    squares += std::pow(lit.irradiance(at) - E, 2);
    sum += E;
  }
  return std::sqrt(squares / (n * n)) / (sum / (n * n));
}

TEST(Refinement, ReachesTheToleranceAndKnowsItsError) {
  const Scene scene = lit_floor({-1, -1}, {1, 1}, small_lamp());
  double before = 1.0;
  for (const double tolerance : {0.01, 0.003, 0.001}) {
    SolveReport report;
    const Lit lit(scene, refined_to(tolerance));
    solve_scene(scene, refined_to(tolerance), &report);
    const double error = floor_error(lit, small_lamp());
    std::printf("asked for %.4f: error %.5f, estimated %.5f, %lld elements\n", tolerance, error,
                report.refinement.estimate, static_cast<long long>(report.refinement.elements));
    EXPECT_EQ(report.refinement.outcome, RefineOutcome::tolerance_reached);
    EXPECT_LE(report.refinement.estimate, tolerance);
    // Five points of a cell give the error of the quadratic part of smooth light exactly. The rest
    // of the light, and bounds of cells that were not measured, add at most a half.
    EXPECT_LT(error, 1.5 * report.refinement.estimate);
    EXPECT_LE(error, before);
    before = error;
  }
}

// With linear elements the error falls as the inverse of their number, so that error times elements
// compares meshes of different sizes.
TEST(Refinement, NeedsFewerElementsThanEvenOnesForTheSameError) {
  const Scene scene = lit_floor({-1, -1}, {1, 1}, small_lamp());
  SolveOptions even_options = direct_alone();
  even_options.refine.tolerance = 0.0;
  const Lit even(scene, even_options), refined(scene, refined_to(0.003));
  const double even_work = floor_error(even, small_lamp()) * even.solved.mesh.element_count();
  const double work = floor_error(refined, small_lamp()) * refined.solved.mesh.element_count();
  std::printf("error times elements: %.3f even, %.3f refined\n", even_work, work);
  EXPECT_LT(work, 0.7 * even_work);
}

// A black square over the floor, of a fifth of an element at the start. No vertex and no compared
// point of an element need lie in its shadow.
class SmallUmbra : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Shifts, SmallUmbra, testing::Values(0.0, 0.0171, 0.0313));

TEST_P(SmallUmbra, IsFound) {
  const Loop lamp = lamp_loop({0.05, 0.02, 2.0}, 0.05);
  Scene scene = lit_floor({-1, -1}, {1, 1}, lamp);
  const Vector3d middle(0.183 + GetParam(), -0.267 + 0.6 * GetParam(), 0.03);
  test::add_polygon(scene, "flake", add_black(scene), lamp_loop(middle, 0.01));
  const Lit lit(scene, direct_alone());
  // The point straight behind the square, seen from the lamp's middle; penumbras are 0.8 mm wide.
  const Vector3d from(0.05, 0.02, 2.0), way = middle - from;
  const Vector3d under = from + way * (from.z() / -way.z());
  const double open = point_to_polygon(under, Vector3d::UnitZ(), lamp);
  const double aside = lit.irradiance(under + Vector3d(0.06, 0.05, 0)) / open;
  std::printf("umbra of 2 cm: %.3f of the open floor in its middle, %.3f beside\n",
              lit.irradiance(under) / open, aside);
  EXPECT_LT(lit.irradiance(under) / open, 0.1);
  EXPECT_NEAR(aside, 1.0, 0.05);  // the angle to the lamp changes by 1.5 degrees: cos^4, 3 %
}

// A floor of 5 x 5 cells in even light, and close above the middle of a quarter of each cell a lamp
// that gives five times that light below itself, but 1.4 % of it at the nearest corners and
// compared points.
TEST(Refinement, FindsLampsNearAPlaneBetweenItsPoints) {
  constexpr double height = 0.05, intensity = 5.0 * height * height, tolerance = 0.1;
  constexpr double far = 1000.0;
  constexpr int across = 5;
  Scene scene;
  test::add_polygon(scene, "floor", test::add_material(scene, test::diffuse(scene.bands, 0.5f)),
                    {{0, 0, 0}, {across, 0, 0}, {across, across, 0}, {0, across, 0}});
  const auto add_lamp = [&](const Vector3d& at, double I) {
    scene.lamps.push_back({.name = "lamp" + std::to_string(scene.lamps.size()),
                           .position = at,
                           .intensity = constant_spectrum(scene.bands, static_cast<float>(I))});
  };
  add_lamp({0.5 * across, 0.5 * across, far}, far * far);
  for (int k = 0; k < across * across; ++k) {
    add_lamp({0.25 + k % across, 0.25 + k / across, height}, intensity);
  }
  const auto exact = [&](const Vector3d& at) {
    double E = 0.0;
    for (const Lamp& lamp : scene.lamps) {
      const Vector3d to = lamp.position - at;
      E += static_cast<double>(lamp.intensity[0]) * to.z() / std::pow(to.norm(), 3);
    }
    return E;
  };
  SolveOptions options = refined_to(tolerance);
  options.mesh = {.max_patch_size = 1.0, .elements_per_patch_edge = 1};
  options.refine.max_level = 6;  // edges of 1.6 cm
  const Lit lit(scene, options);
  double squares = 0.0, sum = 0.0;
  constexpr int n = 400;  // four points within the height of a lamp
  for (int i = 0; i < n * n; ++i) {
    const Vector3d at(across * (i % n + 0.5) / n, across * (i / n + 0.5) / n, 0);
    squares += std::pow(lit.irradiance(at) - exact(at), 2);
    sum += exact(at);
  }
  const double error = std::sqrt(squares / (n * n)) / (sum / (n * n));
  std::printf("%d lamps 5 cm above a floor: error %.4f, %d elements\n", across * across, error,
              lit.solved.mesh.element_count());
  // The bound is that of ReachesTheToleranceAndKnowsItsError. Peaks that no point sees are an error
  // of 5 sqrt(pi height^2 / 2), 0.31.
  EXPECT_LT(error, 1.5 * tolerance);
}

// A screen whose shadow ends at x = 0, in the middle of cells. On that line light is the mean of
// the corners' light, and the other compared points have the light of corners.
TEST(Refinement, FindsAShadowThatEndsInTheMiddle) {
  // The lamp is so far away that light is even but for the shadow.
  const Loop lamp = lamp_loop({0, 0, 20}, 0.05);
  Scene scene = lit_floor({-1, -1}, {1, 1}, lamp);
  test::add_polygon(scene, "screen", add_black(scene),
                    {{-3, -3, 10}, {0, -3, 10}, {0, 3, 10}, {-3, 3, 10}});
  SolveOptions options = direct_alone();
  options.mesh.max_patch_size = 0.41;  // five across the floor
  const Lit lit(scene, options);
  double squares = 0.0, open = 0.0;
  constexpr int n = 64;
  for (int i = 0; i < n; ++i) {
    const Vector3d at(-0.2 + 0.4 * (i + 0.5) / n, 0.3, 0);
    // The visible share of the lamp's 0.1 m; the penumbra is as wide.
    const double seen = std::clamp(0.5 + at.x() / 0.1, 0.0, 1.0);
    const double E = point_to_polygon(at, Vector3d::UnitZ(), lamp);
    squares += std::pow(lit.irradiance(at) - seen * E, 2) / n;
    open += E / n;
  }
  const double error = std::sqrt(squares) / open;
  std::printf("across the shadow's edge %.4f off\n", error);
  // 0.7 % of the mean over the floor, which is half of the open floor's, all of it in this fifth.
  EXPECT_LT(error, 0.007 * 0.5 * std::sqrt(5.0));
}

TEST(MostElements, AreNeverExceeded) {
  const Scene scene = lit_floor({-1, -1}, {1, 1}, small_lamp());
  const int first = build_patches(scene, {.to_be_refined = true}).element_count();
  for (const int more : {0, 1, 3, 10, 100, 1234}) {
    SolveOptions options = refined_to(1e-4);
    options.refine.max_elements = first + more;
    SolveReport report;
    const SolvedScene solved = solve_scene(scene, options, &report);
    EXPECT_LE(solved.mesh.element_count(), first + more);
    EXPECT_EQ(solved.mesh.element_count(), report.refinement.elements);
    EXPECT_EQ(report.refinement.outcome, RefineOutcome::max_elements_reached);
    // One more split adds 3 elements and closes up to four neighbours, 2 each, on both sides.
    EXPECT_GE(solved.mesh.element_count(), first + more - 2 * 11);
  }
}

// The limit by memory does not refuse a start with more elements.
TEST(MostElements, AreThoseThatThereIsRoomFor) {
  const Scene scene = lit_floor({-1, -1}, {1, 1}, small_lamp());
  const int first = build_patches(scene, {.to_be_refined = true}).element_count();
  for (const int more : {-first, 0, 100, 1234}) {
    SolveOptions options = refined_to(1e-4);
    options.refine.room = first + more;
    SolveReport report;
    const SolvedScene solved = solve_scene(scene, options, &report);
    EXPECT_LE(solved.mesh.element_count(), first + std::max(more, 0));
    EXPECT_EQ(report.refinement.outcome, RefineOutcome::memory_limit_reached);
    EXPECT_TRUE(says(sentence(report.refinement), "that '--memory' has room for"));
  }
  SolveOptions options = refined_to(1e-4);
  options.refine.max_elements = first + 100;
  options.refine.room = first + 1000;
  SolveReport report;
  solve_scene(scene, options, &report);
  EXPECT_EQ(report.refinement.outcome, RefineOutcome::max_elements_reached);
}

TEST(MostElements, BelowThoseOfTheSceneAreRefused) {
  SolveOptions options = refined_to(0.01);
  options.refine.max_elements = 7;
  try {
    solve_scene(lit_floor({-1, -1}, {1, 1}, small_lamp()), options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("at most 7 elements are allowed"), std::string::npos)
        << error.what();
  }
}

TEST(Refinement, IsTheSameOnAnyNumberOfThreadsAndInUnitsOfPowersOfTwo) {
  const auto solve = [](int threads, double scale) {
    const ThreadLimit limit(threads);
    Scene scene = lit_floor({-1, -1}, {1, 1}, small_lamp());
    test::add_box(scene, {0.2, 0.3, 0}, {0.5, 0.5, 0.4}, {0, 0, 0, 0, 0, 0}, true);
    for (Surface& surface : scene.surfaces) {
      for (Vector3d& v : std::get<PolygonMesh>(surface.shape).vertices) v *= scale;
    }
    return solve_scene(scene, {.gather = {.rays = 64}, .error_points = 0});
  };
  const SolvedScene one = solve(1, 1.0);
  for (const SolvedScene& other :
       {solve(2, 1.0), solve(3, 1.0), solve(4, 1.0), solve(5, 1.0), solve(2, 1024.0)}) {
    EXPECT_EQ(one.mesh.corners, other.mesh.corners);
    ASSERT_EQ(one.solution.irradiance().rows(), other.solution.irradiance().rows());
    EXPECT_TRUE((one.solution.irradiance() == other.solution.irradiance()).all());
    EXPECT_TRUE((one.solution.interpolation_error == other.solution.interpolation_error).all());
  }
  // Rounding may change single rays, and so the splits of single cells.
  for (const double scale : {1e-3, 1e3}) {
    const SolvedScene other = solve(2, scale);
    EXPECT_NEAR(other.mesh.element_count(), one.mesh.element_count(),
                0.03 * one.mesh.element_count());
    EXPECT_NEAR(other.solution.irradiance().mean(), one.solution.irradiance().mean(),
                0.01 * one.solution.irradiance().mean());
  }
}

TEST(Refinement, LeavesAnEvenlyLitRoomAlone) {
  const Scene scene = test::furnace(0.5f, 1.0f, false);
  SolveReport report;
  const SolvedScene solved = solve_scene(scene, {.error_points = 0}, &report);
  EXPECT_EQ(report.refinement.rounds, 0);
  EXPECT_EQ(solved.mesh.element_count(),
            build_patches(scene, {.to_be_refined = true}).element_count());
  EXPECT_LT(solved.solution.interpolation_error.maxCoeff(), 0.05f + 1e-3f);
}

TEST(Refinement, StopsWhenAsked) {
  SolveOptions options;
  options.run.progress = [](std::string_view phase, double) { return phase != "refine"; };
  EXPECT_THROW(solve_scene(lit_floor({-1, -1}, {1, 1}, small_lamp()), options), Interrupted);
}

// A lamp over a mirror. Caustics of a refined mesh are those of elements of even size at their
// vertices, and means of those elsewhere.
TEST(Refinement, CarriesCausticsToItsVertices) {
  Scene scene;
  const int white = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const int mirror = test::add_material(scene, test::mirror(scene.bands, 0.9f));
  const int light = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 10.0f));
  test::add_box(scene, {-1, -1, 0}, {1, 1, 1.5}, {white, white, white, white, white, white}, true);
  test::add_polygon(scene, "mirror", mirror,
                    {{0.2, -0.3, 0.2}, {0.6, -0.3, 0.5}, {0.6, 0.3, 0.5}, {0.2, 0.3, 0.2}});
  test::add_polygon(scene, "lamp", light, lamp_loop({0, 0, 1.4}, 0.1));
  SolveOptions options{.gather = {.rays = 64}, .error_points = 0};
  const BandArray refined = solve_scene(scene, options).solution.caustic_irradiance;
  options.refine.tolerance = 0.0;
  const BandArray even = solve_scene(scene, options).solution.caustic_irradiance;
  ASSERT_GT(even.size(), 0);
  ASSERT_GT(refined.size(), 0);
  EXPECT_NEAR(refined.maxCoeff(), even.maxCoeff(), 0.15f * even.maxCoeff());
  EXPECT_GE(refined.minCoeff(), 0.0f);
}

// A mirror of a square centimetre, high over the floor, causes a search for caustics, which must
// not change the floor's elements.
TEST(Refinement, IsNotMisledByTheSearchForCaustics) {
  const auto elements = [](bool with_mirror) {
    Scene scene = lit_floor({-1, -1}, {1, 1}, small_lamp());
    if (with_mirror) {
      const int silver = test::add_material(scene, test::mirror(scene.bands, 0.9f));
      test::add_polygon(scene, "mirror", silver, lamp_loop({0.9, 0.9, 1.0}, 0.005));
    }
    return solve_scene(scene, refined_to(0.002)).mesh.element_count();
  };
  const int without = elements(false);
  EXPECT_NEAR(elements(true), without, 0.05 * without);
}

}  // namespace
}  // namespace lightwell::refine_solution_test
