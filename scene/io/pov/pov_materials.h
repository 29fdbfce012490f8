#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/io/numbered_names.h"
#include "scene/io/pictures/picture_mean.h"
#include "scene/io/pov/pov_texture.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Blocks that say how a surface looks, and the place of its patterns.
struct PovLook {
  std::vector<const PovNode*> parts{};  ///< texture, pigment, finish, normal
  const PovNode* interior = nullptr;
  Eigen::Affine3d to_world = Eigen::Affine3d::Identity();  ///< of textures, in a Scene's axes
};

/// A material of the scene, and the layout of its picture.
struct PovMaterial {
  enum class Layout { none, planar, checker, by_uv };
  int number = 0;
  Layout layout = Layout::none;
  Eigen::Affine3d to_pattern = Eigen::Affine3d::Identity();  ///< from the scene
};

/// Materials of surfaces. Radiance 1 is that of a white surface that diffuses all light of a lamp
/// of colour 1.
class PovMaterials {
 public:
  PovMaterials(Scene& scene, Remarks& remarks) : scene_(scene), remarks_(remarks) {}

  /// The material of a surface called `name`. `is_closed`: of a body; `shines_inside`: emission
  /// leaves both sides. Colours become linear by the power `gamma`.
  PovMaterial of(const PovLook& look, const std::string& name, bool is_closed, bool shines_inside,
                 double gamma);
  /// Counts the blocks that shapes and textures look at.
  std::int64_t& visits() { return visits_; }

 private:
  Material make(const PovTexture& texture, const PovLook& look, const std::string& name,
                bool is_closed, double gamma, PovMaterial::Layout& layout);
  PovMaterial::Layout set_picture(const PovPigment& pigment, float diffuse, const std::string& name,
                                  double gamma, Material& material);
  void add_gloss(const PovFinish& finish, const Spectrum& color, double index,
                 const std::string& name, Material& material);

  Scene& scene_;
  Remarks& remarks_;
  PictureFiles pictures_{};
  NumberedNames names_{};
  std::map<std::uint64_t, int> known_{};
  std::int64_t visits_ = 0;
};

/// Linear red, green and blue of a colour, >= 0.
Spectrum pov_linear(const PovVector& color, double gamma);

/// Gives the facets of a mesh the coordinates of a planar picture or a checker; see PovMaterial.
void set_pov_layout(const PovMaterial& material, PolygonMesh& mesh);

}  // namespace lightwell
