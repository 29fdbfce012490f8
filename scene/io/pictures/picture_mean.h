#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "scene/texture.h"

namespace lightwell {

/// Encoding of a picture's values.
enum class PictureCode { srgb, linear };

/// Mean of a picture's pixels: the reflectance of a texture in the radiosity solution.
struct PictureMean {
  Eigen::Array3d color = Eigen::Array3d::Zero();  ///< r, g, b, linear, [0,1]
  /// Mean colour weighted by alpha; `color` if every pixel is transparent.
  Eigen::Array3d covered_color = Eigen::Array3d::Zero();
  double alpha = 1.0;
};

/// A picture's pixels as textures, and their mean.
struct Picture {
  std::shared_ptr<const Texture> color{};    ///< not null
  std::shared_ptr<const Texture> alpha{};    ///< one channel; null: opaque throughout
  std::shared_ptr<const Texture> covered{};  ///< see covered_colors(); null: opaque throughout
  PictureMean mean{};

  /// Colours for a surface, which a mask or the picture's alpha cuts if `is_cut`, and their mean.
  const std::shared_ptr<const Texture>& shown(bool is_cut) const {
    return is_cut && covered ? covered : color;
  }
  const Eigen::Array3d& mean_shown(bool is_cut) const {
    return is_cut ? mean.covered_color : mean.color;
  }
};

/// A picture of light, whose values have no bound.
struct LightPicture {
  std::shared_ptr<const Texture> color{};  ///< not null
  float brightest = 1.0f;                  ///< values are so many times those of `color`
};

/// Mean of a PNG or JPEG picture of at most 1e8 pixels; sRGB values are made linear (IEC
/// 61966-2-1). Empty for other formats (OpenEXR, Radiance HDR ...). Throws InputError "`called`
/// ..." for a picture that is damaged or too large.
std::optional<PictureMean> picture_mean(std::string_view bytes, PictureCode code,
                                        const std::string& called);

/// Decodes a picture as picture_mean() does, with all pixels.
std::optional<Picture> read_picture(std::string_view bytes, PictureCode code,
                                    const std::string& called);

/// Picture files, each decoded once for its mean and once for its pixels.
class PictureFiles {
 public:
  /// Throws InputError naming the file if it is missing or damaged.
  std::optional<PictureMean> mean(const std::filesystem::path& path, PictureCode code);
  std::optional<Picture> picture(const std::filesystem::path& path, PictureCode code);
  /// Also reads OpenEXR (.exr) and RADIANCE pictures (.hdr, .pic, .rgbe), which are linear; `code`
  /// is that of the others.
  std::optional<LightPicture> light(const std::filesystem::path& path, PictureCode code);

 private:
  std::map<std::pair<std::filesystem::path, PictureCode>, std::optional<Picture>> pictures_;
  std::map<std::pair<std::filesystem::path, PictureCode>, std::optional<PictureMean>> known_;
  std::map<std::filesystem::path, LightPicture> lights_;
};

/// Texture of one channel, 0 to 2, of a picture.
std::shared_ptr<const Texture> channel_of(const Texture& picture, int channel);
inline std::shared_ptr<const Texture> first_channel(const Texture& picture) {
  return channel_of(picture, 0);
}

/// Linear value of an sRGB value, both in [0,1] (IEC 61966-2-1).
double linear_from_srgb(double value);

}  // namespace lightwell
