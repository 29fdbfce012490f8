#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "radiosity/emitters/lit_scene.h"
#include "radiosity/solve.h"

namespace lightwell {

/// What a first, cheap gather finds at vertices. It sharpens what patches hold as one value each
/// (the dark foot of a block): later gathers read it.
struct PilotGather {
  std::optional<PatchMesh> refined{};  ///< whose vertices are meant, if not the base's
  /// Where its elements are in the base's, wherever it is moved to; null: nothing was refined.
  std::shared_ptr<const ElementTree> tree{};
  BandArray direct{}, indirect{};        ///< W/m^2, vertices x bands
  ShadowOptions shadows{};               ///< that `direct` was gathered with
  BandArray caustic{};                   ///< the same; empty if the scene has no mirrors or glass
  Eigen::ArrayXf interpolation_error{};  ///< see RadiositySolution; empty without refinement
  RefineReport refinement{};
  std::vector<InterpolatedVertex> interpolated{};  ///< where later gathers leave indirect light out
  std::vector<VertexPrediction>
      predictions{};  ///< what `indirect` is good for beside the final gather
  /// Per vertex, what it is called in later pilot gathers of the same elements too; empty without
  /// refinement.
  std::vector<int> number{};
  int gather_rays = 0;  ///< that the final gather is to take
};

/// First gathers at the vertices of elements that are refined ever further.
class PilotGathers {
 public:
  /// Over patches whose radiosities `solution` has; `direct_light` keeps apart its channels, if
  /// there are any, and what is gathered has columns for each. Elements are split as all light
  /// together asks for. With `noise` above 0 pilot gathers of refined elements say how many rays
  /// the final gather takes to leave no larger a share of the mean irradiance. Keeps references to
  /// `scene` and `direct_light`.
  PilotGathers(const Scene& scene, PatchMesh base, const DirectLight& direct_light,
               const RadiositySolution& solution, double noise = 0.0);
  ~PilotGathers();

  /// Refines the elements, if options.refine says so, and gathers at their vertices. Called again,
  /// with a smaller tolerance, it goes on where it ended.
  PilotGather gather(const SolveOptions& options);

  /// The mesh that pilot gathers without refinement are of; may be moved from after the last pilot
  /// gather.
  PatchMesh& base();
  /// Of the mesh that a pilot gather is of, wherever that was moved to.
  ElementCaster caster(const PatchMesh& mesh, const PilotGather& pilot) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What gathers have found so far at the vertices of a pilot gather, or nothing: more is added to
/// it. Of indirect light, W/m^2, columns of every channel.
struct KeptGather {
  std::vector<int> rays{};  ///< 0: none there
  BandArray indirect{};
  Eigen::ArrayXf variance{};  ///< of it
  std::uint64_t count = 0;    ///< of gathers
};

/// Of those that read the pilot gather, and of the final ones.
struct KeptGathers {
  std::vector<int> number{};  ///< the pilot gather's
  KeptGather of_pilot{}, last{};
};

/// The final gather; `caster` is of the mesh whose vertices the pilot gather is for. The direct
/// light of a refined mesh has been gathered for good; its indirect light was found in that of
/// unrefined elements, and in the same few directions all over a surface. A gather with an eighth
/// of the rays makes that good, and the final one reads it. With channels it is theirs that is
/// filled in; their sum is left to relight(). What `kept` has is not gathered again.
void reconstruct(const LitScene& lit, const SolveOptions& options, const PilotGather& pilot,
                 RadiositySolution& solution, KeptGathers* kept = nullptr);

}  // namespace lightwell
