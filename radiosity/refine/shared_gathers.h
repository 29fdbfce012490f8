#pragma once

#include <span>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/refine/interpolated_vertices.h"
#include "radiosity/solution/scene_parts.h"
#include "scene/scene.h"

namespace lightwell {

/// Per patch, 1 if no ray reads the light that falls on it: if its material mirrors or transmits,
/// and neither reflects diffusely nor emits.
std::vector<char> unread_patches(const Scene& scene, const PatchMesh& mesh);

/// Per patch, 1 for a *crumb*: its vertices are close together against the scene, as on a chain, a
/// tassel or the leaves of a plant. (A patch holds many facets where facets are small.) In the
/// mean, each stands for less than a 64th of the area that the vertices of half of the scene's area
/// stand for at least.
std::vector<char> crumb_patches(const PatchMesh& mesh);

/// Vertices of crumb_patches(). The vertices of a crumb are parted into groups of neighbours, and
/// each group has two or four *records*, far from each other. Final gathers are at the records
/// alone, as in irradiance caching (Ward, Rubinstein & Clear 1988).
struct SharedGathers {
  /// Vertices of groups that rays read. A pilot gather at each vertex finds its difference from the
  /// records, in the place of irradiance gradients.
  std::vector<InterpolatedVertex> read{};
  /// Vertices of groups on unread_patches(), which take the mean of the records.
  std::vector<InterpolatedVertex> unread{};
  /// The other vertices of unread crumbs: the records, and all vertices of a crumb that has only
  /// two. Their final gathers have few rays.
  std::vector<int> rough{};
};

/// Groups have up to 32 vertices, or 64 on unread patches. Groups of 16 and more that rays read
/// have four records, others two. Crumbs of fewer than 8 vertices that rays read do not share. The
/// ends of an entry are its group's records, which have no entry.
SharedGathers find_shared_gathers(const Scene& scene, const PatchMesh& mesh);

/// Raises the error of elements on unread crumbs, relative to error_references(), to what the
/// records tell: with two independent records a and b of a group, the mean squared error of their
/// mean at another place is 3/4 (a - b)^2. `irradiance` is vertices x bands, W/m^2; `error` is per
/// element.
void add_record_errors(const PatchMesh& mesh, std::span<const InterpolatedVertex> unread,
                       const BandArray& irradiance, const SceneParts& parts, Eigen::ArrayXf& error);

}  // namespace lightwell
