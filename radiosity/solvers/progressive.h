#pragma once

#include <functional>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include "radiosity/form_factors/estimated_row.h"
#include "radiosity/paths/free_light.h"
#include "radiosity/solution/emitter_channels.h"
#include "radiosity/solution/solution.h"
#include "scene/progress.h"

namespace lightwell {

class JournalPhase;
class LightPaths;
class MirroredShares;

/// A shooting patch, and its number of rays where rows are sampled by rays.
struct RowRequest {
  int patch = 0;
  int rays = 0;
};

/// Computes the rows of shooting patches: rows[k] for requests[k]. Rows are not stored, so
/// progressive refinement needs memory for the mesh alone.
using ShotRows =
    std::function<void(std::span<const RowRequest> requests, std::span<EstimatedRow> rows)>;

/// Rows by rays from all over the shooter, cast on demand. Keeps references to caster and paths.
ShotRows cast_shots(const ElementCaster& caster, const LightPaths& paths, int most_rays);

/// Rows of stored form factors. Keeps a reference.
ShotRows stored_shots(const FormFactors& form_factors);

enum class Overshooting {
  none,
  /// Shooters also send the light that the ambient term predicts for them. Any excess is taken back
  /// later as negative light (Feda & Purgathofer 1992).
  ambient
};

struct ProgressiveOptions {
  /// Share of the emitted power below which the unshot power ends the shooting; absolute values
  /// summed over all patches and bands.
  double tolerance = 1e-3;
  int max_shots = 1 << 24;  ///< upper limit of shots
  /// Rays for all emitted light. Every shooter gets rays in proportion to its power, so all rays
  /// carry about the same and noise is even. Reflected light takes about as many rays again.
  double rays = 1 << 20;
  int most_rays = 1 << 16;  ///< most rays of one shot
  Overshooting overshooting = Overshooting::none;
};

/// Progressive refinement (Cohen, Chen, Wallace & Greenberg 1988): repeatedly, the patches of the
/// most unshot power shoot it to all patches they see. Useful after the first shots. Needs neither
/// form factors in advance nor memory for them.
///
/// A round has 16 shooters, or 1/128 of the patches if that is more, so that rows can be computed
/// in parallel. Light between shooters of a round counts from the next round on. The result is the
/// same for any number of threads. Keeps references to scene and mesh.
///
/// Light of each of `channels` has columns of its own, as in DirectLight; the same rays shoot all
/// columns. Light has channels * bands columns below.
class ProgressiveRadiosity {
 public:
  struct Shot {
    int patch = 0;
    Eigen::ArrayXf radiosity{};  ///< radiosity shot, per column, W/m^2
  };

  /// The reflected part of `free_light`, which has as many columns, is unshot at the start. Throws
  /// std::invalid_argument if a patch has no area.
  ProgressiveRadiosity(const Scene& scene, const PatchMesh& mesh, ShotRows rows,
                       const ProgressiveOptions& options = {}, const EmitterChannels& channels = {},
                       const FreeLight& free_light = {});

  /// Shoots one round of at most `most` shooters (1: the single brightest). Returns false, having
  /// done nothing, once the tolerance or max_shots is reached.
  bool step(int most = std::numeric_limits<int>::max());

  /// Shots of the last round, for observers.
  const std::vector<Shot>& last_shots() const { return last_shots_; }
  int shots() const { return shots_; }
  /// B_i so far, without the ambient term, patches x columns, W/m^2.
  const BandArray& radiosity() const { return radiosity_; }
  /// The unshot part of radiosity(); negative where too much was shot.
  const BandArray& unshot() const { return unshot_; }
  /// Unshot power over emitted power, absolute values summed over all bands.
  double unshot_share() const;
  /// Progress towards the tolerance on a logarithmic scale, [0, 1].
  double done() const;
  bool has_converged() const { return unshot_share() <= options_.tolerance; }
  /// Ambient irradiance: rho_i times this is the radiosity of patch i if the unshot light were
  /// spread evenly, reflections included. Completes interim pictures (Cohen et al. 1988, section
  /// 5). W/m^2 per column.
  Eigen::ArrayXf ambient() const;
  /// Energy balance so far.
  EnergyBalance energy() const;
  /// The patches' part of a solution at present: patch_radiosity, channels, solver ("progressive"),
  /// residual (max |unshot| over max B), outcome and energy.
  RadiositySolution solution() const;
  /// All variables that change from step to step, kept to resume from.
  auto state() { return std::tie(radiosity_, unshot_, energy_, shots_); }

 private:
  void take_in(const FreeLight& free_light);
  BandEnergy energy_by_column() const;
  std::vector<int> choose(int most) const;
  int rays_of(int patch) const;
  MirroredShares mirrored_of(const EstimatedRow& row) const;
  float scatter(int j, Eigen::Index column, Eigen::Index band, float E);
  void receive(const Shot& shot, const EstimatedRow& row);

  const Scene& scene_;
  const PatchMesh& mesh_;
  ShotRows rows_;
  ProgressiveOptions options_;
  EmitterChannels channels_;
  BandArray radiosity_, unshot_;
  Spectrum reflections_{};  // 1 / (1 - mean reflectance), per band
  double emitted_ = 0.0;    // W, all columns together
  BandEnergy energy_{};     // per column, unshot light excluded
  FreeEnergy free_energy_{};
  std::vector<Shot> last_shots_{};
  int shots_ = 0;
};

/// Shoots until step() returns false. The result is solution() with its history, one record per
/// round. Without channels max |M + rho F B - B| over max B never exceeds the record's residual.
/// Throws Interrupted if `progress` requests a stop. Resumes from the state that `phase` holds, and
/// keeps its state there.
RadiositySolution shoot_to_the_end(ProgressiveRadiosity& progressive, const Progress& progress = {},
                                   JournalPhase* phase = nullptr);

}  // namespace lightwell
