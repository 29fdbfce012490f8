#include "radiosity/accuracy.h"
#include "radiosity/refine/effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "mesh/build_patches.h"
#include "mesh/patches/patch_sampler.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/error_estimate.h"
#include "radiosity/gather/gatherable_radiosity.h"
#include "radiosity/refine/error_reference.h"
#include "radiosity/solve.h"
#include "scene/errors.h"
#include "scene/sampling.h"
#include "tests/radiosity/two_lamps.h"

namespace lightwell::accuracy_test {
namespace {

SolveOptions quick() {
  SolveOptions options;
  options.mesh.max_patch_size = 0.35;
  return options;
}

// Irradiance that `solved` interpolates at points spread uniformly over the area of `where`: points
// x bands. `elements`, if given, gets the element of `solved` at each point.
BandArray irradiance_at_points(const SolvedScene& solved, const PatchMesh& where, int count,
                               std::vector<int>* elements = nullptr) {
  const ElementCaster caster(solved.mesh), hidden(where);
  std::vector<int> patches;
  double area = 0.0;
  for (int p = 0; p < where.patch_count(); ++p) {
    if (hidden.hidden_elements(p) > 0) continue;
    patches.push_back(p);
    area += where.area[p];
  }
  const BandArray E = solved.solution.irradiance();
  BandArray found(count, E.cols());
  const SobolPoints sobol(count);
  std::size_t at = 0;
  double passed = 0.0;
  for (int i = 0; i < count; ++i) {
    while (at + 1 < patches.size() && passed + where.area[patches[at]] < (i + 0.5) / count * area) {
      passed += where.area[patches[at++]];
    }
    const Eigen::Array4f u = sobol.point(i, 77);
    const PatchPoint sample = PatchSampler(where, patches[at]).point(u[0], u[1]);
    const Ray down{.origin = sample.position + 1e-4 * sample.normal, .direction = -sample.normal};
    ElementHit hit;
    caster.closest_hits({&down, 1}, {&hit, 1});
    found.row(i) = interpolate(solved.mesh, E, hit).transpose();
    if (elements) elements->push_back(hit.element);
  }
  return found;
}

// A refinement tolerance of 0 asks for elements of even size.
constexpr double unrefined = 0.0;

// A nearly exact solution of two_lamps(). Its many elements have the same size, so that its errors
// lie elsewhere than those of refinement.
const SolvedScene& known_light() {
  static const SolvedScene truth = [] {
    SolveOptions exact = quick();
    exact.mesh.elements_per_patch_edge = 6;
    exact.refine.tolerance = unrefined;
    exact.gather.rays = 4096;
    exact.gather.shadows = {.min_rays = 128, .max_rays = 256};
    return solve_scene(test::two_lamps(), exact);
  }();
  return truth;
}

constexpr int points = 4096;

// Bounds hold with odds of 19 to 1, whether refinement or the error estimate found them.
TEST(Accuracy, BoundsOfElementsHold) {
  const SolvedScene& truth = known_light();
  const BandArray E = irradiance_at_points(truth, truth.mesh, points);
  const double mean = E.cast<double>().mean();
  for (const double tolerance : {0.02, unrefined}) {
    SolveOptions options = quick();
    options.refine.tolerance = tolerance;
    const SolvedScene solved = solve_scene(test::two_lamps(), options);
    const Eigen::ArrayXf bound = error_bound(solved.solution);
    ASSERT_EQ(bound.size(), solved.mesh.element_count());
    std::vector<int> element;
    const BandArray found = irradiance_at_points(solved, truth.mesh, points, &element);
    int held = 0;
    double off = 0.0, estimated = 0.0;
    for (int i = 0; i < points; ++i) {
      const double own = E.row(i).cast<double>().mean(), reference = std::max(mean, own / 4);
      const double error = std::abs(found.row(i).cast<double>().mean() - own) / reference;
      held += error <= bound[element[i]] ? 1 : 0;
      off += error * error / points;
      estimated += std::pow(bound[element[i]] / 2.0, 2) / points;
    }
    std::printf("refined to %.2f: %.1f %% within their bounds, RMS %.4f, estimated %.4f\n",
                tolerance, 100.0 * held / points, std::sqrt(off), std::sqrt(estimated));
    EXPECT_GE(held, 0.95 * points);
    // The error of the reference solution is part of the error seen here.
    EXPECT_LE(std::sqrt(estimated), 5.0 * std::sqrt(off));
  }
}

TEST(Accuracy, IsKept) {
  const Scene scene = test::two_lamps();
  const SolvedScene& truth = known_light();
  const BandArray E = irradiance_at_points(truth, truth.mesh, points);
  for (const double share : {0.05, 0.02}) {
    SolveOptions options = quick();
    options.accuracy = Accuracy{.share = share};
    SolveReport report;
    const SolvedScene solved = solve_scene(scene, options, &report);
    EXPECT_TRUE(solved.solution.gather_noise.isFinite().all());
    const BandArray off = irradiance_at_points(solved, truth.mesh, points) - E;
    const double error = std::sqrt(off.cast<double>().square().mean()) / E.cast<double>().mean();
    std::printf("asked for %.3f: estimated %.4f, off by %.4f; %d elements, %d rays\n", share,
                solved.solution.error_estimate, error, solved.mesh.element_count(),
                report.gather_rays);
    EXPECT_EQ(solved.solution.outcome, Outcome::converged);
    EXPECT_LE(solved.solution.error_estimate, share);
    EXPECT_DOUBLE_EQ(report.accuracy, share);
    // Most of the error of 512 sample points is in the tenth that shadows' edges cross, so its RMS
    // is known to 1 / sqrt(2 * 51) = 10 %, twice that at worst. The error of the reference solution
    // comes on top.
    EXPECT_LE(error, 1.2 * share + truth.solution.error_estimate / 2);
    // An estimate that is far too high would waste work: at most five times the error.
    EXPECT_LE(solved.solution.error_estimate, 5.0 * error);
  }
}

// Elements that are cut along shadows, or short already, are split as well, unless refinement is
// off.
TEST(Accuracy, SplitsWhateverElementsStartAs) {
  const auto refinement = [](const auto& change) {
    SolveOptions options = quick();
    options.accuracy = Accuracy{.share = 0.03};
    change(options);
    SolveReport report;
    const SolvedScene solved = solve_scene(test::two_lamps(), options, &report);
    if (report.refinement.outcome == RefineOutcome::tolerance_reached) {
      EXPECT_EQ(solved.solution.outcome, Outcome::converged);
      EXPECT_GT(report.refinement.elements, report.refinement.elements_at_first);
    }
    return report.refinement.outcome;
  };
  EXPECT_EQ(refinement([](SolveOptions& options) { options.mesh.discontinuity = true; }),
            RefineOutcome::tolerance_reached);
  EXPECT_EQ(refinement([](SolveOptions& options) { options.mesh.max_element_size = 0.3; }),
            RefineOutcome::tolerance_reached);
  EXPECT_EQ(refinement([](SolveOptions& options) { options.refine.tolerance = unrefined; }),
            RefineOutcome::off);
}

TEST(Accuracy, OutOfReachIsSaid) {
  SolveOptions options = quick();
  options.accuracy = Accuracy{.share = 0.004};
  options.refine.max_elements = 500;
  const SolvedScene solved = solve_scene(test::two_lamps(), options);
  EXPECT_EQ(solved.solution.outcome, Outcome::accuracy_missed);
  EXPECT_GT(solved.solution.error_estimate, 0.004);
  EXPECT_LE(solved.mesh.element_count(), 500);
  EXPECT_TRUE((solved.solution.irradiance() >= 0.0f).all());
}

TEST(Accuracy, InLuxIsAShareOfTheMeanIlluminance) {
  Scene scene = test::two_lamps();
  SolveOptions options = quick();
  options.accuracy = Accuracy{.lux = 50.0};
  SolveReport report;
  const SolvedScene solved = solve_scene(scene, options, &report);
  const double mean = mean_illuminance(scene.bands, solved.mesh, solved.solution.patch_radiosity);
  EXPECT_NEAR(report.accuracy, 50.0 / mean, 1e-6 * report.accuracy);
  EXPECT_LE(solved.solution.error_estimate * mean, 50.0);
  scene.relative_units = true;
  EXPECT_THROW(solve_scene(scene, options), InputError);
}

// In a closed grey room of reflectance rho and exitance M, B = E = M / (1 - rho) everywhere.
TEST(Accuracy, MeanIlluminanceOfAFurnace) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f, 2.0f));
  test::add_box(scene, {0, 0, 0}, {1, 2, 3}, {grey, grey, grey, grey, grey, grey}, true);
  const PatchMesh mesh = build_patches(scene);
  const BandArray B = BandArray::Constant(mesh.patch_count(), 3, 4.0f);
  EXPECT_NEAR(mean_illuminance(scene.bands, mesh, B), 4.0 * scene.bands.lumens_per_watt, 1e-3);
}

