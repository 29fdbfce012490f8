#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_mesh.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/solution/solution.h"
#include "raytrace/render.h"
#include "scene/scene.h"

namespace lightwell {

/// A grey material, two-sided by default.
struct Paint {
  float reflectance = 0.0f, specular = 0.0f, exitance = 0.0f;
  std::optional<float> index_of_refraction{};
  float tint = 1.0f;
  bool one_sided = false, emits_both_sides = false;
  float roughness = 0.0f;   ///< of the mirror or the dielectric
  float absorption = 0.0f;  ///< 1/m
  bool thin = false;
  std::optional<float> coat{};                   ///< index of refraction; `roughness` is the coat's
  float translucent = 0.0f, transparent = 0.0f;  ///< diffuse and regular transmittance
};

/// Builds a scene surface by surface.
class SceneBuilder {
 public:
  explicit SceneBuilder(const Bands& bands = rgb_bands()) { scene_.bands = bands; }

  SceneBuilder& polygon(const Paint& paint, std::vector<Eigen::Vector3d> points) {
    PolygonMesh mesh{.vertices = std::move(points), .facets = {Facet{}}};
    for (int i = 0; i < static_cast<int>(mesh.vertices.size()); ++i) {
      mesh.facets[0].boundary.push_back(i);
    }
    return add(paint, std::move(mesh));
  }

  /// A square around `center`, facing `normal`.
  SceneBuilder& square(const Paint& paint, const Eigen::Vector3d& center,
                       const Eigen::Vector3d& normal, double half_width) {
    const Eigen::Vector3d a = half_width * normal.unitOrthogonal();
    const Eigen::Vector3d b = normal.normalized().cross(a);
    return polygon(paint, {center - a - b, center + a - b, center + a + b, center - a + b});
  }

  SceneBuilder& sphere(const Paint& paint, const Eigen::Vector3d& center, double radius) {
    return add(paint, Sphere{.center = center, .radius = radius});
  }

  /// Six squares that face inwards (a room) or outwards (a block).
  SceneBuilder& box(const Paint& paint, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                    bool faces_inwards) {
    PolygonMesh mesh;
    for (int i = 0; i < 8; ++i) {
      mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                                 i & 4 ? high.z() : low.z());
    }
    const std::array<std::vector<int>, 6> outwards = {
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    for (std::vector<int> face : outwards) {
      if (faces_inwards) face = {face.rbegin(), face.rend()};
      mesh.facets.push_back({.boundary = face});
    }
    return add(paint, std::move(mesh));
  }

  Scene build() const {
    validate(scene_);
    return scene_;
  }

  /// A surface of any shape.
  SceneBuilder& add(const Paint& paint, SurfaceShape shape) {
    const Bands& bands = scene_.bands;
    Material material{.name = "paint " + std::to_string(scene_.materials.size()),
                      .reflectance = constant_spectrum(bands, paint.reflectance),
                      .specular = constant_spectrum(bands, paint.specular),
                      .specular_roughness = paint.index_of_refraction ? 0.0f : paint.roughness,
                      .emission = constant_spectrum(bands, paint.exitance),
                      .one_sided = paint.one_sided,
                      .emits_both_sides = paint.emits_both_sides};
    if (paint.translucent > 0.0f) {
      material.transmittance = constant_spectrum(bands, paint.translucent);
    }
    if (paint.transparent > 0.0f) {
      material.regular_transmittance = constant_spectrum(bands, paint.transparent);
    }
    if (paint.coat) {
      material.coat = Coat{.index_of_refraction = *paint.coat};
      material.specular = constant_spectrum(bands, 1.0f);
    }
    if (paint.index_of_refraction) {
      material.dielectric = Dielectric{.index_of_refraction = *paint.index_of_refraction,
                                       .tint = constant_spectrum(bands, paint.tint),
                                       .absorption = constant_spectrum(bands, paint.absorption),
                                       .roughness = paint.roughness,
                                       .thin = paint.thin};
    }
    scene_.materials.push_back(std::move(material));
    scene_.surfaces.push_back({.name = "surface " + std::to_string(scene_.surfaces.size()),
                               .material = static_cast<int>(scene_.materials.size()) - 1,
                               .shape = std::move(shape)});
    return *this;
  }

 private:
  Scene scene_{};
};

/// A scene with its mesh and a given irradiance in place of a solution.
class TracedScene {
 public:
  using Field = std::function<float(const Eigen::Vector3d& position)>;

  explicit TracedScene(Scene built, double patch_size = 0.0)
      : scene(std::move(built)),
        mesh(build_patches(scene, {.max_patch_size = patch_size, .auto_patch_count = 100})),
        caster(mesh),
        direct_light(scene, mesh) {
    solution.bands = scene.bands;
    solution.direct_irradiance.setZero(mesh.vertex_count(), scene.bands.count());
    solution.indirect_irradiance = solution.direct_irradiance;
  }
  TracedScene(const TracedScene&) = delete;
  TracedScene& operator=(const TracedScene&) = delete;

  void set_indirect(const Field& E) { set(solution.indirect_irradiance, E); }
  void set_direct(const Field& E) { set(solution.direct_irradiance, E); }

  Image render(const Camera& camera, const RenderOptions& options = {},
               RenderReport* report = nullptr) const {
    return lightwell::render(scene, caster, direct_light, solution, camera, options, report);
  }

  Scene scene;
  PatchMesh mesh;
  ElementCaster caster;
  DirectLight direct_light;
  RadiositySolution solution{};

 private:
  void set(BandArray& values, const Field& E) {
    for (int v = 0; v < mesh.vertex_count(); ++v) values.row(v) = E(mesh.position(v));
  }
};

/// A camera at `eye` that looks at `target`; up is some direction perpendicular to the view.
inline Camera camera_towards(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                             double fov_degrees, int pixels) {
  const Eigen::Vector3d direction = (target - eye).normalized();
  return {.name = "test",
          .position = eye,
          .direction = direction,
          .up = direction.unitOrthogonal(),
          .fov_degrees = fov_degrees,
          .width = pixels,
          .height = pixels};
}

/// Centroid of the first band's radiance, in pixels from the left and from the top.
inline Eigen::Vector2d centroid(const Image& image) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0.0;
  for (Eigen::Index i = 0; i < image.radiance.rows(); ++i) {
    const double L = image.radiance(i, 0);
    sum += L * Eigen::Vector2d(static_cast<double>(i % image.width) + 0.5,
                               static_cast<double>(i / image.width) + 0.5);
    weight += L;
  }
  return sum / weight;
}

}  // namespace lightwell
