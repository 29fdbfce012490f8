#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "scene/bands.h"
#include "scene/io/mitsuba/mitsuba_tree.h"
#include "scene/io/pictures/picture_mean.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Weights of a picture's pixels in its mean: all equal, or by opacity (the rest is cut away by a
/// mask).
enum class Pixels { all, by_opacity };

/// A reflectance texture and its mean.
struct MitsubaTexture {
  ReflectanceTexture texture{};
  Spectrum mean{};
};

/// A picture of light and its mean.
struct MitsubaLight {
  EmissionTexture texture{};
  Spectrum mean{};
};

/// Converts spectra and textures of a Mitsuba scene to RGB bands (linear, Rec. 709). Wavelengths
/// become r, g and b as in native files: means over 600-700, 500-600 and 400-500 nm. Where no
/// texture can be kept, its mean colour is used, with a remark.
class MitsubaColors {
 public:
  MitsubaColors(const MitsubaTree& tree, Remarks& remarks) : tree_(tree), remarks_(remarks) {}

  /// Value of a property in [0,1]; values above 1 are cut off at 1, with a remark. `owner` is the
  /// plugin with the property. Throws InputError naming file, line and value.
  Spectrum share_or(const MitsubaNode& owner, std::string_view property, float otherwise,
                    Pixels pixels);
  /// Value of a property that is at least 0: radiance, a metal's eta and k.
  Spectrum positive_or(const MitsubaNode& owner, std::string_view property, float otherwise);
  std::optional<Spectrum> positive(const MitsubaNode& owner, std::string_view property,
                                   Pixels pixels = Pixels::all);
  /// Value of a property that is one number, such as a roughness; the mean of a spectrum or
  /// texture.
  double number_or(const MitsubaNode& owner, std::string_view property, double otherwise);
  /// Texture of a property in [0,1]: a bitmap or a checkerboard, scaled or not; empty for other
  /// properties.
  std::optional<MitsubaTexture> texture(const MitsubaNode& owner, std::string_view property,
                                        Pixels pixels);
  /// Picture of a property that is at least 0, such as radiance: its values are `factor` times the
  /// picture's. Empty for properties that are no bitmap or checkerboard, and for pictures that
  /// cannot be read.
  std::optional<MitsubaLight> light(const MitsubaNode& owner, std::string_view property);
  /// True if a property is a bitmap, scaled or not.
  bool is_bitmap(const MitsubaNode& owner, std::string_view property) const;
  /// Mask of an opacity bitmap: the picture's alpha, or its red channel if the picture is opaque.
  /// Empty if the property is no bitmap, or one that cannot be read.
  std::optional<Mask> mask(const MitsubaNode& owner, std::string_view property);
  /// Relief of the texture within a `normalmap`, `bumpmap` or `bump`; empty, with a remark, if its
  /// picture cannot be read. Heights are in the scene's unit.
  std::optional<Relief> relief(const MitsubaNode& owner);

 private:
  const MitsubaNode* texture_node(const MitsubaNode& owner, std::string_view property) const;
  std::optional<MitsubaTexture> bitmap(const MitsubaNode& node, Pixels pixels);
  MitsubaTexture checkerboard(const MitsubaNode& node, Pixels pixels, float brightest = 1.0f);
  float brightest_of_checkerboard(const MitsubaNode& node);
  static SurfaceTexture laid_on(const MitsubaNode& node, std::shared_ptr<const Texture> picture);
  Spectrum read(const MitsubaNode& node, Pixels pixels, int depth);
  Spectrum read_new(const MitsubaNode& node, Pixels pixels, int depth);
  Spectrum read_rgb(const MitsubaNode& node) const;
  Spectrum read_srgb(const MitsubaNode& node) const;
  Spectrum read_spectrum(const MitsubaNode& node, Pixels pixels, int depth);
  Spectrum read_blackbody(const MitsubaNode& node) const;
  Spectrum read_texture(const MitsubaNode& node, Pixels pixels, int depth);
  Spectrum read_bitmap(const MitsubaNode& node, Pixels pixels);
  std::optional<Picture> picture_of(const MitsubaNode& node, PictureCode code);
  std::optional<LightPicture> light_picture_of(const MitsubaNode& node);
  Spectrum factor_of(const MitsubaNode& owner, std::string_view property, const MitsubaNode& node,
                     Pixels pixels);
  Spectrum part_or(const MitsubaNode& texture, std::string_view property, float otherwise,
                   Pixels pixels, int depth);

  const MitsubaTree& tree_;
  Remarks& remarks_;
  PictureFiles pictures_;
  // Several textures may share a part.
  std::map<std::pair<const MitsubaNode*, Pixels>, Spectrum> known_;
};

}  // namespace lightwell