TEST(Accuracy, EffortFollowsTheError) {
  const Effort first = first_effort(0.01, true);
  EXPECT_GT(first.refine_tolerance, 0.0);
  EXPECT_LT(first.refine_tolerance, 0.01);
  EXPECT_GT(first_effort(0.005, true).gather_rays, first.gather_rays);
  EXPECT_EQ(first_effort(0.01, false).refine_tolerance, 0.0);

  RefineReport reached{.outcome = RefineOutcome::tolerance_reached, .estimate = 0.006};
  const auto noisy = next_effort(first, 0.01, 0.02, 0.019, reached, 0);
  ASSERT_TRUE(noisy);
  EXPECT_GT(noisy->gather_rays, first.gather_rays);
  EXPECT_EQ(noisy->refine_tolerance, first.refine_tolerance);
  const auto again = next_effort(*noisy, 0.01, 0.012, 0.003, reached, 1);
  ASSERT_TRUE(again);
  EXPECT_LT(again->refine_tolerance, first.refine_tolerance);
  EXPECT_EQ(again->gather_rays, noisy->gather_rays);

  RefineReport full{.outcome = RefineOutcome::max_elements_reached, .estimate = 0.015};
  EXPECT_FALSE(next_effort(first, 0.01, 0.02, 0.013, full, 0));
  EXPECT_FALSE(next_effort(first, 0.01, 0.02, 0.013, reached, 20));
}

