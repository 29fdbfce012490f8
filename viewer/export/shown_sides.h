#pragma once

#include <cstdint>
#include <vector>

#include "viewer/export/appearance.h"
#include "viewer/export/baked_model.h"

namespace lightwell {

enum class SideUse : std::uint8_t { left_out, in_place, moved };

/// Half the distance between two sides that are moved apart, m: 0.5 mm, less in models of less
/// than 5 m.
double half_gap(const PatchMesh& mesh);

/// Decides for each element whether a model of `sides` has it. `caster` is of the solution's mesh.
/// `kinds` count a side as lit by a channel that is off. For front and both:
///
/// - A side is dark if its illuminance is below 1e-4 of the mean of the sides that are not outside.
///   It is shut in if it sees dark sides alone, such as the inside of a chest. A side that is both
///   counts as unlit. If both sides are, such as of a chest's bottom on the floor, both are left
///   out.
/// - front: a side is outside if more than a quarter of the light that leaves it would leave the
///   scene, and if the other side loses less than half as much. It is left out if no camera,
///   looking around at its place, sees it, and if the other side has light.
///
/// Shares are those of 64 rays from each patch; panes of clear glass stop them, but no camera's
/// view.
std::vector<SideUse> choose_sides(const SolvedScene& solved, const Scene& scene,
                                  const ElementCaster& caster,
                                  const std::vector<ElementKind>& kinds, Sides sides);

}  // namespace lightwell
