#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mesh/elements/element_tree.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/refine/interpolated_vertices.h"
#include "radiosity/solve.h"

namespace lightwell {

/// SolveOptions::gather under the control of SolveOptions::run.
GatherOptions gather_options(const SolveOptions& options);

/// Rays of the final gather in each part that is judged.
std::vector<int> rays_by_part(const SolveOptions& options);

/// A first, cheap gather at vertices. Its light resolves details smaller than a patch (such as the
/// dark foot of a block), and later gathers read that light.
struct PilotGather {
  std::optional<PatchMesh> refined{};  ///< the refined mesh; empty: the base is not refined
  /// Finds the refined element at a point of a base element; null without refinement.
  std::shared_ptr<const ElementTree> tree{};
  BandArray direct{}, indirect{};        ///< W/m^2, vertices x columns
  ShadowOptions shadows{};               ///< those of `direct`
  BandArray caustic{};                   ///< W/m^2; empty if the scene has no mirrors or glass
  bool lacks_unread = false;             ///< indirect light is 0 on unread_patches()
  Eigen::ArrayXf interpolation_error{};  ///< see RadiositySolution; empty without refinement
  RefineReport refinement{};
  std::vector<InterpolatedVertex> interpolated{};  ///< later gathers leave indirect light out here
  std::vector<VertexPrediction> predictions{};     ///< joined with the final gather
  /// SharedGathers::unread, whose entries are also in `interpolated`, and SharedGathers::rough.
  std::vector<InterpolatedVertex> unread{};
  std::vector<int> rough{};
  /// Per vertex, its number in RefinedElements, which later pilot gathers share; empty without
  /// refinement.
  std::vector<int> number{};
  std::vector<int> gather_rays{};  ///< rays of the final gather in each part

  /// Indirect light and caustics, W/m^2, vertices x columns.
  BandArray beside_direct() const {
    BandArray sum = indirect;
    if (caustic.size() > 0) sum += caustic;
    return sum;
  }
};

/// Pilot gathers at the vertices of elements, which each call may refine further.
class PilotGathers {
 public:
  /// Gathers for the patches of `base`, whose radiosities `solution` has. Gathered light has
  /// columns for each channel of `direct_light`; all channels together decide which elements are
  /// split. Keeps references to `scene` and `direct_light`.
  PilotGathers(const Scene& scene, PatchMesh base, const DirectLight& direct_light,
               const RadiositySolution& solution);
  ~PilotGathers();

  /// Refines the elements if `options.refine` has a tolerance, and gathers at their vertices. If
  /// its efforts limit the noise, the rays of the final gather are chosen for that. A further call
  /// with a smaller tolerance refines the same elements further. Empty in limited time if the pace
  /// of the gather at the base tells that it would not be ready. Throws InputError if the base has
  /// more elements than allowed, Interrupted when progress says stop.
  std::optional<PilotGather> gather(const SolveOptions& options);

  /// Light at the vertices of the base, for want of time in place of gather(): what a gather() that
  /// was stopped has found there. If that one was stopped too early, or light is kept apart by
  /// channels, without caustics: indirect light by a gather of few rays at one point of each patch,
  /// which the vertices of the base share, and direct light by few rays at vertices, of crumbs at
  /// their records, or at the points of patches if there is not enough time for that. Throws
  /// Interrupted when progress says stop.
  PilotGather gather_in_haste(const SolveOptions& options);

  /// The mesh before refinement; may be moved from after the last pilot gather.
  PatchMesh& base();
  /// A caster of the mesh of a pilot gather; `mesh` is that mesh, wherever it was moved to.
  ElementCaster caster(const PatchMesh& mesh, const PilotGather& pilot) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