// The largest tolerance of elements over the error that they had, if any are split.
constexpr double smallest_step = 0.8;

// An attempt repeats much of the one before, so that even the smallest excess takes half more rays,
// or 80 % of the error that elements have, which is a quarter to a half more of them.
TEST(Accuracy, EachAttemptIsWorthItsTime) {
  const Effort first = first_effort(0.02, true);
  // Both errors together may be 95 % of 0.02. Elements have 0.012, below that, so that neither step
  // is one of a tolerance that was missed.
  RefineReport reached{.outcome = RefineOutcome::tolerance_reached, .estimate = 0.012};
  // Noise of 0.0111 where 0.011 is allowed takes 1.4 % more rays.
  const auto noisy = next_effort(first, 0.02, 0.0201, 0.0111, reached, 0);
  ASSERT_TRUE(noisy);
  EXPECT_GE(noisy->gather_rays, 1.5 * first.gather_rays);
  // 1 % more than 0.019, none of it noise. The step is from the error that elements have.
  const auto coarse = next_effort(first, 0.02, 0.0192, 0.0, reached, 0);
  ASSERT_TRUE(coarse);
  EXPECT_LE(coarse->refine_tolerance, smallest_step * reached.estimate);
}

// A few more rays and slightly smaller elements cost less than elements alone if noise takes a good
// part of the error: elements grow with the third power of the error that they have to lose.
TEST(Accuracy, NoiseAndElementsShareTheStep) {
  // A hall in daylight, as measured after its first attempt.
  constexpr double target = 0.05, error = 0.0588, noise = 0.0242, elements = 0.046;
  const Effort first = first_effort(target, true);
  RefineReport reached{.outcome = RefineOutcome::tolerance_reached, .estimate = elements};
  const auto next = next_effort(first, target, error, noise, reached, 0);
  ASSERT_TRUE(next);
  EXPECT_GT(next->gather_rays, first.gather_rays);
  // Independent errors add by their squares. An attempt aims at 95 % of the target; what neither
  // noise nor elements explain stays.
  constexpr double allowed = 0.95 * target;
  const double stays = std::sqrt(error * error - noise * noise - elements * elements);
  // The tolerance of elements that make up for the noise of the same rays: two thirds of theirs.
  const double alone = std::sqrt(allowed * allowed - stays * stays - noise * noise);
  EXPECT_GT(next->refine_tolerance, alone);
  EXPECT_LE(next->refine_tolerance, smallest_step * elements);
  const double times = static_cast<double>(next->gather_rays) / first.gather_rays;
  const double left =
      std::hypot(stays, next->refine_tolerance, noise * std::pow(times, -noise_order));
  constexpr double rounding = 1e-12;  // of some ten operations in double precision, generously
  EXPECT_LE(left, allowed * (1.0 + rounding));
}

