#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/solution.h"
#include "radiosity/solve.h"

namespace lightwell {

/// Where and facing which way irradiance is wanted; metres.
struct Probe {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// Reads columns x,y,z,nx,ny,nz (a header line names them; more columns are ignored) in the scene
/// file's units. Throws InputError naming file, line and value.
std::vector<Probe> read_probes(const std::filesystem::path& csv, double metres_per_unit);

/// A solve that finds what probe_irradiance reads and nothing else: no mesh of elements refined to
/// be looked at, no estimate of its error.
SolveOptions options_for_probes();

/// Irradiance (W/m^2) at each probe, probes x bands: a fresh gather of the solved scene.
BandArray probe_irradiance(const Scene& scene, const ElementCaster& caster,
                           const DirectLight& direct_light, const RadiositySolution& solution,
                           std::span<const Probe> probes,
                           const GatherOptions& options = {.rays = 1024});

/// The same by mesh interpolation; probes must lie on a surface (within 1e-4 of the scene's
/// diagonal). Throws InputError naming the first probe that does not.
BandArray interpolate_irradiance(const ElementCaster& caster, const RadiositySolution& solution,
                                 std::span<const Probe> probes);

/// What that is off by at most, with odds of about 19 to 1 (see error_bound): lux, one per probe.
/// Empty if the solution does not know.
Eigen::ArrayXd interpolation_bound(const ElementCaster& caster, const RadiositySolution& solution,
                                   std::span<const Probe> probes);

/// Writes x,y,z,nx,ny,nz,E_<band>...,lux and, unless it is empty, lux_within; coordinates in file
/// units. Temporary name, then renamed.
void write_probes(const std::filesystem::path& csv, std::span<const Probe> probes,
                  const BandArray& irradiance, const Bands& bands, double metres_per_unit,
                  const Eigen::ArrayXd& lux_within = {});

}  // namespace lightwell
