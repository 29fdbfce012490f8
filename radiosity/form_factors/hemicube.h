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
  /// Cells along an edge of the top: even, 2 to 4096. Time and memory grow with its square. At 256
  /// the aliasing of a polygon that is not partly hidden is below 1e-3 of the hemisphere.
  int resolution = 256;
  /// Method for the visible surface of a cell. Both agree except for cells at edges, and on
  /// round shapes: rays meet the exact shape, scan conversion its flat elements.
  enum class BackEnd {
    scan_conversion,  ///< polygons drawn into a depth buffer; 10 to 30 times as fast
    rays              ///< a ray through each cell's centre
  };
  BackEnd back_end = BackEnd::scan_conversion;
};

/// Form factors by the hemicube (Cohen & Greenberg 1985). The eye stands at the patch's centroid,
/// and the delta form factor of a cell goes to the patch seen through the cell's centre. Behind
/// mirrors and clear glass a ray follows the path further (Sillion & Puech 1989).
///
/// Exceptions:
///   - patches with holes, and patches on which another surface lies, are sampled by rays from all
///     over the patch;
///   - in scenes with holes every cell is sampled by a ray;
///   - rows of patches that do not exchange light diffusely are empty.
///
/// One row per patch, closed up to rounding. `inverse_variance` = 1 / A_i: the view from a single
/// point is more accurate for a smaller patch, so the smaller patch's estimate of an exchange area
/// has more weight. The same bits for any number of threads. Throws std::invalid_argument for a
/// resolution out of range, and Interrupted.
///
/// `take(i, row)` gets finished rows, from many threads. Rows that `phase` holds are recalled.
void for_each_hemicube_row(const ElementCaster& caster, const LightPaths& paths,
                           const HemicubeOptions& options, const Progress& progress,
                           const std::function<void(int, const EstimatedRow&)>& take,
                           const JournalPhase& phase = {});

/// All rows of for_each_hemicube_row.
std::vector<EstimatedRow> hemicube_rows(const ElementCaster& caster, const LightPaths& paths,
                                        const HemicubeOptions& options = {},
                                        const Progress& progress = {});

}  // namespace lightwell
