#include "radiosity/refine/interpolated_vertices.h"

#include <algorithm>
#include <cmath>

#include "mesh/patches/area_shares.h"
#include "radiosity/gather/patch_power.h"

namespace lightwell {

namespace {

Eigen::RowVectorXf mean_of_ends(const InterpolatedVertex& at, const BandArray& of) {
  Eigen::RowVectorXf sum = Eigen::RowVectorXf::Zero(of.cols());
  for (int i = 0; i < at.end_count(); ++i) sum += of.row(at.ends[i]).matrix();
  return sum / static_cast<float>(at.end_count());
}

}  // namespace

void interpolate_vertices(std::span<const InterpolatedVertex> interpolated, BandArray& values) {
  for (const InterpolatedVertex& t : interpolated) values.row(t.vertex) = mean_of_ends(t, values);
}

namespace {

struct Prediction {
  Eigen::RowVectorXf value;
  float variance = 0.0f;  // of the difference; the variance of the ends comes on top
};

// Prediction of a vertex that is not interpolated.
Prediction predict(const VertexPrediction& b, const BandArray& pilot, const BandArray& values) {
  const float both = b.spread + b.noise;
  // Weight of the difference, by Wiener's filter (1949).
  const float weight = both > 0.0f ? b.spread / both : 0.0f;
  return {mean_of_ends(b.at, values) +
              weight * (pilot.row(b.at.vertex).matrix() - mean_of_ends(b.at, pilot)),
          weight * b.noise};
}

bool is_predicted(const VertexPrediction& b) {
  return !b.is_interpolated && !b.is_shared && std::isfinite(b.spread) && std::isfinite(b.noise);
}

// Per group, the mean squared error of predictions beyond the part that noise explains, (W/m^2)^2.
// There is such an error because the pilot gather read the light of unrefined elements.
Eigen::ArrayXd unexplained(std::span<const VertexPrediction> predictions, const BandArray& pilot,
                           const BandArray& values, const Eigen::ArrayXf& variance,
                           std::span<const int> group, int bands) {
  const int groups = group.empty() ? 0 : *std::max_element(group.begin(), group.end()) + 1;
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(groups), count = sum;
  for (const VertexPrediction& b : predictions) {
    if (!is_predicted(b)) continue;
    const int v = b.at.vertex;
    const Prediction predicted = predict(b, pilot, values);
    Eigen::ArrayXf off = Eigen::ArrayXf::Zero(bands);
    for (Eigen::Index k = 0; k < values.cols(); k += bands) {
      off += (values.row(v).matrix() - predicted.value).segment(k, bands).transpose().array();
    }
    double explained = variance[v] + predicted.variance;
    for (int i = 0; i < b.at.end_count(); ++i) {
      explained += variance[b.at.ends[i]] / std::pow(b.at.end_count(), 2);
    }
    sum[group[v]] += double{off.square().mean()} - explained;
    count[group[v]] += 1.0;
  }
  return (sum / count.max(1.0)).max(0.0);
}

}  // namespace

void combine_with_predictions(std::span<const VertexPrediction> predictions, const BandArray& pilot,
                              std::span<const int> group, int bands, BandArray& values,
                              Eigen::ArrayXf& variance) {
  const Eigen::ArrayXd more = unexplained(predictions, pilot, values, variance, group, bands);
  for (const VertexPrediction& b : predictions) {
    const int v = b.at.vertex;
    // The mean of the ends' variances, as if their noise were fully correlated; part of it is.
    float of_ends = 0.0f;
    for (int i = 0; i < b.at.end_count(); ++i) of_ends += variance[b.at.ends[i]];
    of_ends /= static_cast<float>(b.at.end_count());
    if (b.is_interpolated) {
      values.row(v) = mean_of_ends(b.at, values);
      variance[v] = of_ends;
    }
    if (b.is_shared) {
      const Prediction predicted = predict(b, pilot, values);
      values.row(v) = predicted.value;
      variance[v] = of_ends + predicted.variance;
    }
    if (!is_predicted(b) || !(variance[v] > 0.0f)) continue;
    const Prediction predicted = predict(b, pilot, values);
    const float of_predicted = of_ends + predicted.variance + static_cast<float>(more[group[v]]);
    const float share = variance[v] / (variance[v] + of_predicted);
    values.row(v) = (1.0f - share) * values.row(v).matrix() + share * predicted.value;
    variance[v] *= 1.0f - share;
  }
}

std::vector<int> indices_without(std::span<const InterpolatedVertex> interpolated,
                                 std::size_t count) {
  std::vector<char> is_interpolated(count, 0);
  for (const InterpolatedVertex& t : interpolated) is_interpolated[t.vertex] = 1;
  std::vector<int> others;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_interpolated[i]) others.push_back(static_cast<int>(i));
  }
  return others;
}

