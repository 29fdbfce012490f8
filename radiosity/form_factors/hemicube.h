#pragma once

#include <functional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/form_factors/estimated_row.h"
#include "radiosity/journal/journal_phase.h"
#include "radiosity/paths/light_path.h"
#include "scene/progress.h"

namespace lightwell {

struct HemicubeOptions {
  /// Cells along an edge of the top, even, 2 to 4096; time and memory grow with its square. At 256
  /// the aliasing of a polygon that is not cut off by others is below 1e-3 of the hemisphere.
  int resolution = 256;
  /// How a cell finds what it sees. They agree but for cells at edges, and on spheres: rays meet
  /// the exact sphere, scan conversion its elements.
  enum class BackEnd {
    scan_conversion,  ///< polygons are painted into a depth buffer; 10 to 30 times as fast
    rays              ///< a ray through each cell's centre
  };
  BackEnd back_end = BackEnd::scan_conversion;
};

/// Form factors by the hemicube (Cohen & Greenberg 1985): each patch looks around from one place,
/// its centroid, and a cell's delta form factor goes to the patch seen through the cell's centre.
/// Where that is a mirror or clear glass, a ray carries it on (Sillion & Puech 1989). Patches that
/// another surface lies on, or that have holes, are sampled by rays from all over them instead;
/// where anything has holes, cells are looked through by rays. One row per
/// patch, closed but for rounding; those of patches that do not exchange light diffusely are empty.
///
/// trust = 1 / A_i: what is seen from one place is the truer the smaller the patch is, so of the
/// two estimates of an exchange area the smaller patch's counts for more. The same bits for any
/// number of threads. Throws std::invalid_argument for a resolution out of range, and Interrupted.
///
/// `take(i, row)` gets the rows as they are done, from many threads. Those that `phase` holds are
/// not done again.
void for_each_hemicube_row(const ElementCaster& caster, const LightPaths& paths,
                           const HemicubeOptions& options, const Progress& progress,
                           const std::function<void(int, const EstimatedRow&)>& take,
                           const JournalPhase& phase = {});

/// All of them.
std::vector<EstimatedRow> hemicube_rows(const ElementCaster& caster, const LightPaths& paths,
                                        const HemicubeOptions& options = {},
                                        const Progress& progress = {});

}  // namespace lightwell
