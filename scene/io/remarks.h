#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Collects the approximations and omissions of a reader: one sentence for each kind, with the
/// names of the objects concerned.
class Remarks {
 public:
  /// Records that `what` ("textures were left out in") concerns the object `name`.
  void add(std::string_view what, std::string_view name);
  /// One sentence for every `what`, in the order of first mention, with at most five names.
  std::vector<std::string> sentences() const;

 private:
  struct Remark {
    std::string what{};
    std::vector<std::string> first{};  ///< the names to list
    std::set<std::string> names{};
  };
  std::vector<Remark> remarks_;
};

/// Adds a remark on surfaces whose material has a picture or a mask and whose facets lack texture
/// coordinates: there the mean of the picture is used, and no mask.
void remark_pictures_without_uv(const Scene& scene, Remarks& remarks);

/// Removes texture coordinates from surfaces whose material has neither picture nor mask.
void drop_unused_uv(Scene& scene);

/// Adds a note if the scene has no light source.
void note_if_dark(Scene& scene);

}  // namespace lightwell