BandArray spread_rows(const BandArray& values, std::span<const int> row, Eigen::Index count) {
  BandArray all = BandArray::Zero(count, values.cols());
  for (std::size_t i = 0; i < row.size(); ++i) {
    all.row(row[i]) = values.row(static_cast<Eigen::Index>(i));
  }
  return all;
}

std::vector<double> vertex_areas(const PatchMesh& mesh) {
  std::vector<double> area(mesh.vertex_count(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e);
    for (int c = 0; c < n; ++c) area[mesh.corners[e][c]] += mesh.element_area[e] / n;
  }
  return area;
}

std::vector<int> share_rays(std::span<const double> area, int rays) {
  const double typical = typical_area(area);
  std::vector<int> shares(area.size(), rays);
  if (!(typical > 0.0)) return shares;
  for (std::size_t v = 0; v < shares.size(); ++v) {
    // sqrt(area / typical), to a power of two. The power changes between the areas that vertices of
    // a grid have, which are halves and quarters, so that rounding does not decide.
    constexpr double between = 0.45;
    const double halvings = -0.5 * std::log2(std::max(area[v] / typical, 1e-6));
    const int shift = std::clamp(static_cast<int>(std::floor(halvings + between)), -1, 3);
    shares[v] = shift < 0 ? 2 * rays : std::max(1, rays >> shift);
  }
  return shares;
}

namespace {

// Half the rays for a quarter of the importance.
int rays_by_importance(int rays, float importance) {
  int shift = 0;
  while (importance < 0.5f) {
    importance *= 4.0f;
    ++shift;
  }
  return std::max(1, rays >> shift);
}

// The vertices in each part.
std::vector<std::vector<int>> vertices_by_part(const std::vector<int>& patch_of_vertex,
                                               const SceneParts& parts) {
  std::vector<std::vector<int>> vertices(static_cast<std::size_t>(parts.judged_count()));
  for (std::size_t v = 0; v < patch_of_vertex.size(); ++v) {
    vertices[parts.judged_with(patch_of_vertex[v])].push_back(static_cast<int>(v));
  }
  return vertices;
}

std::vector<double> values_at(const std::vector<double>& all, const std::vector<int>& at) {
  std::vector<double> values;
  values.reserve(at.size());
  for (const int i : at) values.push_back(all[i]);
  return values;
}

}  // namespace

std::vector<float> vertex_fineness(const PatchMesh& mesh, const SceneParts& parts) {
  constexpr double most = 64.0;
  const std::vector<double> area = vertex_areas(mesh);
  std::vector<float> fineness(area.size(), 1.0f);
  for (const std::vector<int>& vertices : vertices_by_part(vertex_patches(mesh), parts)) {
    const double typical = typical_area(values_at(area, vertices));
    for (const int v : vertices) {
      const double least = typical / (most * most);
      if (!(typical > 0.0)) continue;
      const double times = std::sqrt(typical / std::max(area[v], least));
      fineness[v] = static_cast<float>(std::max(times, 1.0));
    }
  }
  return fineness;
}

std::vector<int> share_rays(const PatchMesh& mesh, std::span<const InterpolatedVertex> interpolated,
                            const SceneParts& parts, std::span<const int> rays) {
  std::vector<double> area = vertex_areas(mesh);
  for (auto t = interpolated.rbegin(); t != interpolated.rend(); ++t) {
    for (int i = 0; i < t->end_count(); ++i) area[t->ends[i]] += area[t->vertex] / t->end_count();
    area[t->vertex] = 0.0;
  }
  const std::vector<int> patch = vertex_patches(mesh);
  const std::vector<std::vector<int>> vertices = vertices_by_part(patch, parts);
  std::vector<int> shares(area.size(), 0);
  for (std::size_t p = 0; p < vertices.size(); ++p) {
    const std::vector<double> of_part = values_at(area, vertices[p]);
    const std::vector<int> shared = share_rays(of_part, rays[p]);
    for (std::size_t i = 0; i < shared.size(); ++i) {
      const int v = vertices[p][i];
      shares[v] = rays_by_importance(shared[i], parts.importance_of(patch[v]));
    }
  }
  for (const InterpolatedVertex& t : interpolated) shares[t.vertex] = 0;
  return shares;
}

}  // namespace lightwell
