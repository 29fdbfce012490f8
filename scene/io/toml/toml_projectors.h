#pragma once

#include <map>
#include <memory>

#include "scene/io/pictures/picture_mean.h"
#include "scene/io/toml/toml_spectra.h"
#include "scene/io/toml/toml_value.h"
#include "scene/projected_picture.h"

namespace lightwell {

/// A picture before a lamp, and the brightness of its white.
struct TomlProjector {
  std::shared_ptr<const ProjectedPicture> picture{};
  float brightest = 1.0f;  ///< values are so many times those of `picture`
};

/// The pictures that the [[lamps]] tables of a scene project. Lamps share what they project.
class TomlProjectors {
 public:
  explicit TomlProjectors(const TomlBands& bands) : basis_(bands.bands) {}

  /// The projector of a lamp's keys 'picture', 'beam', 'focus', 'lens' and 'shutters'. Throws
  /// InputError at the key: a file that is missing, damaged, no picture or too large; optics out of
  /// range; shutters that leave nothing; keys of other distributions.
  TomlProjector read(const TomlTable& lamp, double metres_per_unit);

 private:
  std::shared_ptr<const PictureSums> slide(const TomlValue& file,
                                           const std::shared_ptr<const Texture>& picture);

  RgbBasis basis_;
  PictureFiles files_{};
  std::map<const Texture*, std::shared_ptr<const PictureSums>> slides_{};
};

}  // namespace lightwell
