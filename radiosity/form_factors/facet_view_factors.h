#pragma once

#include <functional>
#include <optional>

#include "mesh/cleaning/facet_check.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/form_factors/view_factor_rows.h"
#include "radiosity/form_factors/view_factors.h"
#include "scene/io/numbered_scene.h"

namespace lightwell {

/// Options of view factors between the facets of a file.
struct FacetViewFactorOptions {
  FormFactorMethod method = FormFactorMethod::automatic;
  double target_error = 1e-3;   ///< wanted standard error of every factor, > 0
  double max_patch_size = 0.0;  ///< m: a row for each patch of at most this edge; 0: for each facet
  int hemicube_resolution = 256;  ///< see FormFactorOptions
  bool two_sided = false;         ///< backs of facets have rows
  MemoryOptions memory{};
  Progress progress{};
  Processes* processes = nullptr;  ///< see RunControl
  /// Called with the rows before their factors are computed, to stop early by an exception.
  std::function<void(const ViewFactorRows& rows)> rows_found{};
  /// Called at the end of each phase, "mesh" and "form_factors", once or twice.
  std::function<void(const char* phase)> phase_done{};
};

/// View factors between the facets of a file, or between their patches.
struct FacetViewFactors {
  PatchMesh mesh{};
  ViewFactorRows rows{};
  ViewFactors factors{0};
  FormFactorReport report{};
  std::optional<double> error{};  ///< estimated error of the worst factor; empty: no estimate
  /// True if `automatic` fell back on counts of rays: facets that cross each other by the dozen are
  /// cut into very many patches.
  bool has_rays_alone = false;
  StorageReport storage{};

  /// True if the estimated error exceeds the target.
  bool is_short(double target_error) const { return error && *error > target_error; }
};

/// Computes view factors. The mesh suits the method: ray casting samples a facet as one patch; a
/// hemicube has one centre per patch, and a closed form few shadow rays per pair of patches, so
/// both are summed over smaller patches.
///
/// Throws InputError for a scene without facets and as compute_form_factors() does, Interrupted if
/// `progress` requests a stop.
FacetViewFactors facet_view_factors(const NumberedScene& numbered, const FacetCheck& check,
                                    const FacetViewFactorOptions& options = {});

}  // namespace lightwell
