#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Sets `transmittance` and `behind` of a mesh of `scene`.
void set_transmittance(const Scene& scene, PatchMesh& mesh);

/// The patch on the other side of each patch of a translucent material; -1: nothing passes to it.
/// Empty if nothing is translucent.
std::vector<int> patches_behind(const PatchMesh& mesh);

/// The vertex on the other side of each vertex of a translucent surface; -1 elsewhere. Empty if
/// nothing is translucent.
std::vector<int> vertices_behind(const PatchMesh& mesh);

/// True if a patch reflects light diffusely or passes light of its other side.
bool scatters(const PatchMesh& mesh, int patch);

/// Share of even light on both sides that a patch scatters, rho + tau.
Spectrum scattered_share(const PatchMesh& mesh, int patch);

/// Radiosity without emission, rho E + tau E_behind, W/m^2, from the irradiance of patches: patches
/// x columns. The columns are the bands, of each channel in turn.
BandArray scattered_by_patches(const PatchMesh& mesh, const BandArray& irradiance);

/// Radiosity without emission, rho E + tau E_behind, W/m^2, from the irradiance of vertices:
/// vertices x columns. The columns are the bands, of each channel in turn.
BandArray scattered_at_vertices(const PatchMesh& mesh, const BandArray& irradiance);

/// Adds tau E_behind of vertices to `radiosity`, both vertices x columns.
void add_transmitted(const PatchMesh& mesh, const BandArray& irradiance, BandArray& radiosity);

}  // namespace lightwell
