#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "radiosity/journal/run_control.h"
#include "raytrace/render.h"
#include "viewer/export/baked_model.h"

namespace lightwell {

struct LightmapOptions {
  int size = 2048;  ///< texels along an edge of an atlas, 16 to 8192
  /// Density, texels/m. 0: the highest at which one atlas holds all charts. A given density may
  /// take several atlases.
  double texels_per_metre = 0.0;
  /// Texels of padding around a chart, 1 to 64. With a padding of 2^k texels, neighbouring charts
  /// do not bleed into each other down to mip level k.
  int padding = 4;
  /// Source of a texel's irradiance.
  /// - interpolate: the solution
  /// - direct: the solution's indirect light, and direct light computed at the texel's centre
  /// - gather: direct and indirect light gathered at the texel's centre; caustics interpolated
  Pass pass = Pass::interpolate;
  ShadowOptions shadows{};
  int gather_rays = 256;     ///< for Pass::gather; 1 to most_gather_rays
  bool per_channel = false;  ///< also writes data of each light channel, in the same charts
  RunControl run{};
};

inline constexpr int least_lightmap_size = 16, most_lightmap_size = 8192, most_atlases = 64;

/// Connected faces of one part of a BakedModel, mapped to the plane. The faces share vertices or
/// meet in blunt creases, so that light is continuous in a chart. Curved surfaces are cut where
/// normals differ by more than 25 degrees, and projected on their mean plane. A sphere is mapped by
/// longitude and latitude.
struct LightmapChart {
  std::vector<int> faces{};  ///< of the model, ascending
  /// Corners of each face, indices into `vertices`, in the face's order; [3] is -1 for a triangle.
  std::vector<std::array<int, 4>> corners{};
  std::vector<int> vertices{};  ///< of the model; twice along a sphere's seam
  /// Position of each vertex in the plane, m. Faces are counter-clockwise seen from the lit side.
  std::vector<Eigen::Vector2d> place{};
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< m; `place` is within [0, size]
  /// Projection of a chart that is no sphere: p is at ((p - origin).x_axis, (p - origin).y_axis).
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d x_axis = Eigen::Vector3d::UnitX(), y_axis = Eigen::Vector3d::UnitY();
  int sphere = -1;       ///< index into PatchMesh::round_grids; -1: no sphere
  bool is_dark = false;  ///< no light at any vertex
  /// Chart around the footprint of another body: a covered dark chart lies in its host's gap, so
  /// that no dark texels show at the foot of the body. -1: none.
  int host = -1;
};

/// Rectangle of a chart in texels from an atlas's upper left corner, without the padding.
struct ChartRectangle {
  int atlas = 0, x = 0, y = 0, width = 0, height = 0;
};

/// Charts of a model, packed into square atlases of equal size.
struct LightmapLayout {
  int size = 0, padding = 0, atlas_count = 0;
  double texels_per_metre = 0.0;
  std::vector<LightmapChart> charts{};
  /// Rectangle of each chart. A chart with a host has the host's; other dark charts share one.
  std::vector<ChartRectangle> place{};

  /// Position of a chart's point `at` (m, see LightmapChart::place) in texels from the upper left
  /// corner of the chart's atlas, y downwards. A chart is stretched to fill its rectangle, which
  /// has a whole number of texels on each side.
  Eigen::Vector2d texel(int chart, const Eigen::Vector2d& at) const;
};

/// Cuts a model into charts and packs them. Throws InputError for options out of range, and if the
/// charts do not fit; the message recommends a size or a density.
LightmapLayout lay_out_lightmap(const BakedModel& model, const PatchMesh& mesh,
                                const LightmapOptions& options = {});

/// Light of one atlas, row 0 on top. Texels outside of charts continue the charts around, so that
/// no filter reads black.
struct LightmapAtlas {
  int size = 0;
  BandArray irradiance{};  ///< E, W/m^2, texels x bands
  BandArray radiosity{};   ///< B = M + rho E, W/m^2, texels x linear Rec. 709 RGB
  BandArray radiance{};    ///< W/(m^2 sr), texels x RGB, as BakedModel::radiance
  /// Bound of the error of illuminance, lx, texels x 1 (see BakedModel::lux_within); empty if none
  /// is known, which holds for Pass::gather as well.
  BandArray lux_within{};
  std::vector<int> face{};   ///< face of the model that contains the texel's centre; -1: none
  std::int64_t covered = 0;  ///< texels with a face
};

/// Computes the light of atlas number `atlas`. For Pass::direct and Pass::gather `scene` must be
/// the scene that was solved; for Pass::interpolate an empty scene suffices. The result has the
/// same bits for any number of threads.
LightmapAtlas paint_atlas(const LightmapLayout& layout, int atlas, const BakedModel& model,
                          const SolvedScene& solved, const Scene& scene,
                          const LightmapOptions& options = {});

}  // namespace lightwell
