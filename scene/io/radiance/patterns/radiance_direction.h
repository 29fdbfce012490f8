#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/bands.h"
#include "scene/io/radiance/patterns/radiance_data.h"
#include "scene/io/radiance/patterns/radiance_function_file.h"
#include "scene/io/radiance/text/radiance_expression.h"
#include "scene/io/radiance/text/radiance_primitive.h"

namespace lightwell {

/// A pattern of RADIANCE that depends on direction alone: brightfunc or colorfunc, such as a sky,
/// or brightdata, such as the distribution of a luminaire.
class DirectionPattern {
 public:
  /// Reads the function file and the table that the pattern names, beside the file or in `folder`
  /// (see find_radiance_file()); files of RADIANCE's library are known (see radiance_library()).
  /// Throws InputError for files that are missing or torn, and for formulas that use more than the
  /// direction and the arguments of the pattern.
  DirectionPattern(const RadiancePrimitive& pattern, const std::filesystem::path& folder);

  /// Factor of the light's radiance, r, g and b >= 0, for a ray along the unit vector `ray` towards
  /// the light, which meets the luminous surface at an angle of this cosine. 0 where the formula
  /// has no value.
  Spectrum factor(const Eigen::Vector3d& ray, double cosine) const;
  /// Equal for patterns that differ in turn() alone.
  const std::string& key() const { return key_; }
  /// Rotation or mirroring from the pattern's coordinates to those of the scene.
  const Eigen::Matrix3d& turn() const { return turn_; }

 private:
  DirectionPattern(const RadiancePrimitive& pattern, std::size_t file,
                   const std::filesystem::path& folder);

  RadianceFunctionFile functions_;
  std::string key_{};
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
  std::vector<RadianceExpression> factors_{};  // one, or of r, g and b
  std::shared_ptr<const RadianceData> data_{};
  std::vector<RadianceExpression> coordinates_{};  // of the table
};

}  // namespace lightwell
