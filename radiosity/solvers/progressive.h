#pragma once

#include <functional>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include "radiosity/form_factors/estimated_row.h"
#include "radiosity/paths/free_light.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solution/emitter_channels.h"
#include "radiosity/solution/solution.h"
#include "scene/progress.h"

namespace lightwell {

class JournalPhase;

/// A patch that shoots, and with how many rays if it comes to rays.
struct RowRequest {
  int patch = 0;
  int rays = 0;
};

/// Finds where all that leaves some patches goes: rows[k] for requests[k]. Rows are not kept, so
/// progressive refinement needs memory for the mesh alone.
using ShotRows =
    std::function<void(std::span<const RowRequest> requests, std::span<EstimatedRow> rows)>;

/// Rows by rays from all over the shooter, cast when they are needed and forgotten afterwards.
/// Keeps references to both.
ShotRows cast_shots(const ElementCaster& caster, const LightPaths& paths, int most_rays);

/// Rows of form factors that are there already. Keeps a reference.
ShotRows stored_shots(const FormFactors& form_factors);

enum class Overshooting {
  none,
  /// Shooters send what the ambient term foretells that they will still receive, on top of what
  /// they have; what turns out too much is taken back later, as negative light (Feda & Purgathofer
  /// 1992).
  ambient
};

struct ProgressiveOptions {
  /// Ends when the power that is still unshot, of all patches and bands without regard to sign,
  /// falls below this share of what is emitted.
  double tolerance = 1e-3;
  int max_shots = 1 << 24;  ///< a fuse
  /// Rays that carry all that is emitted. Every shooter gets its share by power, so each ray
  /// carries about the same and noise is even; what is reflected takes about as many again.
  double rays = 1 << 20;
  int most_rays = 1 << 16;  ///< of one shot
  Overshooting overshooting = Overshooting::none;
};

/// Progressive refinement (Cohen, Chen, Wallace & Greenberg 1988): the patches that hold most
/// unshot power shoot it to all that they see, again and again. Useful after the first shots, and
/// needs neither form factors in advance nor memory for them.
///
/// Shooters go in rounds of 16, and of 1/128 of the patches where those are many, so that their
/// rows can be found side by side; what they do to each other counts from the next round on. The
/// result is the same for any number of threads. Keeps references to scene and mesh.
///
/// With `channels`, light of each is kept apart in columns of its own, as by DirectLight; all of
/// them are shot at once by the same rays. Light has channels * bands columns below.
class ProgressiveRadiosity {
 public:
  struct Shot {
    int patch = 0;
    Eigen::ArrayXf radiosity{};  ///< what it sent out in each column, W/m^2
  };

  /// What patches reflect of `free_light`, which has as many columns, is there to be shot from the
  /// start. Throws std::invalid_argument if a patch has no area.
  ProgressiveRadiosity(const Scene& scene, const PatchMesh& mesh, ShotRows rows,
                       const ProgressiveOptions& options = {}, const EmitterChannels& channels = {},
                       const FreeLight& free_light = {});

  /// One round, of at most `most` shooters (1: the single brightest). False, having done nothing,
  /// once the tolerance or the fuse is reached.
  bool step(int most = std::numeric_limits<int>::max());

  /// Who shot in the last round: what an observer passes on to vertices, or shows.
  const std::vector<Shot>& last_shots() const { return last_shots_; }
  int shots() const { return shots_; }
  /// B_i so far, without the ambient term, patches x columns, W/m^2.
  const BandArray& radiosity() const { return radiosity_; }
  /// The part of it that has not been shot yet; negative where too much was.
  const BandArray& unshot() const { return unshot_; }
  /// Unshot power over emitted power, all bands together, without regard to sign.
  double unshot_share() const;
  /// How far on the way to the tolerance, [0,1], by powers of ten.
  double done() const;
  bool has_converged() const { return unshot_share() <= options_.tolerance; }
  /// Radiosity that all surfaces would add for every unit of reflectance if the unshot light were
  /// spread evenly at once: rho_i times this belongs to what a picture shows meanwhile (Cohen et
  /// al. 1988, section 5).
  Eigen::ArrayXf ambient() const;
  /// Where the light went so far.
  EnergyBalance energy() const;
  /// What a solution holds of the patches as they are now: patch_radiosity, channels, solver
  /// ("progressive"), residual (max |unshot| over max B), outcome and energy.
  RadiositySolution solution() const;
  /// All that changes from step to step: what is kept of it, to go on from there.
  auto state() { return std::tie(radiosity_, unshot_, energy_, shots_); }

 private:
  void take_in(const FreeLight& free_light);
  BandEnergy energy_by_column() const;
  std::vector<int> choose(int most) const;
  int rays_of(int patch) const;
  void receive(const Shot& shot, const EstimatedRow& row);

  const Scene& scene_;
  const PatchMesh& mesh_;
  ShotRows rows_;
  ProgressiveOptions options_;
  EmitterChannels channels_;
  BandArray radiosity_, unshot_;
  Spectrum reflections_{};  // 1 / (1 - mean reflectance), per band
  double emitted_ = 0.0;    // W, all columns together
  BandEnergy energy_{};     // of each column, without what is unshot
  FreeEnergy free_energy_{};
  std::vector<Shot> last_shots_{};
  int shots_ = 0;
};

/// Shoots until step() has no more to do. The result is solution() with its history, a record a
/// round; without channels max |M + rho F B - B| over max B is never above its residual. Throws
/// Interrupted when progress says stop. Goes on from the state that `phase` holds, and keeps there
/// where it has got to.
RadiositySolution shoot_to_the_end(ProgressiveRadiosity& progressive, const Progress& progress = {},
                                   JournalPhase* phase = nullptr);

}  // namespace lightwell
