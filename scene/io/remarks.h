#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// What a reader left out or approximated, told once however often it happens: a sentence and the
/// things it holds for.
class Remarks {
 public:
  /// Notes that `what` ("textures were left out in") holds for the thing called `name`.
  void add(std::string_view what, std::string_view name);
  /// One sentence for every `what`, in the order of their first mention, with at most five names.
  std::vector<std::string> sentences() const;

 private:
  struct Remark {
    std::string what{};
    std::vector<std::string> first{};  ///< the names to list
    std::set<std::string> names{};
  };
  std::vector<Remark> remarks_;
};

/// Says of which surfaces with a picture some facets have no texture coordinates: the picture
/// counts there by its mean, and a mask not at all.
void remark_pictures_without_uv(const Scene& scene, Remarks& remarks);

/// Takes texture coordinates off surfaces whose material shows no picture.
void drop_unused_uv(Scene& scene);

/// Adds a note to a scene without an emitter.
void note_if_dark(Scene& scene);

}  // namespace lightwell
