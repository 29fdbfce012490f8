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

/// Which of a picture's pixels count: all, or each by its opacity, where a mask cuts the rest away.
enum class Pixels { all, by_opacity };

/// A reflectance that is a picture, and its mean.
struct MitsubaTexture {
  ReflectanceTexture texture{};
  Spectrum mean{};
};

/// Spectra and textures of a Mitsuba scene as RGB bands (linear, Rec. 709). Wavelengths become r, g
/// and b as in native files: means over 600-700, 500-600 and 400-500 nm. A texture becomes the mean
/// of its colours, with a remark.
class MitsubaColors {
 public:
  MitsubaColors(const MitsubaTree& tree, Remarks& remarks) : tree_(tree), remarks_(remarks) {}

  /// A property that lies in [0,1]; what exceeds 1 is cut off, with a remark. `owner` is the plugin
  /// that has the property. Throws InputError naming file, line and value.
  Spectrum share_or(const MitsubaNode& owner, std::string_view property, float otherwise,
                    Pixels pixels);
  /// A property that is at least 0: radiance, a metal's eta and k.
  Spectrum positive_or(const MitsubaNode& owner, std::string_view property, float otherwise);
  std::optional<Spectrum> positive(const MitsubaNode& owner, std::string_view property,
                                   Pixels pixels = Pixels::all);
  /// A property that is one number, such as a roughness; of a spectrum or texture the mean.
  double number_or(const MitsubaNode& owner, std::string_view property, double otherwise);
  /// A property in [0,1] that is a bitmap or a checkerboard, scaled or not; else nothing.
  std::optional<MitsubaTexture> texture(const MitsubaNode& owner, std::string_view property,
                                        Pixels pixels);
  /// Where a mask's bitmap leaves holes; nothing if it is no bitmap. A picture's alpha counts, or,
  /// if it is opaque, its red.
  std::optional<Mask> mask(const MitsubaNode& owner, std::string_view property);

 private:
  const MitsubaNode* texture_node(const MitsubaNode& owner, std::string_view property) const;
  std::optional<MitsubaTexture> bitmap(const MitsubaNode& node, Pixels pixels);
  MitsubaTexture checkerboard(const MitsubaNode& node, Pixels pixels);
  static SurfaceTexture laid_on(const MitsubaNode& node, std::shared_ptr<const Texture> picture);
  Spectrum read(const MitsubaNode& node, Pixels pixels, int depth);
  Spectrum read_new(const MitsubaNode& node, Pixels pixels, int depth);
  Spectrum read_rgb(const MitsubaNode& node) const;
  Spectrum read_srgb(const MitsubaNode& node) const;
  Spectrum read_spectrum(const MitsubaNode& node, Pixels pixels, int depth);
  Spectrum read_blackbody(const MitsubaNode& node) const;
  Spectrum read_texture(const MitsubaNode& node, Pixels pixels, int depth);
  Spectrum read_bitmap(const MitsubaNode& node, Pixels pixels);
  Spectrum part_or(const MitsubaNode& texture, std::string_view property, float otherwise,
                   Pixels pixels, int depth);

  const MitsubaTree& tree_;
  Remarks& remarks_;
  PictureFiles pictures_;
  std::map<std::pair<const MitsubaNode*, Pixels>, Spectrum> known_;  // textures share their parts
};

}  // namespace lightwell
