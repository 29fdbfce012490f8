#include "radiosity/solution/relight.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "radiosity/gather/patch_power.h"
#include "radiosity/gather/vertex_points.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "scene/sampling.h"
#include "tests/radiosity/two_lamps.h"

namespace lightwell::relight_test {
namespace {

SolvedScene solve_by_channel(const Scene& scene, SolveOptions options = test::exact_and_even()) {
  options.channels = channels_per_luminaire(scene);
  return solve_scene(scene, options);
}

Spectrum even(float factor) {
  return Spectrum::Constant(3, factor);
}

// Relative rounding of a float is 2^-24 = 6e-8. About ten roundings follow each other from patches
// through vertices, pilot and final gather, of values no larger than the largest. Caustics add some
// hundred floats at a vertex, with ten times the rounding of one. The bound is twice that.
constexpr double rounding = 1.2e-6;
// Refined elements combine gathers with predictions of pilot gathers by weights from their
// variances. Variances are squares of differences of a percent or two, in which about four
// roundings of 6e-8 are 1e-5 to 2e-5, and twice that when squared. The excess error of a prediction
// is a small difference of several variances, accurate to 1e-4. An error of a weight acts on the
// difference between gather and prediction: a tenth of the light at most.
constexpr double weighted = 1e-5;
// The final gather aims a quarter more rays at bright patches, drawn from running sums of the
// combined light. One of 1e5 draws changes for a sum that is off by 1e-5. 5000 vertices draw 16 to
// 128 times each, so about five vertices see another sample point; four times as many are allowed
// for chance. Such a ray carries at most a 64th of the light at a vertex and may be twice as bright
// as the rest.
constexpr double redrawn = 0.004, one_ray = 0.03;
// The error estimate is the RMS of differences of a percent or more at 512 points. A difference of
// light that is known to `weighted` is known to a hundred times that, and by chance with either
// sign, so the RMS is known better by sqrt(512). Twice that is allowed.
const double of_estimate = 2.0 * 100.0 * weighted / std::sqrt(512.0);

void expect_same_light(const BandArray& a, const BandArray& b, const char* what) {
  ASSERT_EQ(a.rows(), b.rows()) << what;
  ASSERT_EQ(a.cols(), b.cols()) << what;
  if (a.size() == 0) return;
  EXPECT_LE((a - b).abs().maxCoeff(), rounding * b.abs().maxCoeff()) << what;
}

void expect_same_but_for_rays(const BandArray& a, const BandArray& b, const char* what) {
  ASSERT_EQ(a.rows(), b.rows()) << what;
  ASSERT_EQ(a.cols(), b.cols()) << what;
  const Eigen::ArrayXf off = (a - b).abs().rowwise().maxCoeff() / b.abs().maxCoeff();
  const auto count = (off > static_cast<float>(weighted)).count();
  std::printf("%s: %ld of %ld vertices differ, by up to %.2g\n", what, static_cast<long>(count),
              static_cast<long>(off.size()), double{off.maxCoeff()});
  EXPECT_LE(static_cast<double>(count), redrawn * static_cast<double>(off.size())) << what;
  EXPECT_LE(off.maxCoeff(), one_ray) << what;
}

void expect_same_light(const SolvedScene& a, const SolvedScene& b) {
  ASSERT_EQ(a.mesh.element_count(), b.mesh.element_count());
  EXPECT_EQ(a.mesh.corners, b.mesh.corners);
  const RadiositySolution &s = a.solution, &t = b.solution;
  expect_same_light(a.mesh.emission, b.mesh.emission, "emission");
  expect_same_light(s.patch_radiosity, t.patch_radiosity, "patch radiosity");
  expect_same_light(s.direct_irradiance, t.direct_irradiance, "direct");
  if (t.provenance.refinement.empty()) {
    expect_same_light(s.indirect_irradiance, t.indirect_irradiance, "indirect");
  } else {
    expect_same_but_for_rays(s.indirect_irradiance, t.indirect_irradiance, "indirect");
  }
  expect_same_light(s.caustic_irradiance, t.caustic_irradiance, "caustic");
  EXPECT_NEAR(s.energy.emitted / t.energy.emitted, 1.0, rounding);
  EXPECT_NEAR(s.energy.absorbed / t.energy.absorbed, 1.0, rounding);
  EXPECT_NEAR(s.error_estimate, t.error_estimate, of_estimate * t.error_estimate);
}

// Refined elements read light with the power that the patches' equations balanced, of each channel
// or of the sum. Both undo what interpolation loses, which refinement holds below its tolerance: so
// light at a vertex differs by no more, and so does the error estimate, which compares two readings
// of that light. The power of the sum is the same; of light that is moved by this share the 64 rays
// at a vertex miss no more than their noise, an eighth.
constexpr double refinement = 0.02, of_power = refinement / 8.0;

void expect_same_power(const SolvedScene& a, const SolvedScene& b) {
  ASSERT_EQ(a.mesh.vertex_count(), b.mesh.vertex_count());
  const BandArray &E = a.solution.indirect_irradiance, &expected = b.solution.indirect_irradiance;
  const double off = double{(E - expected).abs().maxCoeff() / expected.abs().maxCoeff()};
  std::printf("light of channels that differ adds up to within %.2g at vertices\n", off);
  EXPECT_LE(off, refinement);
  const Eigen::ArrayXd power = patch_integral(a.mesh, E).colwise().sum();
  const Eigen::ArrayXd of_expected = patch_integral(b.mesh, expected).colwise().sum();
  EXPECT_LE((power / of_expected - 1.0).abs().maxCoeff(), of_power);
  EXPECT_NEAR(a.solution.error_estimate, b.solution.error_estimate,
              refinement * b.solution.error_estimate);
  expect_same_light(a.solution.patch_radiosity, b.solution.patch_radiosity, "patches");
  expect_same_light(a.solution.direct_irradiance, b.solution.direct_irradiance, "direct");
  expect_same_light(a.solution.caustic_irradiance, b.solution.caustic_irradiance, "caustic");
  EXPECT_NEAR(a.solution.energy.emitted / b.solution.energy.emitted, 1.0, rounding);
  EXPECT_NEAR(a.solution.energy.absorbed / b.solution.energy.absorbed, 1.0, rounding);
}

struct Room {
  const char* name;
  test::TwoLamps is;
  bool refined;
};

std::ostream& operator<<(std::ostream& out, const Room& room) {
  return out << room.name;
}

class ChannelsOf : public testing::TestWithParam<Room> {};

TEST_P(ChannelsOf, AddUpToTheSolutionWithoutThem) {
  const Scene scene = test::two_lamps(GetParam().is);
  SolveOptions options = test::exact_and_even();
  if (GetParam().refined) options.refine.tolerance = refinement;
  const SolvedScene plain = solve_scene(scene, options);
  const SolvedScene apart = solve_by_channel(scene, options);
  EXPECT_TRUE(plain.solution.channels.empty());
  ASSERT_GE(apart.solution.channels.size(), 2u);
  EXPECT_EQ(plain.solution.interpolation_error.size(), plain.mesh.element_count());
  if (GetParam().refined) {
    expect_same_power(apart, plain);
  } else {
    expect_same_light(apart, plain);
  }
}

// Light in columns of its own beside those of a dark channel is that of a solve without channels.
TEST_P(ChannelsOf, IsTheSolutionIfOneHasAllLight) {
  const Scene scene = test::two_lamps(GetParam().is);
  SolveOptions options = test::exact_and_even();
  if (GetParam().refined) options.refine.tolerance = refinement;
  const SolvedScene plain = solve_scene(scene, options);
  options.channels = channels_per_luminaire(scene);
  for (int& channel : options.channels.of_surface) channel = std::min(channel, 0);
  const SolvedScene apart = solve_scene(scene, options);
  ASSERT_GE(apart.solution.channels.size(), 2u);
  expect_same_light(apart, plain);
}

const test::TwoLamps with_wall{.wall = 3.0f};
const test::TwoLamps with_mirror{.with_mirror = true};
const test::TwoLamps with_glass{.with_glass = true};
INSTANTIATE_TEST_SUITE_P(Rooms, ChannelsOf,
                         testing::Values(Room{"even", {}, false}, Room{"refined", {}, true},
                                         Room{"wall", with_wall, false},
                                         Room{"mirror", with_mirror, false},
                                         Room{"glass", with_glass, true}));

TEST(Relight, EqualsASolveWithThatEmission) {
  test::TwoLamps is{.with_mirror = true, .with_block = false};
  SolvedScene relit = solve_by_channel(test::two_lamps(is));
  const Spectrum warm = (Spectrum(3) << 1.4f, 0.9f, 0.3f).finished();
  relight(relit, std::vector<Spectrum>{even(0.3f), warm});
  is.desk *= 0.3f;
  is.panel *= warm;
  expect_same_light(relit, [&] {
    SolvedScene fresh = solve_scene(test::two_lamps(is), test::exact_and_even());
    fresh.solution.error_estimate = relit.solution.error_estimate;  // unchanged by relight()
    return fresh;
  }());
}

// Irradiance where `count` rays from the middle of the room end.
BandArray seen(const SolvedScene& solved, int count) {
  const ElementCaster caster(solved.mesh);
  const BandArray E = solved.solution.irradiance();
  BandArray values(count, E.cols());
  for (int i = 0; i < count; ++i) {
    const auto key = static_cast<std::uint64_t>(i);
    const double z = 2.0 * random_uniform(random_key(key, 1)) - 1.0;
    const double phi = 2.0 * M_PI * random_uniform(random_key(key, 2)), r = std::sqrt(1 - z * z);
    const Ray ray{.origin = {1.5, 1.0, 1.3},
                  .direction = {r * std::cos(phi), r * std::sin(phi), z}};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    values.row(i) = interpolate(solved.mesh, E, hit).transpose();
  }
  return values;
}

TEST(Relight, EqualsASolveWithThatEmissionWithinTheErrorOfBothWhereElementsDiffer) {
  SolveOptions options = test::exact_and_even();
  options.refine.tolerance = 0.02;
  options.gather.rays = 256;
  options.gather.shadows = {.min_rays = 16, .max_rays = 64};
  test::TwoLamps is;
  SolvedScene relit = solve_by_channel(test::two_lamps(is), options);
  relight(relit, std::vector<Spectrum>{even(0.1f), even(1.5f)});
  is.desk *= 0.1f;
  is.panel *= 1.5f;
  const SolvedScene fresh = solve_scene(test::two_lamps(is), options);
  const BandArray a = seen(relit, 4000), b = seen(fresh, 4000);
  const double mean = b.cast<double>().mean();
  const double rms = std::sqrt((a - b).cast<double>().square().mean()) / mean;
  std::printf(
      "relit and solved differ by %.2f %%; their errors are estimated at %.2f %%, %.2f %%\n",
      100 * rms, 100 * relit.solution.error_estimate, 100 * fresh.solution.error_estimate);
  EXPECT_LT(rms, std::hypot(relit.solution.error_estimate, fresh.solution.error_estimate));
}

TEST(Relight, ScalesAreAgainstTheSceneAsItWasSolved) {
  const SolvedScene solved = solve_by_channel(test::two_lamps());
  SolvedScene relit = solved;
  relight(relit, std::vector<Spectrum>{even(0.0f), even(0.37f)});
  EXPECT_EQ(relit.solution.channels[0].scale[1], 0.0f);
  EXPECT_LT(relit.solution.irradiance().sum(), 0.4f * solved.solution.irradiance().sum());
  relight(relit, std::vector<Spectrum>{even(1.0f), even(1.0f)});
  EXPECT_TRUE((relit.mesh.emission == solved.mesh.emission).all());
  EXPECT_TRUE((relit.solution.patch_radiosity == solved.solution.patch_radiosity).all());
  EXPECT_TRUE((relit.solution.direct_irradiance == solved.solution.direct_irradiance).all());
  EXPECT_TRUE((relit.solution.indirect_irradiance == solved.solution.indirect_irradiance).all());
  EXPECT_EQ(relit.solution.energy.absorbed, solved.solution.energy.absorbed);
}

TEST(Relight, GivesTheSameBitsOnAnyNumberOfThreads) {
  const SolvedScene solved = solve_by_channel(test::two_lamps());
  const std::vector<Spectrum> scales = {even(0.7f), even(1.3f)};
  SolvedScene one = solved, three = solved;
  {
    const ThreadLimit limit(1);
    relight(one, scales);
  }
  {
    const ThreadLimit limit(3);
    relight(three, scales);
  }
  EXPECT_TRUE((one.solution.indirect_irradiance == three.solution.indirect_irradiance).all());
  EXPECT_TRUE((one.solution.direct_irradiance == three.solution.direct_irradiance).all());
}

TEST(Relight, EnergyIsThatOfTheEmissionInForce) {
  SolvedScene relit = solve_by_channel(test::two_lamps());
  relight(relit, std::vector<Spectrum>{even(2.0f), even(0.25f)});
  const EnergyBalance& e = relit.solution.energy;
  const double emitted =
      (relit.mesh.emission.cast<double>().colwise() * relit.mesh.area).sum();  // sum of A M
  EXPECT_NEAR(e.emitted / emitted, 1.0, rounding);
  EXPECT_NEAR(emitted, 2.0 * 3 * 40.0 * 0.04 + 0.25 * 44.0 * 0.4, 1e-5 * emitted);
  EXPECT_NEAR((e.absorbed + e.escaped + e.unshot) / e.emitted, 1.0, 1e-5);
}

// A luminous wall is no emitter of DirectLight beside brighter lamps, but would be its first
// emitter with the lamps off. The division into direct and indirect light must remain that of the
// solve.
TEST(Relight, DirectLightTracedAfreshIsThatOfTheFileWhateverIsOff) {
  const Scene scene = test::two_lamps({.wall = 3.0f});
  SolvedScene relit = solve_by_channel(scene);
  std::vector<Spectrum> scales(relit.solution.channels.size(), even(1.0f));
  for (const char* name : {"desk", "panel"}) {
    scales[static_cast<std::size_t>(find_channel(relit.solution, name))] = even(0.0f);
    relight(relit, scales);
    const DirectLight direct_light(scene, relit.mesh);
    const BandArray traced =
        gather_direct({scene, ElementCaster(relit.mesh), direct_light},
                      vertex_gather_points(relit.mesh), test::exact_and_even().gather);
    expect_same_light(traced, relit.solution.direct_irradiance, name);
  }
  EXPECT_EQ(relit.solution.direct_irradiance.abs().maxCoeff(), 0.0f) << "only the wall is on";
  EXPECT_GT(relit.solution.indirect_irradiance.mean(), 0.1f);
}

TEST(Relight, NeedsAScaleForEveryChannel) {
  SolvedScene solved = solve_by_channel(test::two_lamps());
  const float nan = std::nanf("");
  EXPECT_THROW(relight(solved, std::vector<Spectrum>{even(1.0f)}), std::invalid_argument);
  EXPECT_THROW(relight(solved, std::vector<Spectrum>{even(1.0f), even(-1.0f)}),
               std::invalid_argument);
  EXPECT_THROW(relight(solved, std::vector<Spectrum>{even(1.0f), even(nan)}),
               std::invalid_argument);
}

TEST(Relight, ChannelsAreFoundByName) {
  const SolvedScene solved = solve_by_channel(test::two_lamps());
  EXPECT_EQ(find_channel(solved.solution, "panel"), 1);
  try {
    find_channel(solved.solution, "pannel");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("Did you mean 'panel'?"), std::string::npos);
  }
  EXPECT_THROW(find_channel(RadiositySolution{}, "panel"), InputError);
}

TEST(Channels, ProgressiveRefinementKeepsThemApart) {
  const Scene scene = test::two_lamps();
  SolveOptions options = test::exact_and_even();
  options.progressive.emplace();
  options.channels = channels_per_luminaire(scene);
  const RadiositySolution solution = solve_scene(scene, options).solution;
  ASSERT_EQ(solution.channels.size(), options.channels.names.size());
  double emitted = 0.0;
  for (const LightChannel& channel : solution.channels) {
    EXPECT_GT(channel.energy.row(0).sum(), 0.0) << channel.name;
    emitted += channel.energy.row(0).sum();
  }
  EXPECT_NEAR(emitted / solution.energy.emitted, 1.0, 1e-6);
}

LightChannel lamp_of(const Spectrum& flux) {
  LightChannel channel{.name = "lamp"};
  channel.energy = BandEnergy::Zero(4, flux.size());
  channel.energy.row(0) = flux.transpose().cast<double>();
  return channel;
}

TEST(ChannelSetting, ColourKeepsTheLuminousFlux) {
  const Bands bands = rgb_bands();
  for (const Spectrum& flux : {Spectrum(Spectrum::Constant(3, 5.0f)),
                               Spectrum((Spectrum(3) << 9.0f, 4.0f, 1.0f).finished())}) {
    const Spectrum scale = channel_scale(lamp_of(flux), bands, channel_setting("#ff8000"));
    // Rounding of a few floats.
    EXPECT_NEAR(luminous(bands, scale * flux) / luminous(bands, flux), 1.0, 1e-6);
    const float half = std::pow((128.0f / 255.0f + 0.055f) / 1.055f, 2.4f);  // IEC 61966-2-1
    EXPECT_NEAR(scale[1] / scale[0], half, 1e-6f);
    EXPECT_EQ(scale[2], 0.0f);
    const Spectrum dimmed = channel_scale(lamp_of(flux), bands, channel_setting("0.25,#FF8000"));
    EXPECT_NEAR(dimmed[0] / scale[0], 0.25, 1e-6);
  }
}

TEST(ChannelSetting, FactorsAreAsWritten) {
  EXPECT_EQ(channel_setting("0.3").factor, 0.3);
  EXPECT_EQ(channel_setting("off").factor, 0.0);
  EXPECT_EQ(channel_setting("on").factor, 1.0);
  EXPECT_FALSE(channel_setting("2e1").colour);
  const Spectrum scale = channel_scale(lamp_of(even(1.0f)), rgb_bands(), channel_setting("0.3"));
  EXPECT_TRUE((scale == 0.3f).all());
}

TEST(ChannelSetting, WhatMeansNothingIsRefused) {
  for (const char* text :
       {"", "dim", "-1", "nan", "inf", "1e9", "0.3x", "#fff", "#12345g", "#-12345", "#ffffff,0.3",
        "0.3#ffffff", ",#ffffff", "0.3,0.4", "#000000"}) {
    EXPECT_THROW(channel_setting(text), std::invalid_argument) << text;
  }
}

TEST(ChannelSetting, AColourWithoutThatLightIsRefused) {
  const Spectrum blue = (Spectrum(3) << 0.0f, 0.0f, 1.0f).finished();
  EXPECT_THROW(channel_scale(lamp_of(blue), rgb_bands(), channel_setting("#ff0000")), InputError);
  const Bands spectral = spectral_bands(400.0, 700.0, 30);
  const LightChannel lamp = lamp_of(constant_spectrum(spectral, 1.0f));
  EXPECT_THROW(channel_scale(lamp, spectral, channel_setting("#ff0000")), InputError);
  EXPECT_TRUE((channel_scale(lamp, spectral, channel_setting("0.5")) == 0.5f).all());
}

}  // namespace
}  // namespace lightwell::relight_test