// A step casts no more rays than any accuracy asks for, however noisy the attempt before was.
TEST(Accuracy, RaysOfAStepHaveALimit) {
  // An attempt at 0.1 % with half of all rays allowed, whose elements are good enough.
  const Effort spent{.refine_tolerance = 0.001, .gather_rays = most_gather_rays / 2};
  RefineReport reached{.outcome = RefineOutcome::tolerance_reached, .estimate = 0.001};
  // Noise alone misses the target twenty times, which takes 20^(3/2) = 89 times the rays.
  const auto next = next_effort(spent, 0.001, 0.02, 0.0199, reached, 0);
  ASSERT_TRUE(next);
  EXPECT_LE(next->gather_rays, most_gather_rays);
  // The same where elements are to be split as well.
  const auto both = next_effort(spent, 0.001, 0.0014, 0.0011, reached, 0);
  ASSERT_TRUE(both);
  EXPECT_LE(both->gather_rays, most_gather_rays);
}

// The error contains the noise of both gathers, so an estimate of the noise above it is too high.
TEST(Accuracy, NoiseIsNoMoreThanTheError) {
  const Effort first = first_effort(0.05, true);
  // Both calls get the same error of the elements: any below the target of 0.05 serves, here three
  // fifths of it.
  RefineReport reached{.outcome = RefineOutcome::tolerance_reached, .estimate = 0.03};
  const auto as_error = next_effort(first, 0.05, 0.06, 0.06, reached, 0);
  const auto beyond = next_effort(first, 0.05, 0.06, 700.0, reached, 0);
  ASSERT_TRUE(as_error && beyond);
  EXPECT_EQ(beyond->gather_rays, as_error->gather_rays);
  EXPECT_EQ(beyond->refine_tolerance, as_error->refine_tolerance);
}

// More rays do not reduce the error of interpolation if elements may not be split.
TEST(Accuracy, RaysAreNotCastWhereElementsAreTooLarge) {
  const Effort first = first_effort(0.03, false);
  EXPECT_FALSE(next_effort(first, 0.03, 0.2, 0.005, RefineReport{}, 0));
  const auto noisy = next_effort(first, 0.03, 0.045, 0.042, RefineReport{}, 0);
  ASSERT_TRUE(noisy);
  EXPECT_GT(noisy->gather_rays, first.gather_rays);
}

// Mean squared error of interpolated irradiance that consists of direct light, relative to
// error_reference(), over all that does not emit; `unbounded` gets the share of the points with a
// notable error that have no bound.
double true_error_of_direct_light(const Scene& scene, const SolvedScene& solved,
                                  double& unbounded) {
  const PatchMesh& mesh = solved.mesh;
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const BandArray E = solved.solution.irradiance();
  const Eigen::ArrayXf bound = error_bound(solved.solution);
  constexpr int each = 8;
  const SobolPoints sobol(each);
  struct Sample {
    double own, off, area;
    bool is_bounded;
  };
  std::vector<Sample> samples;
  double sum = 0.0, area = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if ((mesh.emission.row(p) > 0.0f).any() || caster.hidden_elements(p) > 0) continue;
    const auto key = static_cast<std::uint64_t>(p);
    for (int k = 0; k < each; ++k) {
      const Eigen::Array4f u = sobol.point(k, key);
      const PatchPoint at = PatchSampler(mesh, p).point(u[0], u[1]);
      const LightQuery query{.at = {at.position, at.normal, mesh.facet[at.element]},
                             .key = random_key(key, static_cast<std::uint64_t>(k)),
                             .shadows = {.min_rays = 64, .max_rays = 256}};
      const auto own = static_cast<double>(light.irradiance(caster, query).mean());
      const ElementHit hit = point_on_element(mesh, at);
      const double off = static_cast<double>(interpolate(mesh, E, hit).mean()) - own;
      samples.push_back({own, off, mesh.area[p], bound[hit.element] > 0.0f});
      sum += mesh.area[p] * own;
      area += mesh.area[p];
    }
  }
  double square = 0.0, wrong = 0.0;
  for (const auto& [own, off, weight, is_bounded] : samples) {
    const double relative = off / error_reference(sum / area, own);
    square += weight / area * relative * relative;
    if (std::abs(relative) < 0.01) continue;
    wrong += weight;
    unbounded += is_bounded ? 0.0 : weight;
  }
  unbounded /= wrong;
  return std::sqrt(square);
}

