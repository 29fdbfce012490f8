#pragma once

#include "radiosity/paths/free_light.h"
#include "radiosity/solution/emitter_channels.h"
#include "radiosity/solvers/solve_radiosity.h"

namespace lightwell {

/// Emitted exitance M, W/m^2, patches x (channels * bands): the emission of each patch in the
/// columns of its channel. Without channels patches x bands.
BandArray emission_columns(const PatchMesh& mesh, const EmitterChannels& channels);

/// Values per band, repeated for every channel; `columns` long.
Eigen::ArrayXf for_each_channel(const Spectrum& of_bands, Eigen::Index columns);

/// Fills `channels` of `solution` with names, surfaces and scales of 1, and fills `patch_channel`,
/// `source_channel` and `full_emission`.
void name_channels(const Scene& scene, const PatchMesh& mesh, const EmitterChannels& channels,
                   RadiositySolution& solution);

/// Solves B = M + rho (E0 + F B) once for each channel's share of M and E0, with the same form
/// factors. Fills `channels` (all scales 1; irradiances are left to reconstruct), `patch_channel`,
/// `source_channel` and `full_emission` of `solution`, which already holds the solution for all
/// light. `free_light` has columns for every channel.
///
/// Each channel has an equal part of options.tolerance, but at least 1e-7, so that the sum of
/// channels keeps the tolerance. `residual` becomes a bound on the residual of the sum, and
/// `outcome` is that of a channel that did not converge. `options.start` has channels * bands
/// columns, or none. Throws as solve_radiosity.
void solve_channels(const Scene& scene, const PatchMesh& mesh, const FormFactors& form_factors,
                    const FreeLight& free_light, const EmitterChannels& channels,
                    SolverMethod method, const SolverOptions& options, RadiositySolution& solution);

/// Energy balance per band of patch radiosities B and of free sources, for the sums of
/// energy_balance().
BandEnergy band_energy(const Scene& scene, const PatchMesh& mesh, const FormFactors& form_factors,
                       const BandArray& B, const FreeLight& free_light);

/// Energy of free sources; empty without free sources.
FreeEnergy free_energy(const FreeLight& free_light);

}  // namespace lightwell
