#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/journal/run_control.h"
#include "raytrace/render.h"
#include "viewer/export/baked_model.h"
#include "viewer/export/lightmap_charts.h"

namespace lightwell {

struct LightmapOptions {
  int size = 2048;  ///< texels along an edge of an atlas, 16 to 8192
  /// 0: as many as let one atlas of that size hold everything. Else there may be several.
  double texels_per_metre = 0.0;
  /// Texels around a chart that repeat its edge, 1 to 64. With 2^k of them neighbours do not bleed
  /// into each other down to mip level k.
  int padding = 4;
  /// Where a texel's light is from: the solution (interpolate), its indirect light and direct light
  /// traced anew at the texel's centre (direct), or all of it anew (gather).
  Pass pass = Pass::interpolate;
  ShadowOptions shadows{};
  int gather_rays = 256;     ///< for Pass::gather; 1 to most_gather_rays
  bool per_channel = false;  ///< data of each light channel as well, in the same charts
  RunControl run{};
};

inline constexpr int least_lightmap_size = 16, most_lightmap_size = 8192, most_atlases = 64;

/// Where a chart lies, in texels from an atlas's upper left corner; the padding is outside of it.
struct ChartRectangle {
  int atlas = 0, x = 0, y = 0, width = 0, height = 0;
};

/// A model's charts, packed into square atlases of equal size.
struct LightmapLayout {
  int size = 0, padding = 0, atlas_count = 0;
  double texels_per_metre = 0.0;
  std::vector<LightmapChart> charts{};
  std::vector<ChartRectangle> place{};  ///< of each chart; those that are dark share one, or have
                                        ///< their host's

  /// Of a place of a chart, in texels from its atlas's upper left corner, y downwards: a chart
  /// fills its rectangle, which is a whole number of texels.
  Eigen::Vector2d texel(int chart, const Eigen::Vector2d& at) const;
};

/// Throws InputError that says which size or density would do if the charts do not fit, and for
/// options out of their range.
LightmapLayout lay_out_lightmap(const BakedModel& model, const PatchMesh& mesh,
                                const LightmapOptions& options = {});

/// Light of one atlas, row 0 on top. What no chart covers continues those around it, so that no
/// filter finds black there.
struct LightmapAtlas {
  int size = 0;
  BandArray irradiance{};    ///< E, W/m^2, texels x bands
  BandArray radiosity{};     ///< B = M + rho E, W/m^2, texels x linear Rec. 709 RGB
  BandArray radiance{};      ///< what is shown as light: see BakedModel::radiance
  std::vector<int> face{};   ///< of the model, in which a texel's centre lies; -1: none
  std::int64_t covered = 0;  ///< texels with a face
};

/// `scene` must be the one the solution was made from for Pass::direct and Pass::gather, and may be
/// empty else. The same bits for any number of threads.
LightmapAtlas paint_atlas(const LightmapLayout& layout, int atlas, const BakedModel& model,
                          const SolvedScene& solved, const Scene& scene,
                          const LightmapOptions& options = {});

}  // namespace lightwell
