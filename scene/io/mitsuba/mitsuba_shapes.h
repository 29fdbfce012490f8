#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/io/mesh_file.h"
#include "scene/io/mitsuba/mitsuba_materials.h"
#include "scene/io/mitsuba/mitsuba_tree.h"
#include "scene/io/numbered_names.h"
#include "scene/io/remarks.h"
#include "scene/io/scene_size.h"
#include "scene/scene.h"

namespace lightwell {

/// Converts shapes of a Mitsuba scene to surfaces (mapping in docs/scene-format.md).
class MitsubaShapes {
 public:
  MitsubaShapes(const MitsubaTree& tree, Scene& scene, Remarks& remarks)
      : tree_(tree), scene_(scene), remarks_(remarks), materials_(tree, scene, remarks) {}

  /// Adds the surface of a <shape>, or the surfaces of the shape group of an instance. Shapes whose
  /// mesh file is missing or has no area are left out. Throws InputError naming file, line and
  /// fault, and LimitError for too many polygons.
  void add(const MitsubaNode& shape);
  /// Counts of repaired polygons so far.
  const Repairs& repairs() const { return repairs_; }

 private:
  // A mesh file before placement, shared by instances and repeated shapes.
  struct MeshFile {
    PolygonMesh mesh{};
    Repairs repairs{};
    bool has_normals = false;
    std::int64_t triangles = 0;
  };
  void add_placed(const MitsubaNode& shape, const Eigen::Affine3d& to_world,
                  const std::string& prefix);
  void account(const MitsubaNode& shape, std::int64_t triangles);
  void add_instance(const MitsubaNode& instance);
  void add_surface(const MitsubaNode& shape, const std::string& name, SurfaceShape placed);
  SurfaceShape sphere(const MitsubaNode& shape, const Eigen::Affine3d& to_world,
                      const std::string& name);
  static Frustum cylinder(const MitsubaNode& shape);
  SurfaceShape round(const MitsubaNode& shape, const Frustum& frustum,
                     const Eigen::Affine3d& to_world, const std::string& name);
  void add_mesh(const MitsubaNode& shape, const Eigen::Affine3d& to_world, const std::string& name);
  PolygonMesh mesh(const MitsubaNode& shape, const Eigen::Affine3d& to_world,
                   const std::string& name);
  const MeshFile& mesh_file(const MitsubaNode& shape, bool with_uv, MeshFronts fronts);
  std::string unique_name(const MitsubaNode& shape, const std::string& prefix);

  const MitsubaTree& tree_;
  Scene& scene_;
  Remarks& remarks_;
  MitsubaMaterials materials_;
  Repairs repairs_;
  std::map<std::tuple<std::filesystem::path, int, bool, MeshFronts>, MeshFile> files_;
  NumberedNames names_;
  SceneSize size_;
};

}  // namespace lightwell
