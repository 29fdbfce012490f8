#include "scene/lamp_faces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <numbers>

namespace lightwell::lamp_faces_test {
namespace {

constexpr double pi = std::numbers::pi;

/// Cosine of gamma: flux pi, and pi `upwards` from the back. Every 5 degrees, linear between.
SharedWeb cosines(double upwards = 0.0) {
  constexpr int steps = 36;
  std::vector<double> gammas;
  Eigen::ArrayXXd values(1, steps + 1);
  for (int i = 0; i <= steps; ++i) {
    gammas.push_back(5.0 * i);
    const double cosine = std::cos(pi * i / steps);
    values(0, i) = cosine > 0.0 ? cosine : -upwards * cosine;
  }
  values = values.max(0.0);
  return std::make_shared<const PhotometricWeb>(std::vector<double>{0.0}, gammas, values);
}

Lamp lamp_of(SharedWeb web) {
  Lamp lamp{.position = {1, 2, 3}, .axes = lamp_axes({0, 0.6, -0.8}), .shape = std::move(web)};
  lamp.opening = {.along_c0 = 0.6, .along_c90 = 0.2};
  lamp.body = {.along_c0 = 0.7, .along_c90 = 0.3, .height = 0.1};
  return lamp;
}

Eigen::Vector3d normal_of(const LampFace& face) {
  const auto& p = face.outline;
  return (p[1] - p[0]).cross(p[2] - p[0]).normalized();
}

/// Volume that faces enclose; negative if they face inwards.
double volume(const std::vector<LampFace>& faces) {
  double sum = 0.0;
  for (const LampFace& face : faces) {
    if (face.shine > 0.0) continue;
    for (std::size_t c = 1; c + 1 < face.outline.size(); ++c) {
      sum += face.outline[0].dot(face.outline[c].cross(face.outline[c + 1])) / 6.0;
    }
  }
  return sum;
}

/// L = flux / (pi A): of a Lambertian opening its radiance in every direction, the intensity along
/// the axis over A. Linear interpolation of a cosine over 5 degrees takes (pi / 36)^2 / 12 =
/// 0.063 % of the light.
TEST(LampFaces, AnOpeningHasItsMeanRadiance) {
  const Lamp lamp = lamp_of(cosines());
  const auto faces = lamp_faces(lamp, {});
  ASSERT_EQ(faces.size(), 1u) << "a lamp without light upwards has no back";
  EXPECT_NEAR(faces[0].shine, 1.0 / (0.6 * 0.2), 1e-3 / 0.12);
  EXPECT_LT((normal_of(faces[0]) - lamp.aim()).norm(), 1e-12);
}

TEST(LampFaces, BothSidesShareTheLight) {
  Lamp lamp = lamp_of(cosines(0.25));
  lamp.opening = {.along_c0 = 0.4, .along_c90 = 0.4, .is_round = true};
  const auto faces = lamp_faces(lamp, {});
  ASSERT_EQ(faces.size(), 2u);
  const double area = pi * 0.04;
  EXPECT_NEAR(faces[0].shine, 1.0 / area, 1e-3 / area);
  EXPECT_NEAR(faces[1].shine, 0.25 / area, 1e-3 / area);
  EXPECT_LT((normal_of(faces[1]) + lamp.aim()).norm(), 1e-12);
}

TEST(LampFaces, ABodyStandsBehindTheOpening) {
  Lamp lamp = lamp_of(cosines());
  const BodyEnds ends = body_ends(lamp);
  EXPECT_EQ(ends.low, 0.0);
  EXPECT_EQ(ends.high, 0.1);
  const auto faces = lamp_faces(lamp, ends);
  ASSERT_EQ(faces.size(), 7u);
  EXPECT_NEAR(volume(faces), 0.7 * 0.3 * 0.1, 1e-12);
  for (const LampFace& face : faces) {
    if (face.shine > 0.0) continue;
    for (const Eigen::Vector3d& p : face.outline) {
      EXPECT_GE((p - lamp.position).dot(-lamp.aim()), -1e-12);
    }
  }
  lamp.body.is_round = true;
  // A prism over a regular polygon of 48 corners: 24 sin(pi / 24) / pi of the cylinder.
  EXPECT_NEAR(volume(lamp_faces(lamp, ends)), 24.0 * std::sin(pi / 24) * 0.35 * 0.15 * 0.1, 1e-12);
}

TEST(LampFaces, ABodyThatShinesBothWaysIsInTheMiddle) {
  const Lamp lamp = lamp_of(cosines(1.0));
  const BodyEnds ends = body_ends(lamp);
  EXPECT_EQ(ends.low, -0.05);
  EXPECT_EQ(ends.high, 0.05);
  Lamp upwards = lamp;
  upwards.axes = lamp_axes(-lamp.aim());
  EXPECT_EQ(lamp_faces(upwards, ends).size(), 8u);
}

TEST(LampFaces, HiddenLampsAndPointsHaveNone) {
  Lamp hidden = lamp_of(cosines());
  hidden.visible = false;
  EXPECT_TRUE(lamp_faces(hidden, body_ends(hidden)).empty());
  Lamp point = lamp_of(cosines());
  point.opening = {};
  point.body = {};
  EXPECT_TRUE(lamp_faces(point, body_ends(point)).empty());
}

}  // namespace
}  // namespace lightwell::lamp_faces_test
