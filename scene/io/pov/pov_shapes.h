#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/io/numbered_names.h"
#include "scene/io/polygon.h"
#include "scene/io/polygon_repair.h"
#include "scene/io/pov/pov_csg.h"
#include "scene/io/pov/pov_lights.h"
#include "scene/io/pov/pov_materials.h"
#include "scene/io/pov/pov_solids.h"
#include "scene/io/scene_size.h"

namespace lightwell {

/// Place and looks that a block of shapes inherits from the blocks around it and adds to.
struct PovPlacement {
  Eigen::Affine3d to_world = Eigen::Affine3d::Identity();
  PovLook look{};
  std::string name{};
  bool is_hollow = false;  ///< or inverse: seen from inside
};

/// Shapes as surfaces of a scene.
class PovShapes {
 public:
  PovShapes(Scene& scene, Remarks& remarks)
      : scene_(scene), remarks_(remarks), materials_(scene, remarks) {}

  /// Adds the shapes and lights of a block; false for a block of another kind. `defaults` may be
  /// null. Colours become linear by the power `gamma`.
  bool add(const PovNode& block, const PovNode* defaults, double gamma);
  /// Adds the planes, cut to the bounds of all else, and sets the intensity of the lights. To be
  /// called when all blocks and the cameras have been added.
  void finish();
  const Repairs& repairs() const { return repairs_; }

 private:
  struct Plane {
    PovHalfSpace half_space{};  // in the scene
    PovMaterial material{};
    std::string name{};
    bool is_opaque = true;
  };
  struct Body {  // of a difference or an intersection
    PovConvex convex{};
    PovPlacement placement{};
    std::vector<PovHalfSpace> unbounded{};
  };

  bool add_placed(const PovNode& block, const PovPlacement& outer);
  PovPlacement inner(PovCursor& cursor, const PovPlacement& outer);
  void add_part(const PovNode& part, PovPlacement& placement, bool& has_own);
  void add_children(const PovNode& block, const PovPlacement& placement);
  void add_plane(PovCursor& cursor, const PovPlacement& outer);
  void add_solid(const PovSolid& solid, const PovPlacement& placement);
  void add_piece(const PovPiece& piece, const PovPlacement& placement, bool is_closed);
  SurfaceShape placed(const PovPiece& piece, const PovPlacement& placement);
  PolygonMesh placed_facets(const PovFacets& facets, const Eigen::Affine3d& to_world);
  void add_surface(SurfaceShape shape, const PovMaterial& material, const std::string& name);
  void account(std::int64_t triangles, const std::string& name);
  Loop plane_square(const Plane& plane, const Bounds& around) const;
  Bounds bounds_of_all() const;

  // Differences and intersections of convex bodies (pov_cut_shapes.cpp).
  void add_cut(const PovNode& block, const PovPlacement& outer);
  bool add_bodies(const PovNode& operand, const PovPlacement& outer, std::vector<Body>& bodies);
  void bound_bodies(std::vector<Body>& bodies, double& size) const;

  Scene& scene_;
  Remarks& remarks_;
  PovMaterials materials_;
  PovLights lights_{};
  Repairs repairs_{};
  SceneSize size_{};
  NumberedNames names_{};
  std::vector<Plane> planes_{};
  double gamma_ = 1.0;
};

}  // namespace lightwell
