#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/solution.h"
#include "radiosity/solve.h"

namespace lightwell {

/// A point at which irradiance is measured; metres.
struct Probe {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, direction that the probe faces
};

/// Reads probes from the columns x,y,z,nx,ny,nz of a CSV file, in the scene file's units. A header
/// line names the columns; more columns are ignored. A file without header has the six numbers in
/// this order, as RADIANCE's rtrace reads them; spaces serve as well as commas. Throws InputError
/// that names file, line and value.
std::vector<Probe> read_probes(const std::filesystem::path& csv, double metres_per_unit);

/// Options of a solve for probe_irradiance alone: elements are not refined, and the error of their
/// light is not estimated.
SolveOptions options_for_probes();

/// Bounds of the error of the irradiance of probes.
struct ProbeBounds {
  /// The bound to reach, as a share of the illuminance of each probe; 0: the rays of the options,
  /// whatever noise they leave.
  double accuracy = 0.0;
  /// Per probe, lx, with odds of about 19 to 1: the noise of the gather, and the error of the
  /// solution's light that its rays read, as far as the solution knows its own error. Caustics
  /// count as uncertain by all of their light, at the brightest corner of their element. NaN where
  /// nothing is known: there is no light at all.
  Eigen::ArrayXd lux_within{};
  /// The part of `lux_within` that comes from the solution, and that probes near each other share.
  Eigen::ArrayXd read_within{};
  int missed = 0;  ///< probes whose bound exceeds `accuracy`
};

/// Irradiance at each probe, probes x bands, W/m^2, by a final gather in the solved scene. If
/// `options` leave the number of sky rays open, it is four times that of hemisphere rays. With
/// `bounds`, the gather takes about twice the time.
BandArray probe_irradiance(const Scene& scene, const ElementCaster& caster,
                           const DirectLight& direct_light, const RadiositySolution& solution,
                           std::span<const Probe> probes,
                           const GatherOptions& options = {.rays = 1024},
                           ProbeBounds* bounds = nullptr);

/// Irradiance at each probe, probes x bands, W/m^2, interpolated on the solution's mesh. Throws
/// InputError that names the first probe that lies on no surface facing its way, within 1e-4 of the
/// scene's diagonal (at most 2 cm, or 2e-6 of it), or on the back of a one-sided surface.
BandArray interpolate_irradiance(const ElementCaster& caster, const RadiositySolution& solution,
                                 std::span<const Probe> probes);

/// Bound on the error of interpolate_irradiance(), lx, one per probe, with odds of about 19 to 1
/// (see error_bound). Empty if the solution has no error estimate. Throws as
/// interpolate_irradiance().
Eigen::ArrayXd interpolation_bound(const ElementCaster& caster, const RadiositySolution& solution,
                                   std::span<const Probe> probes);

/// Numbers of the probes that lie on no surface, and less than ten times that reach behind
/// one that faces their way, so that they see its back: points at the height of a floor whose model
/// is uneven.
std::vector<int> probes_behind_surfaces(const ElementCaster& caster, std::span<const Probe> probes);

/// Writes columns x,y,z,nx,ny,nz,E_<band>...,lux and, unless `lux_within` is empty, lux_within, in
/// which NaN leaves a cell empty; coordinates are in file units. The file is written under a
/// temporary name and renamed. Throws std::runtime_error that names the file.
void write_probes(const std::filesystem::path& csv, std::span<const Probe> probes,
                  const BandArray& irradiance, const Bands& bands, double metres_per_unit,
                  const Eigen::ArrayXd& lux_within = {});

}  // namespace lightwell
