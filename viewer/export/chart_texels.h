#pragma once

#include <vector>

#include "viewer/export/lightmap.h"

namespace lightwell {

/// Texels of a chart and the weights that interpolate light at them.
class ChartTexels {
 public:
  ChartTexels(const LightmapLayout& layout, int chart, const BakedModel& model,
              const PatchMesh& mesh);

  struct Texel {
    int x = 0, y = 0;  ///< in the atlas
    int face = 0;      ///< of the model
    /// The texel's centre lies in the face; else only a filter at the chart's border reads it.
    bool is_inside = false;
    /// Weights of the face's corners, in the model's order; sum 1. Outside of the chart they
    /// extrapolate the light's slope, so that a bilinear filter on the border reads the light
    /// there.
    Eigen::Array4f weights = Eigen::Array4f::Zero();
    /// Weights of the face's corners at the nearest point of the face; sum 1.
    Eigen::Array4f inside = Eigen::Array4f::Zero();
  };
  /// All texels that a bilinear filter reads on the chart, row by row.
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
