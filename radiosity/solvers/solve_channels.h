#pragma once

#include "radiosity/paths/free_light.h"
#include "radiosity/solution/emitter_channels.h"
#include "radiosity/solvers/solve_radiosity.h"

namespace lightwell {

/// Emitted exitance M, W/m^2, patches x (channels * bands), each patch's in the columns of its
/// channel; patches x bands without channels.
BandArray emission_columns(const PatchMesh& mesh, const EmitterChannels& channels);

/// What bands have, once more for every channel: `columns` long.
Eigen::ArrayXf for_each_channel(const Spectrum& of_bands, Eigen::Index columns);

/// Fills `channels` of `solution` with names, surfaces and scales of 1, and `patch_channel`,
/// `source_channel` and `full_emission`.
void name_channels(const Scene& scene, const PatchMesh& mesh, const EmitterChannels& channels,
                   RadiositySolution& solution);

/// Solves B = M + rho (E0 + F B) once for each channel's share of M and E0 on the same form
/// factors, and fills `channels` (all scales 1; irradiances are left to reconstruct),
/// `patch_channel`, `source_channel` and `full_emission` of `solution`, which holds the solution
/// for all light together. `free_light` has columns for every channel.
///
/// No channel may be off by more than its part of options.tolerance, so that their sum keeps it
/// (but no part is below 1e-7 for being one of many); residual becomes a bound on that of the sum,
/// and outcome tells if any channel was given up. `start` of the options has channels * bands
/// columns here, or none. Throws as solve_radiosity.
void solve_channels(const Scene& scene, const PatchMesh& mesh, const FormFactors& form_factors,
                    const FreeLight& free_light, const EmitterChannels& channels,
                    SolverMethod method, const SolverOptions& options, RadiositySolution& solution);

/// Where the light of patch radiosities B went, and of free sources, as energy_balance() adds it
/// up.
BandEnergy band_energy(const Scene& scene, const PatchMesh& mesh, const FormFactors& form_factors,
                       const BandArray& B, const FreeLight& free_light);

/// What free sources gave; empty if there are none.
FreeEnergy free_energy(const FreeLight& free_light);

}  // namespace lightwell
