// Solves that end early, and solves in limited time. The clocks are the tests' own.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/solution/relight.h"
#include "radiosity/solve.h"
#include "scene/sampling.h"
#include "tests/radiosity/two_lamps.h"

namespace lightwell::time_limit_test {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

// Irradiance at points spread over the patches of `where`, points x bands.
BandArray irradiance_at_points(const SolvedScene& solved, const PatchMesh& where) {
  constexpr int count = 512;
  const ElementCaster caster(solved.mesh);
  const BandArray E = solved.solution.irradiance();
  BandArray found(count, E.cols());
  const SobolPoints sobol(count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Array4f u = sobol.point(i, 7);
    const int patch = std::min(static_cast<int>(u[0] * static_cast<float>(where.patch_count())),
                               where.patch_count() - 1);
    const PatchPoint at = PatchSampler(where, patch).point(u[1], u[2]);
    const Ray down{.origin = at.position + 1e-4 * at.normal, .direction = -at.normal};
    ElementHit hit;
    caster.closest_hits({&down, 1}, {&hit, 1});
    found.row(i).setZero();
    if (hit.element >= 0) found.row(i) = interpolate(solved.mesh, E, hit).transpose();
  }
  return found;
}

// RMS difference of two solutions over the points, relative to the mean of the second.
double difference(const SolvedScene& a, const SolvedScene& b) {
  const BandArray truth = irradiance_at_points(b, b.mesh);
  const BandArray off = irradiance_at_points(a, b.mesh) - truth;
  return std::sqrt(off.cast<double>().square().mean()) / truth.cast<double>().mean();
}

// A run whose time is up once a phase has come so far.
class UpDuring {
 public:
  UpDuring(std::string phase, double share) : phase_(std::move(phase)), share_(share) {}

  RunControl run() {
    return {.progress =
                [this](std::string_view phase, double share) {
                  is_up_ = is_up_ || (phase == phase_ && share >= share_);
                  return true;
                },
            .seconds_left = [this] { return is_up_ ? 0.0 : endless; }};
  }
  bool has_come() const { return is_up_; }

