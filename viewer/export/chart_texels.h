#pragma once

#include <vector>

#include "viewer/export/lightmap.h"

namespace lightwell {

/// What texels of a chart and of its padding show.
class ChartTexels {
 public:
  ChartTexels(const LightmapLayout& layout, int chart, const BakedModel& model,
              const PatchMesh& mesh);

  struct Texel {
    int x = 0, y = 0;        ///< of the atlas
    int face = 0;            ///< of the model
    bool is_inside = false;  ///< its centre lies in the face; else a filter on the chart reads it
    /// Of the face's corners, in the model's order; they sum to 1. Beyond the chart's border they
    /// go on as steeply as within, so that what a filter finds on the border is the light there.
    Eigen::Array4f weights = Eigen::Array4f::Zero();
    /// The same of the nearest place within the face.
    Eigen::Array4f inside = Eigen::Array4f::Zero();
  };
  /// Row by row: those a bilinear filter reads anywhere on the chart.
  std::vector<Texel> texels() const;

 private:
  std::vector<Texel> flat_texels() const;
  std::vector<Texel> sphere_texels() const;

  const LightmapLayout& layout_;
  int chart_;
  const BakedModel& model_;
  const PatchMesh& mesh_;
};

}  // namespace lightwell
