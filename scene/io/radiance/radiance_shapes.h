#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "scene/io/mesh_builder.h"
#include "scene/io/numbered_names.h"
#include "scene/io/polygon_repair.h"
#include "scene/io/radiance/radiance_lamps.h"
#include "scene/io/radiance/radiance_materials.h"
#include "scene/io/radiance/radiance_sky.h"
#include "scene/io/radiance/text/radiance_primitive.h"
#include "scene/io/remarks.h"
#include "scene/io/scene_size.h"
#include "scene/scene.h"

namespace lightwell {

/// Converts primitives of a RADIANCE scene to surfaces, materials, lamps and a sky (mapping in
/// docs/radiance-scenes.md). Successive polygons of one material whose names differ only in a last
/// number (box.1, box.2) become one surface.
class RadianceShapes {
 public:
  RadianceShapes(Scene& scene, Remarks& remarks)
      : scene_(scene), remarks_(remarks), materials_(scene, remarks), lamps_(scene) {}

  /// Adds a primitive of any kind; the order of calls is the order of the files. Throws InputError
  /// naming file, line and fault.
  void add(const RadiancePrimitive& primitive);
  /// Completes the last surface and the sky; to be called once, at the end. `up` is the zenith
  /// where the scene does not tell.
  void finish(const Eigen::Vector3d& up);
  /// Counts of repaired polygons so far.
  const Repairs& repairs() const { return repairs_; }

 private:
  void add_source(const RadiancePrimitive& source);
  bool add_lamp(const RadiancePrimitive& surface);
  void complete_surface();
  void add_polygon(const RadiancePrimitive& polygon, int material);
  void add_sphere(const RadiancePrimitive& sphere, int material);
  void add_cone(const RadiancePrimitive& cone, int material);
  void add_ring(const RadiancePrimitive& ring, int material);
  void add_surface(const RadiancePrimitive& primitive, int material, SurfaceShape shape);
  void account(const RadiancePrimitive& primitive, std::int64_t triangles);
  bool sides_differ(int material) const;

  Scene& scene_;
  Remarks& remarks_;
  RadianceMaterials materials_;
  RadianceLamps lamps_;
  RadianceSky sky_;
  Repairs repairs_;
  NumberedNames names_;
  std::int64_t primitives_ = 0;
  SceneSize size_;
  // The surface to which further polygons may be added.
  std::string stem_;
  int material_ = -1;
  MeshBuilder mesh_;
};

}  // namespace lightwell
