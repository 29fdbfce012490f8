#pragma once

#include <span>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "scene/scene.h"

namespace lightwell {

/// The area, m^2, of the patches or vertices that are typical: the least area of the largest ones
/// that stand for about half of all area. 0 without any area.
double typical_area(std::span<const double> area);

/// Number of samples of each patch by its area, m^2, where `samples` serve a typical one. The noise
/// of a patch's power is proportional to area / sqrt(samples), so the noise of all power is least
/// for the work with samples in proportion to area. Patches of a quarter of typical_area() and more
/// take `samples`; others take `samples` over a power of two, `most_times` at most.
std::vector<int> samples_by_area(std::span<const double> area, int samples, int most_times);
/// The same for the patches of a mesh. Patches of surroundings (see near_scenery()), which are
/// large where nobody is near, have no part in what is typical and take `samples`.
std::vector<int> samples_by_area(const Scene& scene, const PatchMesh& mesh, int samples,
                                 int most_times);

}  // namespace lightwell
