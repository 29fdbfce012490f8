#include "scene/polarisation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "scene/optics.h"
#include "scene/sampling.h"
#include "scene/specular.h"

namespace lightwell::polarisation_test {
namespace {

using Eigen::Vector3d;

constexpr double degree = std::numbers::pi / 180.0;
// Doubles of the same closed forms; weights are floats.
constexpr double exact = 1e-12, single = 2e-6;

Material glass(float index, bool thin) {
  const Spectrum zero = Spectrum::Zero(3);
  Material material{.name = "glass", .reflectance = zero, .specular = zero, .emission = zero};
  material.dielectric =
      Dielectric{.index_of_refraction = index, .tint = Spectrum::Ones(3), .thin = thin};
  return material;
}

// A surface that a path meets: it crosses, or it is reflected.
struct Step {
  Material material;
  Vector3d normal;
  bool crosses = true;
};

// Share of unpolarised light that takes all steps. The normals point against the light. `to` gets
// the direction in the end.
double share_of(const std::vector<Step>& steps, Vector3d direction, Vector3d* to = nullptr) {
  double share = 1.0;
  Polarisation polarisation;
  for (const auto& [material, normal, crosses] : steps) {
    const bool from_back = normal.dot(direction) > 0.0;
    const SmoothScattering lobes =
        smooth_scattering({.material = material,
                           .direction = direction,
                           .normal = from_back ? Vector3d(-normal) : normal,
                           .from_back = from_back,
                           .polarisation = polarisation});
    if (crosses && lobes.count < 2) return 0.0;
    const ScatteringSample& sample = lobes.sample[crosses ? 1 : 0];
    share *= static_cast<double>(sample.weight[0]);
    polarisation = sample.polarisation;
    direction = sample.direction.normalized();
  }
  if (to) *to = direction;
  return share;
}

Vector3d inclined(double degrees) {
  return {std::sin(degrees * degree), 0.0, -std::cos(degrees * degree)};
}

TEST(Polarisation, ParallelPanesPassEachPolarisationByItself) {
  for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
    const PolarisedReflectance face = polarised_reflectance(std::cos(degrees * degree), 1.5);
    for (int count = 1; count <= 4; ++count) {
      const std::vector<Step> panes(static_cast<std::size_t>(count),
                                    {glass(1.5f, true), Vector3d::UnitZ()});
      double expected = 0.0;
      for (const double r : {face.s, face.p}) {
        expected += 0.5 * std::pow((1.0 - r) / (1.0 + r), count);
      }
      EXPECT_NEAR(share_of(panes, inclined(degrees)), expected, single) << count << ' ' << degrees;
    }
  }
}

// Light that is s-polarised for the first pane is p-polarised for a second one that is turned by a
// right angle about the light; half-way, both polarisations have equal parts in it.
TEST(Polarisation, IsTurnedWithThePlaneOfIncidence) {
  constexpr double degrees = 65.0;
  const PolarisedReflectance face = polarised_reflectance(std::cos(degrees * degree), 1.5);
  const double s = (1.0 - face.s) / (1.0 + face.s), p = (1.0 - face.p) / (1.0 + face.p);
  const Vector3d light = inclined(degrees), normal = Vector3d::UnitZ();
  const auto both = [&](double turn) {
    const Vector3d turned = Eigen::AngleAxisd(turn * degree, light) * normal;
    return share_of({{glass(1.5f, true), normal}, {glass(1.5f, true), turned}}, light);
  };
  EXPECT_NEAR(both(0.0), 0.5 * (s * s + p * p), single);
  EXPECT_NEAR(both(45.0), 0.25 * (s + p) * (s + p), single);
  EXPECT_NEAR(both(-45.0), 0.25 * (s + p) * (s + p), single);
  EXPECT_NEAR(both(90.0), s * p, single);
  EXPECT_NEAR(both(180.0), 0.5 * (s * s + p * p), single);
}

// Reciprocity: the same surfaces in the opposite order have the same share. Radiance over n^2 keeps
// its value across a face, and so does the share.
TEST(Polarisation, GivesAPathTheSameShareFromEitherEnd) {
  int seen = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    std::vector<Step> steps;
    Vector3d direction(0.0, 0.0, -1.0);
    for (std::uint64_t k = 0; k < 5; ++k) {
      const auto random = [&](std::uint64_t n) { return random_uniform(random_key(i, k, n)); };
      const Vector3d side(random(0) - 0.5, random(1) - 0.5, random(2) - 0.5);
      Vector3d normal = (-direction + 1.6 * side).normalized();
      if (random(3) < 0.5) normal = -normal;
      steps.push_back({glass(1.5f, random(4) < 0.4), normal, random(5) < 0.6});
      if (!(share_of(steps, {0.0, 0.0, -1.0}, &direction) > 0.0)) break;
    }
    const double there = share_of(steps, {0.0, 0.0, -1.0}, &direction);
    if (!(there > 0.0)) continue;
    ++seen;
    const std::vector<Step> reversed(steps.rbegin(), steps.rend());
    Vector3d end;
    const double back = share_of(reversed, -direction, &end);
    EXPECT_NEAR((end - Vector3d::UnitZ()).norm(), 0.0, 1e-6) << i;
    EXPECT_NEAR(back / there, 1.0, 1e-5) << i;
  }
  EXPECT_GT(seen, 50);
}

