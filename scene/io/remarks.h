#pragma once

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
    std::vector<std::string> names{};  ///< the first few
    std::size_t count = 0;             ///< names that differ from the one before
    std::string last{};
  };
  std::vector<Remark> remarks_;
};

/// Adds a note to a scene without an emitter.
void note_if_dark(Scene& scene);

}  // namespace lightwell
