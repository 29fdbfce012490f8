#pragma once

#include <span>
#include <vector>

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Integral over each patch of values interpolated between vertices (vertices x columns): patches x
/// columns, in m^2 times the unit of the values. The integral of radiosity is power, W.
Eigen::ArrayXXd patch_integral(const PatchMesh& mesh, const BandArray& vertex_values);

/// The error of a single patch's power that matters, as a share of all power: 0.2 %, or four
/// patches' mean share if that is more, so that not every patch of a few matters.
double notable_share(const PatchMesh& mesh);

/// Powers of patches as their equations balanced them, beside those that light at vertices makes.
class PatchPowers {
 public:
  /// Both are patches x bands, W; patch_integral() finds `at_vertices`.
  PatchPowers(const PatchMesh& mesh, Eigen::ArrayXXd balanced, Eigen::ArrayXXd at_vertices);

  /// Watts by which the power of a patch is off, all bands added.
  double error(int p) const;

  /// True if the power of a patch is off by a notable share of all power (see notable_share).
  bool is_peak(int p) const { return error(p) > least_; }

  /// True if the power of a patch is off by more than factor() restores.
  bool is_pool(int p) const;

  /// Factor of each band that gives some patches together the power that was balanced, from 4/5 to
  /// 5/4. A larger one would mean that elements are too large for the light.
  Eigen::ArrayXf factor(std::span<const int> patches) const;

 private:
  Eigen::ArrayXXd balanced_, at_vertices_;  // patches x bands
  double least_ = 0.0;
};

/// The vertices of a patch, each as often as its elements have a corner there.
std::vector<int> corners_of_patch(const PatchMesh& mesh, int patch);

/// The `gathered` radiosity, but the radiosity `even` at all vertices of patches whose two powers
/// are a peak's (see PatchPowers): in such a patch a pool of light may lie between vertices or on
/// one of them. `even` follows from the patches' equations. Both are
/// vertices x columns, W/m^2.
BandArray with_pools(const PatchMesh& mesh, const BandArray& even, BandArray gathered);

}  // namespace lightwell
