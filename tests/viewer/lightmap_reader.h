#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "viewer/export/lightmap.h"

namespace lightwell {

/// Samples painted atlases by the bilinear filter of graphics cards.
class LightmapReader {
 public:
  LightmapReader(const LightmapLayout& layout, const BakedModel& model, const SolvedScene& solved,
                 const Scene& scene = {}, const LightmapOptions& options = {})
      : layout_(layout) {
    for (int a = 0; a < layout.atlas_count; ++a) {
      atlases.push_back(paint_atlas(layout, a, model, solved, scene, options));
    }
    for (std::size_t c = 0; c < layout.charts.size(); ++c) {
      const LightmapChart& chart = layout.charts[c];
      for (std::size_t f = 0; f < chart.faces.size(); ++f) {
        at_[chart.faces[f]] = {static_cast<int>(c), static_cast<int>(f)};
      }
    }
  }

  /// Atlas, and position in texels, of the point of a face with these corner weights.
  std::pair<int, Eigen::Vector2d> texel(int face, const std::array<double, 4>& weights) const {
    const auto [c, f] = at_.at(face);
    const LightmapChart& chart = layout_.charts[c];
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    for (int i = 0; i < 4 && chart.corners[f][i] >= 0; ++i) {
      place += weights[i] * chart.place[chart.corners[f][i]];
    }
    return {c, layout_.texel(c, place)};
  }

  /// E at that point by the bilinear filter.
  Eigen::ArrayXf irradiance(int face, const std::array<double, 4>& weights) const {
    const auto [c, at] = texel(face, weights);
    const LightmapAtlas& atlas = atlases[layout_.place[c].atlas];
    const double x = at.x() - 0.5, y = at.y() - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    Eigen::ArrayXf sum = Eigen::ArrayXf::Zero(atlas.irradiance.cols());
    for (const int dy : {0, 1}) {
      for (const int dx : {0, 1}) {
        const double weight = (dx ? x - x0 : 1.0 - (x - x0)) * (dy ? y - y0 : 1.0 - (y - y0));
        const auto row = static_cast<Eigen::Index>(y0 + dy) * layout_.size + x0 + dx;
        sum += static_cast<float>(weight) * atlas.irradiance.row(row).transpose();
      }
    }
    return sum;
  }

  int chart_of(int face) const { return at_.at(face).first; }

  std::vector<LightmapAtlas> atlases{};

 private:
  const LightmapLayout& layout_;
  std::map<int, std::pair<int, int>> at_{};  // by face: chart and number in the chart
};

/// Corner weights of the point (u, v) in [0,1]^2: bilinear in a quadrilateral, barycentric in a
/// triangle.
inline std::array<double, 4> corner_weights(const BakedModel& model, int face, double u, double v) {
  if (model.corner_count(face) == 4) {
    return {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
  }
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  return {1.0 - u - v, u, v, 0.0};
}

/// Point i of Roberts' R2 sequence, which fills the unit square evenly without random numbers.
inline Eigen::Vector2d spread(int i) {
  const double x = 0.5 + 0.7548776662466927 * i, y = 0.5 + 0.5698402909980532 * i;
  return {x - std::floor(x), y - std::floor(y)};
}

}  // namespace lightwell
