#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace lightwell {

/// A part of a scene that exchanges little light with the rest, such as a room behind a door.
struct ScenePart {
  std::string name{};  ///< of the surfaces that have most of its area, such as "floor, wall"
  double area = 0.0;   ///< of its patches, m^2
  /// True if all light comes through cracks: in the space within a wall, a closed cupboard, or the
  /// outside of a house whose seams leak. Errors there are judged only where somebody looks.
  bool is_lit_by_cracks = false;
  /// Relative RMS error of interpolated irradiance, estimated as RadiositySolution::error_estimate,
  /// relative to the mean irradiance of this part. Below 0: not estimated, since the part has no
  /// light, no surface that reflects, or light through cracks alone.
  double error_estimate = -1.0;
};

/// The parts of a scene. Patches of mirrors and clear glass alone belong to none.
struct SceneParts {
  std::vector<int> of_patch{};  ///< index into `parts`, or -1 for none; empty: not known
  std::vector<ScenePart> parts{};
  /// Weight of errors on each patch, 0 to 1; empty: 1 on all.
  std::vector<float> importance{};

  float importance_of(int patch) const {
    return importance.empty() ? 1.0f : importance[static_cast<std::size_t>(patch)];
  }
  /// Groups of patches in refinement: the patches of each part that are looked at, then the others
  /// of each part.
  int group_count() const { return importance.empty() ? judged_count() : 2 * judged_count(); }
  int group_of(int patch) const {
    return judged_with(patch) + (is_looked_at(patch) ? 0 : judged_count());
  }
  /// True if errors are judged on the patch: if somebody looks at it.
  bool is_looked_at(int patch) const { return importance_of(patch) == 1.0f; }
  /// True unless the patch is lit by cracks and nobody looks at it.
  bool is_judged(int patch) const {
    const int part = count() > 1 ? of_patch[static_cast<std::size_t>(patch)] : -1;
    const bool is_by_cracks = part >= 0 && parts[static_cast<std::size_t>(part)].is_lit_by_cracks;
    return !is_by_cracks || (!importance.empty() && is_looked_at(patch));
  }
  int count() const { return static_cast<int>(parts.size()); }
  /// Number of parts that are judged each by its own light: 1 where the parts are not known.
  int judged_count() const { return count() > 1 ? count() : 1; }
  /// The part, below judged_count(), that a patch is judged with; patches of no part are judged
  /// with the first.
  int judged_with(int patch) const {
    return count() > 1 ? std::max(of_patch[static_cast<std::size_t>(patch)], 0) : 0;
  }
};

}  // namespace lightwell
