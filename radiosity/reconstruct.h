#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/elements/element_tree.h"
#include "radiosity/emitters/lit_scene.h"
#include "radiosity/refine/interpolated_vertices.h"
#include "radiosity/solve.h"

namespace lightwell {

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
};

/// Pilot gathers at the vertices of elements, which each call may refine further.
class PilotGathers {
 public:
  /// For the patches of `base`, whose radiosities `solution` has. Gathered light has columns for
  /// each channel of `direct_light`; all channels together decide which elements are split. Keeps
  /// references to `scene` and `direct_light`.
  PilotGathers(const Scene& scene, PatchMesh base, const DirectLight& direct_light,
               const RadiositySolution& solution);
  ~PilotGathers();

  /// Refines the elements if `options.refine` has a tolerance, and gathers at their vertices. If
  /// its efforts limit the noise, the rays of the final gather are chosen for that. A further call
  /// with a smaller tolerance refines the same elements further. Throws InputError if the base has
  /// more elements than allowed, Interrupted when progress says stop.
  PilotGather gather(const SolveOptions& options);

  /// In place of gather() for want of time: a gather of few rays at one point of each patch, which
  /// the vertices of the base share. Caustics are left out. Throws Interrupted when progress says
  /// stop.
  PilotGather gather_at_patches(const SolveOptions& options);

  /// The mesh before refinement; may be moved from after the last pilot gather.
  PatchMesh& base();
  /// A caster of the mesh of a pilot gather; `mesh` is that mesh, wherever it was moved to.
  ElementCaster caster(const PatchMesh& mesh, const PilotGather& pilot) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Indirect light gathered so far at the vertices of a pilot gather, to which later gathers add.
/// Empty before the first.
struct KeptGather {
  std::vector<int> rays{};    ///< per vertex; 0: nothing was gathered there
  BandArray indirect{};       ///< W/m^2, vertices x columns
  Eigen::ArrayXf variance{};  ///< of `indirect`, (W/m^2)^2
  std::uint64_t count = 0;    ///< number of gathers
};

/// The gathers that reconstruct() has made so far.
struct KeptGathers {
  std::vector<int> number{};      ///< PilotGather::number of their vertices
  KeptGather of_pilot{}, last{};  ///< the second pilot gather, and the final one
};

/// The final gather at the vertices of `pilot`; the caster of `lit` is of their mesh. Fills in the
/// irradiances, gather noise and interpolation error of `solution`.
///
/// - Direct light is the pilot gather's, unless that cast fewer shadow rays than `options` ask for.
/// - Indirect light of a refined mesh is gathered twice. The pilot gather read the light of
///   unrefined elements, in the same few directions all over a surface. A second pilot gather with
///   an eighth of the rays reads the first, and the final gather reads the second.
/// - On unread_patches() there is the final gather alone, on crumbs with a 32nd of the rays.
/// - With channels, the light of each is filled in, and relight() forms the sum.
///
/// Work in `kept` (null: none) is not repeated, and new work is added to it. Throws Interrupted
/// when progress says stop.
void reconstruct(const LitScene& lit, const SolveOptions& options, const PilotGather& pilot,
                 RadiositySolution& solution, KeptGathers* kept = nullptr);

/// In place of reconstruct() for want of time: fills in the irradiances of `solution` with the
/// light of the pilot gather, and of the final gathers in `kept` at the vertices that have any
/// (null: none). Vertices that the pilot gather left out share a gather of few rays on each patch.
/// Errors are left to the error estimate: gather noise is 0, and the interpolation error is empty.
/// Throws Interrupted when progress says stop.
void take_pilot_light(const LitScene& lit, const SolveOptions& options, const PilotGather& pilot,
                      KeptGathers* kept, RadiositySolution& solution);

}  // namespace lightwell
