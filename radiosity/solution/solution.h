#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/solution/light_channel.h"
#include "radiosity/solution/scene_parts.h"
#include "scene/bands.h"

namespace lightwell {

/// Reason for the end of a solve. accuracy_missed: converged, but short of the requested accuracy.
enum class Outcome {
  converged,
  max_sweeps_reached,
  accuracy_missed,
  cut_short  ///< the time was up, or somebody stopped the solve, before it was finished
};

/// Residual of a solver after a step.
struct StepRecord {
  double residual = 0.0;  ///< max over patches of |M + rho F B - B| relative to the largest B
  double seconds = 0.0;   ///< since the solver started
};

/// Energy balance in watts (relative if the scene's light is), sum of all bands: emitted = absorbed
/// + escaped + unshot.
struct EnergyBalance {
  double emitted = 0.0;
  double absorbed = 0.0;  ///< by diffuse surfaces and, on the way, by mirrors and glass
  double escaped = 0.0;   ///< out of an open scene, or onto black backs
  double unshot = 0.0;    ///< left undistributed by the solver

  double from_lamps = 0.0;  ///< part of `emitted`: by lamps and the sky, which are no surfaces
  double missed = 0.0;      ///< part of `escaped`: light of lamps and the sky that met nothing
};

/// Sum over all bands.
EnergyBalance total(const BandEnergy& by_band, const FreeEnergy& free = {});

/// Wall time of a phase of the solve.
struct PhaseSeconds {
  std::string phase{};
  double seconds = 0.0;
};

/// Origin of a solution.
struct Provenance {
  std::string version{};  ///< version of the program
  std::string scene_file{};
  std::uint64_t scene_hash = 0;
  std::string options{};     ///< effective options, as on the command line
  std::string refinement{};  ///< reason for the fineness of the elements; empty: not refined
  /// Cameras and files of places from which the surfaces are seen that the error estimate is of;
  /// empty: it is of all surfaces.
  std::vector<std::string> looked_from{};
};

/// A view-independent solution on a PatchMesh, as in a solution file.
struct RadiositySolution {
  Bands bands{};
  double metres_per_unit = 1.0;  ///< unit of the scene file, for coordinates shown to users
  std::string unit_name = "m";
  /// True if light has no known unit: watts and lux of the solution, and of all derived from it,
  /// are relative.
  bool relative_units = false;

  BandArray patch_radiosity{};  ///< B_i, W/m^2, patches x bands

  // Irradiance per mesh vertex, W/m^2, vertices x bands, reconstructed by a final gather.
  BandArray direct_irradiance{};    ///< directly from the lights of DirectLight
  BandArray indirect_irradiance{};  ///< all other light, caustics included
  /// Part of indirect_irradiance that arrives from the lights of DirectLight through mirrors and
  /// glass.
  BandArray caustic_irradiance{};

  /// Per element: estimated RMS error of interpolated irradiance over the element, relative to the
  /// mean irradiance of its part or a quarter of the element's own, whichever is more. The square
  /// includes half of the squared error that noise of the estimate may hide. Empty without an
  /// estimate.
  Eigen::ArrayXf interpolation_error{};
  /// Per element: estimated RMS error from the rays of the final gather, relative to the same
  /// reference. Empty in files of earlier versions.
  Eigen::ArrayXf gather_noise{};

  /// The light above by emitter (see relight.h); empty: not kept by channel.
  std::vector<LightChannel> channels{};
  // Only with channels:
  std::vector<int> patch_channel{};   ///< channel of each patch's emission; -1: none
  std::vector<int> source_channel{};  ///< channel of each free source (see free_source_count)
  BandArray full_emission{};          ///< M_i with all scales 1, W/m^2, patches x bands

  std::string solver{};  ///< name of the solver or solvers; empty if read from a file
  std::vector<StepRecord> history{};
  Outcome outcome = Outcome::converged;
  double residual = 0.0;
  EnergyBalance energy{};
  /// Parts of the scene that exchange little light, each with its own error estimate; empty in
  /// files of earlier versions. Errors are relative to the mean irradiance of the part that the
  /// error is in.
  SceneParts parts{};
  /// Relative RMS error of interpolated irradiance: independent gathers at random points against
  /// the interpolation, relative to the mean irradiance of the part or a quarter of the point's
  /// own, whichever is more. With several parts, the largest of their estimates.
  double error_estimate = 0.0;
  std::vector<PhaseSeconds> seconds{};
  Provenance provenance{};

  BandArray irradiance() const { return direct_irradiance + indirect_irradiance; }
};

/// A mesh and its solution.
struct SolvedScene {
  PatchMesh mesh{};
  RadiositySolution solution{};
};

/// Per element: bound of the error of irradiance anywhere in the element, mean of the bands, with
/// odds of about 19 to 1: 2 sqrt(interpolation_error^2 + gather_noise^2), relative to the same
/// reference. Empty unless both are known.
Eigen::ArrayXf error_bound(const RadiositySolution& solution);

/// B = M + rho E at every vertex, W/m^2 (each vertex belongs to patches of one material).
BandArray vertex_radiosity(const PatchMesh& mesh, const RadiositySolution& solution);

/// Mean over the corners of each element: elements x bands.
BandArray element_mean(const PatchMesh& mesh, const BandArray& vertex_values);

}  // namespace lightwell
