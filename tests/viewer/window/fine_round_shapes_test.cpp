#include "viewer/window/fine_round_shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "viewer/window/solution_view.h"
#include "viewer/window/x_display.h"

namespace lightwell::fine_round_shapes_test {
namespace {

constexpr double pi = std::numbers::pi;
const Sphere ball{.center = {1.0, 2.0, 3.0}, .radius = 0.5};

/// A two-sided emitting ball of a few large elements.
Scene ball_scene() {
  Scene scene;
  scene.bands = rgb_bands();
  scene.materials.push_back({.name = "white",
                             .reflectance = constant_spectrum(scene.bands, 0.5f),
                             .specular = constant_spectrum(scene.bands, 0.0f),
                             .emission = constant_spectrum(scene.bands, 1.0f)});
  scene.surfaces.push_back({.name = "ball", .material = 0, .shape = ball});
  return scene;
}

PatchMesh ball_mesh() {
  return build_patches(ball_scene(), {.max_patch_size = 0.5, .elements_per_patch_edge = 1});
}

/// The inscribed faces have less area than the sphere by a share of (2.8 degrees)^2 / 6 = 4e-4 on
/// each side.
TEST(FineRoundShapes, FacesCoverBothSidesOfTheSphereAndFaceAwayFromThem) {
  const PatchMesh mesh = ball_mesh();
  const FineRoundShapes fine = fine_round_shapes(mesh);
  std::array<double, 2> area{};
  for (const FineRoundShapes::Face& face : fine.faces) {
    const bool is_back = mesh.is_back[mesh.patch[face.element]] != 0;
    for (int c = 1; c < 3 && face.corner[c + 1] >= 0; ++c) {
      const auto& a = fine.points[face.corner[0]];
      const Eigen::Vector3d twice =
          (fine.points[face.corner[c]].position - a.position)
              .cross(fine.points[face.corner[c + 1]].position - a.position);
      EXPECT_GT(twice.dot(a.normal), 0.0);
      EXPECT_GT(twice.dot(a.position - ball.center) * (is_back ? -1.0 : 1.0), 0.0);
      area[is_back] += 0.5 * twice.norm();
    }
  }
  const double exact = 4.0 * pi * ball.radius * ball.radius;
  for (const double side : area) {
    EXPECT_LT(side, exact);
    EXPECT_GT(side, exact * (1.0 - 1e-3));
  }
}

/// Light at points is that of the elements that rays hit there.
TEST(FineRoundShapes, PointsHaveTheLightOfTheirElement) {
  const PatchMesh mesh = ball_mesh();
  const ElementCaster caster(mesh);
  BandArray values(mesh.vertex_count(), 1);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    values(v, 0) = static_cast<float>(mesh.position(v).z()) + (v % 7);
  }
  for (const FineRoundShapes::Point& point : fine_round_shapes(mesh).points) {
    EXPECT_NEAR((point.position - ball.center).norm(), ball.radius, 1e-12);
    EXPECT_NEAR(point.weight.sum(), 1.0f, 1e-6f);
    const Ray ray{.origin = point.position + point.normal, .direction = -point.normal};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    const bool is_outside = point.normal.dot(point.position - ball.center) > 0.0;
    if (!is_outside) continue;  // the ray meets the outside first
    float value = 0.0f;
    for (int c = 0; c < 4; ++c) {
      if (point.vertex[c] >= 0) value += point.weight[c] * values(point.vertex[c], 0);
    }
    // Hits are exact to 1e-6 of a ray's length; values change by 7 within 0.3 m.
    const Eigen::Vector3d away = (point.position - ball.center).normalized();
    if (std::abs(away.z()) < 0.999) {  // at the poles every longitude is as good
      EXPECT_NEAR(value, interpolate(mesh, values, hit)[0], 1e-4f);
    }
  }
}

/// From 4 m away the outline is a circle of radius tan(asin(0.5 / 4)) for any element size. The lit
/// share of the picture is that of the disc, to a tenth of a pixel along the outline.
TEST(FineRoundShapes, OutlinesAreRound) {
  const Scene scene = ball_scene();
  SolvedScene solved{.mesh = ball_mesh(), .solution = {}};
  solved.solution.bands = scene.bands;
  solved.solution.direct_irradiance = BandArray::Ones(solved.mesh.vertex_count(), 3);
  solved.solution.indirect_irradiance = BandArray::Zero(solved.mesh.vertex_count(), 3);
  Camera camera;
  camera.position = ball.center - Eigen::Vector3d(0.0, 4.0, 0.0);
  camera.direction = {0, 1, 0};
  camera.up = {0, 0, 1};
  camera.fov_degrees = 20.0;
  camera.width = camera.height = 200;
  ViewOptions options{.camera = camera, .cameras = {camera}, .width = 200, .height = 200};
  const DisplayConnection display;
  SolutionView view(solved, options);
  Look look = view.look();
  look.exposure_ev = 8.0;  // the ball is white
  view.set_look(look);
  const auto bytes = draw_offscreen(view, 200, 200);
  double shown = 0.0;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const double s = bytes[i] / 255.0;  // sRGB
    shown += s > 0.04045 ? std::pow((s + 0.055) / 1.055, 2.4) : s / 12.92;
  }
  const double tangent = std::tan(std::asin(ball.radius / 4.0)), pixels = 100.0 / std::tan(pi / 18);
  const double radius = tangent * pixels;
  // Pixels on the outline are covered in steps of a sample, which cancel around it.
  EXPECT_NEAR(std::sqrt(shown / pi), radius, 0.03);
}

/// 128 chords around lose 1 - sinc(pi / 128), 1.0e-4, of the area. Faces of a cone lie nearer to
/// the axis than its generators by 1 - cos(pi / 128), which shortens the slant of one of radius 1
/// and height 2 by a fifth of this, 0.6e-4.
TEST(FineRoundShapes, FacesOfFrustumsCoverBothSides) {
  for (const double top : {0.0, 0.5, 1.0}) {
    const Frustum frustum{.height = 2.0, .top_radius = top};
    Scene scene = ball_scene();
    scene.surfaces[0].shape = frustum;
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
    const FineRoundShapes fine = fine_round_shapes(mesh);
    double covered = 0.0;
    for (const FineRoundShapes::Face& face : fine.faces) {
      const auto at = [&](int c) {
        return fine.points[static_cast<std::size_t>(face.corner[static_cast<std::size_t>(c)])];
      };
      Eigen::Vector3d twice =
          (at(1).position - at(0).position).cross(at(2).position - at(0).position);
      if (face.corner[3] >= 0) {
        twice += (at(2).position - at(0).position).cross(at(3).position - at(0).position);
      }
      covered += 0.5 * twice.norm();
      EXPECT_GT(twice.dot(at(0).normal), 0.0);
    }
    EXPECT_NEAR(covered, 2.0 * area(frustum), 2.0 * area(frustum) * 1.7e-4) << top;
  }
}

TEST(FineRoundShapes, AreNoneWithoutSpheres) {
  EXPECT_TRUE(fine_round_shapes(PatchMesh{}).faces.empty());
}

}  // namespace
}  // namespace lightwell::fine_round_shapes_test
