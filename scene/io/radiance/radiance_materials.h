#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/io/numbered_names.h"
#include "scene/io/radiance/patterns/radiance_direction.h"
#include "scene/io/radiance/text/radiance_primitive.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Product of the patterns of a material, a factor of its colour.
struct RadiancePattern {
  Spectrum factor = Spectrum::Ones(3);
  bool is_known = true;  ///< false: nothing is known of a pattern, which counts as 1 or 0.5
};

/// Converts a RADIANCE material; empty for invisible ones (antimatter, mist). Mixtures are not
/// accepted. Approximations add a remark. Throws InputError for arguments that are missing or out
/// of range.
std::optional<Material> read_radiance_material(const RadiancePrimitive& material,
                                               const RadiancePattern& pattern, Remarks& remarks);

/// Whether a light, glow, illum or spotlight is seen but lights nothing: a glow of a negative
/// radius. Throws InputError for arguments that are missing.
bool is_only_seen(const RadiancePrimitive& light);

/// Radiance of a light, glow, illum or spotlight, without its patterns, W/(sr m^2) of r, g and b; 0
/// with a remark for those that are only seen. Throws InputError for arguments that are missing or
/// out of range.
Spectrum radiance_color(const RadiancePrimitive& light, Remarks& remarks);

/// Light of a luminous material by direction.
struct RadianceLight {
  RadiancePrimitive material{};                     ///< light, glow, illum or spotlight
  Spectrum color{};                                 ///< W/(sr m^2), constant patterns included
  std::vector<const DirectionPattern*> patterns{};  ///< valid as long as the RadianceMaterials

  /// Radiance, W/(sr m^2), of a ray along the unit vector `ray` towards the light that meets the
  /// luminous surface at an angle of this cosine.
  Spectrum radiance(const Eigen::Vector3d& ray, double cosine) const;
};

/// The modifiers of a RADIANCE scene. A name refers to its latest definition; a name without one is
/// a grey material of reflectance 0.5, with a remark.
class RadianceMaterials {
 public:
  RadianceMaterials(Scene& scene, Remarks& remarks) : scene_(scene), remarks_(remarks) {}

  /// Records a material, pattern, texture, mixture or alias.
  void define(const RadiancePrimitive& primitive);
  /// Index of a surface's material in the scene, added if new; empty for invisible surfaces.
  std::optional<int> of_surface(const RadiancePrimitive& surface);
  /// Light of a surface or source; empty if its material is not luminous, is a mixture, or has a
  /// pattern that depends on more than direction.
  std::optional<RadianceLight> light_of(const RadiancePrimitive& surface);
  /// The material behind an illum; empty if there is none, or it cannot be seen.
  std::optional<int> behind_illum(const RadiancePrimitive& surface);
  /// Gives illums that were read as opaque lights their alternate material, which light from
  /// outside passes or meets.
  void open_illums();

 private:
  static constexpr int none = -1;
  struct Definition {
    RadiancePrimitive primitive{};
    int parent = none;           // index of its modifier
    std::vector<int> parts{};    // the materials of a mixture; an illum's alternate material
    std::optional<int> index{};  // into the scene's materials; none: invisible
  };
  int index_of(const std::string& name, const RadiancePrimitive& user);
  std::optional<int> scene_material(int definition, const RadiancePrimitive& user);
  std::optional<int> same_material(const std::string& name, const Material& material) const;
  const DirectionPattern* direction_pattern(int definition);
  Definition aliased(const RadiancePrimitive& alias);
  std::optional<Material> read(int definition, const RadiancePrimitive& user, int depth);
  std::optional<Material> read_new(int definition, const RadiancePrimitive& user, int depth);
  std::optional<Material> mixed(const Definition& mixture, const RadiancePrimitive& user,
                                int depth);
  RadiancePattern pattern_of(const Definition& definition, const RadiancePrimitive& user);
  void apply(const Definition& pattern, const RadiancePrimitive& user, RadiancePattern& result);
  std::optional<Spectrum> mean_of_picture(const RadiancePrimitive& colorpict);

  Scene& scene_;
  Remarks& remarks_;
  std::vector<Definition> definitions_;
  std::map<std::string, int, std::less<>> latest_;
  // A cache: mixtures of mixtures would be read 2^n times.
  std::map<int, std::optional<Material>> known_;
  // Means over each picture, of functions of its r, g and b.
  std::map<std::filesystem::path, std::optional<Spectrum>> means_;
  // Patterns by definition; null for those that depend on more than direction.
  std::map<int, std::unique_ptr<const DirectionPattern>> by_direction_;
  NumberedNames names_;
  std::map<std::string, std::vector<int>, std::less<>> materials_of_name_;  // in the scene
};

}  // namespace lightwell