TEST(Polarisation, OfLightOffGlassAtBrewstersAngleIsWhole) {
  const double angle = std::atan(1.5);
  const Vector3d light(std::sin(angle), 0.0, -std::cos(angle));
  const PolarisedLight off = after_interface(about_plane_of_incidence({}, light, Vector3d::UnitZ()),
                                             face_shares(std::cos(angle), 1.5).reflected);
  EXPECT_NEAR(off.polarisation.q, 1.0, exact);
  EXPECT_NEAR(std::abs(off.polarisation.across.y()), 1.0, exact);
}

TEST(Polarisation, OfTotallyReflectedLightStaysWithinItsBounds) {
  for (const double cosine : {0.0, 1e-6, 0.3, 0.7, 0.74}) {
    const InterfaceShares shares = face_shares(cosine, 1.0 / 1.5);
    EXPECT_EQ(shares.reflected.s, 1.0);
    EXPECT_EQ(shares.reflected.p, 1.0);
    EXPECT_LE(std::abs(shares.reflected.u), 1.0);
    EXPECT_EQ(shares.passed.s + shares.passed.p, 0.0);
  }
  // At the critical angle both phases are 0.
  const double critical = std::sqrt(1.0 - 1.0 / 2.25);
  EXPECT_NEAR(face_shares(critical, 1.0 / 1.5).reflected.u, 1.0, 1e-6);
}

// The sums over inner reflections, with the amplitudes of one face.
TEST(Polarisation, OfAPaneIsTheSumOfItsInnerReflections) {
  for (const double degrees : {20.0, 60.0, 80.0}) {
    for (const double t : {0.6, 1.0}) {
      const double cosine = std::cos(degrees * degree), inner = std::sin(degrees * degree) / 1.5;
      const double d = std::pow(t, 1.0 / std::sqrt(1.0 - inner * inner));
      const PolarisedShares face = face_shares(cosine, 1.5).reflected;
      double passed = 0.0, reflected = face.u;
      for (int k = 0; k < 200; ++k) {
        const double to_and_fro = std::pow(face.s * face.p * d * d, k);
        passed += (1.0 - face.s) * (1.0 - face.p) * d * to_and_fro;
        reflected += (1.0 - face.s) * (1.0 - face.p) * d * d * face.u * to_and_fro;
      }
      const InterfaceShares pane = pane_interface(cosine, 1.5, t);
      EXPECT_NEAR(pane.passed.u, passed, exact);
      EXPECT_NEAR(pane.reflected.u, reflected, exact);
    }
  }
}

}  // namespace
}  // namespace lightwell::polarisation_test
