#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/solution/light_channel.h"
#include "scene/bands.h"

namespace lightwell {

/// accuracy_missed: it converged, but the accuracy asked for was out of reach.
enum class Outcome { converged, max_sweeps_reached, accuracy_missed };

struct StepRecord {
  double residual = 0.0;  ///< max over patches of |M + rho F B - B| relative to the largest B
  double seconds = 0.0;   ///< since the solver started
};

/// Watts (relative where the scene's light is), all bands added. emitted = absorbed + escaped +
/// unshot.
struct EnergyBalance {
  double emitted = 0.0;
  double absorbed = 0.0;  ///< by diffuse surfaces and, on the way, by mirrors and glass
  double escaped = 0.0;   ///< out of an open scene, or onto black backs
  double unshot = 0.0;    ///< what the solver left undistributed

  double from_lamps = 0.0;  ///< of `emitted`: by lamps and the sky, which are no surfaces
  double missed = 0.0;      ///< of `escaped`: theirs that met nothing at all
};

/// All bands added.
EnergyBalance total(const BandEnergy& by_band, const FreeEnergy& free = {});

struct PhaseSeconds {
  std::string phase{};
  double seconds = 0.0;
};

struct Provenance {
  std::string version{};  ///< program version that made it
  std::string scene_file{};
  std::uint64_t scene_hash = 0;
  std::string options{};     ///< the command-line equivalent of what was in force
  std::string refinement{};  ///< why the elements are no finer and no coarser; empty: not refined
};

/// A view-independent solution on a PatchMesh; also what is saved.
struct RadiositySolution {
  Bands bands{};
  double metres_per_unit = 1.0;  ///< of the scene file, for coordinates shown to people
  std::string unit_name = "m";
  /// Light is in no known unit: watts and lux here and in what is made of this are relative.
  bool relative_units = false;

  BandArray patch_radiosity{};  ///< B_i, W/m^2, patches x bands

  // Per mesh vertex, W/m^2, vertices x bands, reconstructed by a final gather.
  BandArray direct_irradiance{};    ///< straight from DirectLight's lights
  BandArray indirect_irradiance{};  ///< everything else, caustics included
  /// The part of indirect_irradiance that DirectLight's lights send by way of mirrors and glass.
  BandArray caustic_irradiance{};

  /// Per element: estimated RMS error of interpolated irradiance over it, with half of what the
  /// noise of its estimate may hide (in the square), of the mean irradiance or a quarter of the
  /// element's own, whichever is more. Empty if nobody estimated it.
  Eigen::ArrayXf interpolation_error{};
  /// Per element: estimated RMS error that the rays of the final gather leave in it, relative to
  /// the same. Empty in files of earlier versions.
  Eigen::ArrayXf gather_noise{};

  /// The light above by who emits it (see relight.h); empty: it was not kept apart.
  std::vector<LightChannel> channels{};
  // Only with channels.
  std::vector<int> patch_channel{};   ///< whose light a patch emits; -1: none
  std::vector<int> source_channel{};  ///< of each free source (see free_source_count)
  BandArray full_emission{};          ///< M_i with every scale at 1, W/m^2, patches x bands

  std::string solver{};  ///< the method that found it, or the methods; empty if read from a file
  std::vector<StepRecord> history{};
  Outcome outcome = Outcome::converged;
  double residual = 0.0;
  EnergyBalance energy{};
  /// Relative RMS error of interpolated irradiance: independent gathers at random points against
  /// the interpolation, relative to the mean irradiance or a quarter of the point's own, whichever
  /// is more.
  double error_estimate = 0.0;
  std::vector<PhaseSeconds> seconds{};
  Provenance provenance{};

  BandArray irradiance() const { return direct_irradiance + indirect_irradiance; }
};

/// A mesh and the light on it.
struct SolvedScene {
  PatchMesh mesh{};
  RadiositySolution solution{};
};

/// Per element: what irradiance anywhere in it is off by at most, with odds of about 19 to 1, mean
/// of the bands, relative as interpolation_error is: twice the root of both errors' squares. Empty
/// unless both are known.
Eigen::ArrayXf error_bound(const RadiositySolution& solution);

/// B = M + rho E at every vertex, W/m^2 (each vertex belongs to patches of one material).
BandArray vertex_radiosity(const PatchMesh& mesh, const RadiositySolution& solution);

/// Mean over each element's corners: elements x bands.
BandArray element_mean(const PatchMesh& mesh, const BandArray& vertex_values);

}  // namespace lightwell
