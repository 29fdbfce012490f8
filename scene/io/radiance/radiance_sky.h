#pragma once

#include <vector>

#include "scene/io/radiance/radiance_materials.h"
#include "scene/io/radiance/text/radiance_primitive.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// The distant sources of a RADIANCE scene, which become its sky. The brightest source up to 10
/// degrees across is the sun. The others are tabulated by direction; of several that cover a
/// direction the narrowest is seen there.
class RadianceSky {
 public:
  /// Adds a source. Throws InputError for arguments that are missing or out of range.
  void add(const RadiancePrimitive& source, RadianceLight light);
  bool is_empty() const { return sources_.empty(); }
  /// Gives the scene its sky. `up` is the zenith of skies without a pattern or a hemisphere that
  /// tell theirs.
  void finish(Scene& scene, const Eigen::Vector3d& up, Remarks& remarks) const;

 private:
  struct Source {
    std::string name{};
    Sun disc{};  // up to 360 degrees across; its irradiance is not set
    RadianceLight light{};
  };
  const Source* sun() const;
  Sky dome(const std::vector<const Source*>& sources, const Sky& dark) const;

  std::vector<Source> sources_;
};

}  // namespace lightwell