// If nothing reflects, all that does not emit is there to be measured. Elements of half a metre
// under a lamp of 20 cm are far from its light.
TEST(ErrorEstimate, KnowsTheErrorWhereNothingReflects) {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 1000.0f));
  test::add_box(scene, {0, 0, 0}, {4, 3, 2}, {black, black, black, black, black, black}, true);
  test::add_polygon(scene, "lamp", lamp,
                    {{1.9, 1.4, 1.9}, {1.9, 1.6, 1.9}, {2.1, 1.6, 1.9}, {2.1, 1.4, 1.9}});
  test::add_box(scene, {2.4, 1.2, 0.0}, {2.8, 1.8, 0.6}, {black, black, black, black, black, black},
                false);
  SolveOptions options;
  options.mesh.max_patch_size = 0.5;
  options.gather.rays = 16;
  for (const double tolerance : {unrefined, 0.02}) {
    options.refine.tolerance = tolerance;
    const SolvedScene solved = solve_scene(scene, options);
    double unbounded = 0.0;
    const double error = true_error_of_direct_light(scene, solved, unbounded);
    std::printf("black room, tolerance %.2f: estimated %.4f, off by %.4f, unbounded %.4f\n",
                tolerance, solved.solution.error_estimate, error, unbounded);
    // The estimate holds the error, within the noise of its 512 points, and is not three times as
    // large.
    EXPECT_GT(solved.solution.error_estimate, 0.7 * error);
    EXPECT_LT(solved.solution.error_estimate, 3.0 * error);
    EXPECT_LT(unbounded, 0.05);
  }
}

// Each batch has sample points of its own, and several batches together are more certain.
TEST(ErrorEstimate, BatchesJoin) {
  const Scene scene = test::two_lamps({.reflectance = 0.5f});
  const SolvedScene solved = solve_scene(scene);
  const ElementCaster caster(solved.mesh);
  const DirectLight direct_light(scene, solved.mesh);
  constexpr int batches = 8;
  std::vector<double> squares;
  ErrorEstimate all;
  double deviation = 0.0, of_mean = 0.0;
  for (int batch = 0; batch < batches; ++batch) {
    const ErrorEstimate one =
        estimate_errors({scene, caster, direct_light}, {}, solved.solution, {.batch = batch})
            .front();
    all = batch == 0 ? one : joined(all, one);
    squares.push_back(one.square);
    deviation += one.deviation / batches;
    of_mean = std::hypot(of_mean, one.deviation / batches);
  }
  EXPECT_EQ(all.batches, batches);
  double mean = 0.0, spread = 0.0;
  for (const double square : squares) mean += square / batches;
  for (const double square : squares) spread += std::pow(square - mean, 2) / (batches - 1);
  // joined() takes at most four operations for each batch, and the sums of the test take two.
  const double roundings = 6.0 * batches * std::numeric_limits<double>::epsilon();
  EXPECT_NEAR(all.square, mean, roundings * mean);
  EXPECT_NEAR(all.deviation, of_mean, roundings * of_mean);
  EXPECT_LT(all.least(), std::sqrt(mean));
  EXPECT_GT(all.error(), std::sqrt(mean));
  // Batches spread by their standard errors, or less, since sample points are stratified. The mean
  // square of seven free differences exceeds three times its expectation once in 400.
  std::printf("%.2e spread, %.2e estimated\n", std::sqrt(spread), deviation);
  EXPECT_LT(spread, 3.0 * deviation * deviation);
  EXPECT_GT(spread, 0.0);
}