 private:
  std::string phase_;
  double share_;
  bool is_up_ = false;
};

struct EarlyEnd {
  const char* phase;
  double share;
  bool is_accurate = false, is_progressive = false, has_channels = false;
};

std::string name_of(const testing::TestParamInfo<EarlyEnd>& info) {
  std::string name = info.param.phase;
  std::erase(name, ' ');
  if (info.param.share > 0.5) name += "Later";
  if (info.param.is_accurate) name += "WithAccuracy";
  if (info.param.is_progressive) name += "Progressive";
  if (info.param.has_channels) name += "WithChannels";
  return name;
}

class Early : public testing::TestWithParam<EarlyEnd> {};

TEST_P(Early, EndGivesASolutionWithAnErrorThatHolds) {
  const EarlyEnd& end = GetParam();
  const Scene scene = test::two_lamps();
  SolveOptions options;
  options.mesh.max_patch_size = 0.35;
  if (end.is_accurate) options.accuracy = Accuracy{.share = 0.02};
  if (end.is_progressive) options.progressive.emplace();
  if (end.has_channels) options.channels = channels_per_luminaire(scene);
  const SolvedScene whole = solve_scene(scene, options);
  EXPECT_EQ(whole.solution.outcome, Outcome::converged);

  UpDuring clock(end.phase, end.share);
  options.run = clock.run();
  const SolvedScene early = solve_scene(scene, options);
  ASSERT_TRUE(clock.has_come()) << "the phase has another name";
  EXPECT_EQ(early.solution.outcome, Outcome::cut_short);
  EXPECT_TRUE(early.solution.irradiance().allFinite());
  EXPECT_EQ(early.solution.irradiance().rows(), early.mesh.vertex_count());
  EXPECT_EQ(early.solution.interpolation_error.size(), early.mesh.element_count());
  EXPECT_EQ(early.solution.gather_noise.size(), early.mesh.element_count());

  const double off = difference(early, whole);
  std::printf("ended during %s: off by %.1f %%, %.1f %% estimated\n", end.phase, 100.0 * off,
              100.0 * early.solution.error_estimate);
  EXPECT_GT(off, 0.0);
  EXPECT_GT(early.solution.error_estimate, whole.solution.error_estimate);
  // The estimate is a deviation over area, and relative to the light of each point where that is
  // more than the mean; the points here are spread evenly over patches.
  EXPECT_LT(off, 3.0 * early.solution.error_estimate);
  // Half of the error that the mean light, everywhere the same, would have.
  const BandArray truth = irradiance_at_points(whole, whole.mesh);
  const BandArray apart = truth.rowwise() - truth.colwise().mean();
  const double spread =
      std::sqrt(apart.cast<double>().square().mean()) / truth.cast<double>().mean();
  EXPECT_LT(early.solution.error_estimate, 0.5 * spread);
}

INSTANTIATE_TEST_SUITE_P(During, Early,
                         testing::Values(EarlyEnd{"form factors", 0.2}, EarlyEnd{"solve", 0.0},
                                         EarlyEnd{"refine", 0.1}, EarlyEnd{"gather", 0.1},
                                         EarlyEnd{"gather", 0.6}, EarlyEnd{"refine", 0.1, true},
                                         EarlyEnd{"gather", 0.1, true},
                                         EarlyEnd{"solve", 0.1, false, true},
                                         EarlyEnd{"refine", 0.1, false, false, true},
                                         EarlyEnd{"gather", 0.1, false, false, true}),
                         name_of);

TEST(TimeLimit, LightOfChannelsAddsUpAfterAnEarlyEnd) {
  const Scene scene = test::two_lamps();
  SolveOptions options;
  options.mesh.max_patch_size = 0.35;
  options.channels = channels_per_luminaire(scene);
  for (const char* phase : {"refine", "gather"}) {
    UpDuring clock(phase, 0.1);
    options.run = clock.run();
    SolvedScene solved = solve_scene(scene, options);
    const BandArray before = solved.solution.indirect_irradiance;
    relight(solved, std::vector<Spectrum>(solved.solution.channels.size(), Spectrum::Ones(3)));
    EXPECT_LT((solved.solution.indirect_irradiance - before).abs().maxCoeff(),
              1e-5f * before.maxCoeff());
  }
}

// No gather reads the light on a mirror, so the pilot gather leaves it out.
TEST(TimeLimit, AMirrorIsLitAfterAnEarlyEnd) {
  const Scene scene = test::two_lamps({.with_mirror = true});
  SolveOptions options;
  options.mesh.max_patch_size = 0.35;
  const SolvedScene whole = solve_scene(scene, options);
  UpDuring clock("gather", 0.1);
  options.run = clock.run();
  const SolvedScene early = solve_scene(scene, options);
  ASSERT_EQ(early.solution.outcome, Outcome::cut_short);
  const auto mean_on_mirror = [&](const SolvedScene& solved) {
    const Eigen::ArrayXXd of_patch =
        patch_integral(solved.mesh, solved.solution.indirect_irradiance);
    double light = 0.0, area = 0.0;
    for (int p = 0; p < solved.mesh.patch_count(); ++p) {
      if (!scene.materials[solved.mesh.material[p]].is_specular()) continue;
      light += of_patch.row(p).mean();
      area += solved.mesh.area[p];
    }
    return light / area;
  };
  ASSERT_GT(mean_on_mirror(whole), 0.0);
  // A patch's 16 rays leave 1/sqrt(16) of the spread of light among rays, at most the mean light;
  // the patches of the wall, 48 and more, average that to 4 %, of which four deviations are
  // allowed.
  EXPECT_NEAR(mean_on_mirror(early) / mean_on_mirror(whole), 1.0, 4.0 / std::sqrt(48.0 * 16.0));
}

TEST(TimeLimit, AStageForEachErrorUntilTheAccuracy) {
  const Scene scene = test::two_lamps();
  SolveOptions options;
  options.mesh.max_patch_size = 0.35;
  options.accuracy = Accuracy{.share = 0.04};
  // So much time that every stage fits.
  options.run.seconds_left = [] { return 1e6; };
  SolveReport report;
  const SolvedScene solved = solve_scene(scene, options, &report);
  EXPECT_EQ(solved.solution.outcome, Outcome::converged);
  EXPECT_LE(solved.solution.error_estimate, 0.04);
  EXPECT_EQ(report.accuracy, 0.04);

  // The last stage is the solve for the accuracy.
  options.run.seconds_left = {};
  const SolvedScene unlimited = solve_scene(scene, options);
  EXPECT_EQ(solved.solution.error_estimate, unlimited.solution.error_estimate);
  EXPECT_TRUE((solved.solution.irradiance() == unlimited.solution.irradiance()).all());
}

TEST(TimeLimit, AsMuchTimeAsOneStageTakesGivesOneStage) {
  const Scene scene = test::two_lamps();
  SolveOptions options;
  options.mesh.max_patch_size = 0.35;
  // The clock stands still at a time that is less than any stage takes.
  options.run.seconds_left = [] { return 1e-6; };
  SolveReport report;
  const SolvedScene solved = solve_scene(scene, options, &report);
  EXPECT_EQ(solved.solution.outcome, Outcome::cut_short);
  EXPECT_EQ(report.accuracy, 0.0);
  options.accuracy = Accuracy{.share = 0.001};
  EXPECT_EQ(solve_scene(scene, options).solution.outcome, Outcome::cut_short);
}

}  // namespace
}  // namespace lightwell::time_limit_test
