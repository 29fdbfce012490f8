#pragma once

#include "mesh/elements/element_caster.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solution/scene_parts.h"
#include "scene/progress.h"
#include "scene/scene.h"

namespace lightwell {

/// Finds the parts of a scene that exchange little light: rooms behind doors, the ground outside
/// windows, the insides of large cabinets.
///
/// 1. Cosine-distributed rays from each patch estimate the exchange A_i F_ij; mirrors and glass
///    pass the rays on. Patches of which 70 % of the rays leave the scene, or 40 % and those of the
///    facet as a whole, count as one, the outside. Rays that end on a backdrop leave the scene: a
///    surface ten times as large as the box of all that is less than a tenth as large, and far
///    around this box but for one side, such as a dome that stands for the sky.
/// 2. cut_graph() parts the patches where the exchange is less than 5 % of the smaller side's area
///    and where the passage is a bottleneck. What is left with the outside is cut without it, and
///    rooms that lose at most a fifth of their light to what lies outside, and are not larger than
///    the outside, are parts.
/// 3. These join the part that they exchange most with; without such, the largest:
///     * a part of fewer than four patches, or of less than 1/1024 of all area but the outside;
///     * a crack: the mean length of the rays within is below 1/32 of the root of the area;
///     * a hollow, such as the inside of a drawer or a column: area below 1/20, and mean length of
///       the rays within below 1/5, of those of the largest part that is no outside.
///
///    Patches that see nothing, such as those under a block that stands on them, join the largest.
///
/// 4. ScenePart::is_lit_by_cracks is set for a part that exchanges less than 1/200 of its area, or
///    of all other area if that is less, with parts that are none of these cavities, and that
///     * has no light of its own: no surface that emits, no eighth of what arrives of a lamp, and,
///       unless most of its rays end within, no sky or sun;
///     * is no room: most of its rays leave it, or the mean length of those that end within is
///     below
///       1/3 of that in the largest part that is no outside.
///
/// The sides of a two-sided surface are patches of their own, so the outside of a house is a part.
/// Parts are in falling order of area. The largest part is the first. The result depends on neither
/// units nor threads. Throws Interrupted when progress says stop.
SceneParts find_parts(const Scene& scene, const ElementCaster& caster, const LightPaths& paths,
                      const Progress& progress = {});

}  // namespace lightwell
