#pragma once

#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// Irradiance straight from the dome of the sky as a solution holds it: without noise, and free of
/// cost for a picture. A window lights a room evenly, so the mesh follows its light nearly
/// everywhere; shadow rays of a pixel would find the same light again, with noise.
struct DomeOnMesh {
  BandArray irradiance{};  ///< at vertices, W/m^2; empty: not known apart from other light
  /// Per element, the estimated error of interpolated light over the error that a surface seen
  /// directly may have: at most 1 where interpolation is as good as shadow rays. The error may be
  /// - `small_error` of the reference that errors are relative to;
  /// - as great a share of the element's own light as the RMS error of the part's light is of the
  ///   part's mean, up to that of indirect light at the same place, which is no better;
  /// - `most_error` of the reference where the dome's light reaches the corners and hardly differs
  ///   between them, since the error is then mostly one of other light.
  /// The estimates are those of the light as solved. After relight() they are taken as errors of
  /// the dome's light alone, relative to the mean irradiance as relit.
  std::vector<float> excess{};

  /// Relative RMS errors: about the noise of the shadow rays of a pixel, and one that is seen.
  static constexpr float small_error = 0.02f, most_error = 0.1f;
  /// Greatest difference between corners, as a share of the brightest, that counts as even. Over an
  /// element of that difference, light that is not linear but a parabola is off by an eighth of it.
  static constexpr float even = 0.15f;

  /// Returns whether the mesh serves as well as shadow rays in an element whose light reaches the
  /// eye with `weight`, (0,1]: the error of a weak reflection is as weak.
  bool serves(int element, float weight) const {
    return !excess.empty() && excess[static_cast<std::size_t>(element)] * weight <= 1.0f;
  }
};

/// The dome's irradiance, if the dome is the only direct light of the scene or has a channel of its
/// own (see channels_by_kind), and the solution knows the error of its interpolation. Otherwise
/// empty. `indirect_error` is a bound on the relative error of the indirect light of the picture.
DomeOnMesh dome_on_mesh(const PatchMesh& mesh, const DirectLight& direct_light,
                        const RadiositySolution& solution,
                        double indirect_error = double{DomeOnMesh::most_error});

}  // namespace lightwell