// A room of two lamps that is solved with few rays.
struct RoomOfFewRays {
  Scene scene = test::two_lamps({.reflectance = 0.5f});
  SolveOptions options{.gather = {.rays = 64}};
  SolvedScene solved = solve_scene(scene, options);
  ElementCaster caster{solved.mesh};
  DirectLight direct_light{scene, solved.mesh};

  LitScene lit() const { return {scene, caster, direct_light}; }
  ErrorEstimate estimate(const EstimateTask& task) const {
    return estimate_errors(lit(), options, solved.solution, task).front();
  }
};

// Light that is found once serves all batches, with the bits of light that is found anew.
TEST(ErrorEstimate, ReadsTheLightThatItIsGiven) {
  const RoomOfFewRays room;
  const auto square_with = [&](const BandArray* radiosity) {
    return room.estimate({.radiosity = radiosity}).square;
  };
  const BandArray own = gatherable_radiosity(room.lit(), room.solved.solution);
  const BandArray twice = 2.0f * own;
  EXPECT_EQ(square_with(&own), square_with(nullptr));
  EXPECT_NE(square_with(&twice), square_with(nullptr));
}

// Further batches decide whether a target is met. Without one they would cost and decide nothing.
TEST(ErrorEstimate, IsMadeOfOneBatchWithoutATarget) {
  const RoomOfFewRays room;
  const ErrorEstimate one = room.estimate({.batch = 0});
  ErrorEstimate four = one;
  for (int batch = 1; batch < 4; ++batch) four = joined(four, room.estimate({.batch = batch}));
  const double error = room.solved.solution.error_estimate;
  EXPECT_LT(std::abs(error - one.error()), std::abs(error - four.error()));
}

// All light is 5 % too dim, as if interpolation had cut peaks off. The gathers of the estimate, in
// that light, are too dim as well, but for the part straight from the lamps.
TEST(ErrorEstimate, SeesWhatReflectionsHide) {
  const Scene scene = test::two_lamps({.reflectance = 0.9f});
  SolveOptions options;
  options.error_points = 2048;
  SolvedScene solved = solve_scene(scene, options);
  const ElementCaster caster(solved.mesh);
  const DirectLight direct_light(scene, solved.mesh);
  const auto estimate = [&] {
    return estimate_errors({scene, caster, direct_light}, options, solved.solution).front().error();
  };
  const double before = estimate();
  const PatchMesh& mesh = solved.mesh;
  const BandArray E = element_mean(mesh, solved.solution.irradiance());
  const Eigen::ArrayXd reference = error_references(mesh, solved.solution.irradiance());
  // The mean n-th power (n = 2 or 4) of light relative to error_references().
  const auto moment = [&](const BandArray& of, int n) {
    double sum = 0.0, area = 0.0;
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (!(mesh.reflectance.row(mesh.patch[e]) > 0.0f).any()) continue;
      const double square = of.row(e).cast<double>().square().mean() / std::pow(reference[e], 2);
      sum += mesh.element_area[e] * std::pow(square, n / 2);
      area += mesh.element_area[e];
    }
    return sum / area;
  };
  constexpr float missing = 0.05f;
  const double off = missing * std::sqrt(moment(E, 2));
  const double seen =
      missing * std::sqrt(moment(element_mean(mesh, solved.solution.direct_irradiance), 2));
  solved.solution.direct_irradiance *= 1.0f - missing;
  solved.solution.indirect_irradiance *= 1.0f - missing;
  const double after = std::sqrt(std::pow(estimate(), 2) - std::pow(before, 2));
  std::printf("light %.4f off, %.4f of it not hidden: %.4f estimated\n", off, seen, after);
  // A mean of squares over half of 2048 sample points has a standard error of sqrt(m4 - m2^2) / 32,
  // and its root half of that. The estimate is one standard error above the sample points' value,
  // which may be off by three.
  const double m2 = moment(E, 2), of_mean = std::sqrt(moment(E, 4) - m2 * m2) / 32.0;
  EXPECT_NEAR(after, off, 4.0 * 0.5 * of_mean / m2 * off);
}

}  // namespace
}  // namespace lightwell::accuracy_test
