#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/io/numbered_names.h"
#include "scene/io/radiance/radiance_primitive.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// What patterns multiply a material's colour with.
struct RadiancePattern {
  Spectrum factor = Spectrum::Ones(3);
  bool is_known = true;  ///< false: a pattern that changes from place to place was taken as 1
};

/// A RADIANCE material as one of the Scene, or nothing for those that cannot be seen (antimatter,
/// mist); not for mixtures. What is approximated is remarked upon. Throws InputError for arguments
/// that are missing or out of range.
std::optional<Material> read_radiance_material(const RadiancePrimitive& material,
                                               const RadiancePattern& pattern, Remarks& remarks);

/// The modifiers of a RADIANCE scene: a name means what was defined last under it.
class RadianceMaterials {
 public:
  RadianceMaterials(Scene& scene, Remarks& remarks) : scene_(scene), remarks_(remarks) {}

  /// Takes a material, pattern, texture, mixture or alias.
  void define(const RadiancePrimitive& primitive);
  /// Index of a surface's material, which is added to the scene where it is new; nothing for
  /// surfaces that cannot be seen.
  std::optional<int> of_surface(const RadiancePrimitive& surface);

 private:
  static constexpr int none = -1;
  struct Definition {
    RadiancePrimitive primitive{};
    int parent = none;           // its modifier
    std::vector<int> parts{};    // of a mixture; an illum's other material
    std::optional<int> index{};  // into the scene's materials; none: cannot be seen
  };
  int index_of(const std::string& name, const RadiancePrimitive& user) const;
  Definition aliased(const RadiancePrimitive& alias) const;
  std::optional<Material> read(int definition, int depth);
  std::optional<Material> read_new(int definition, int depth);
  std::optional<Material> mixed(const Definition& mixture, int depth);
  RadiancePattern pattern_of(const Definition& definition);
  void apply(const Definition& pattern, RadiancePattern& result);

  Scene& scene_;
  Remarks& remarks_;
  std::vector<Definition> definitions_;
  std::map<std::string, int, std::less<>> latest_;
  std::map<int, std::optional<Material>> known_;  // mixtures of mixtures would be read 2^n times
  NumberedNames names_;
};

}  // namespace lightwell
