#include "radiosity/refine/even_out_noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr int grain = 256;

// Sorts and removes duplicates.
void make_unique(std::vector<int>& numbers) {
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

// The gathered vertices with noise that each vertex stands for: itself, or, if it is interpolated,
// those that its ends stand for.
class StandsFor {
 public:
  // Precondition: the ends of an interpolated vertex come before it in `predictions`.
  StandsFor(std::span<const VertexPrediction> predictions, const Eigen::ArrayXf& variance)
      : variance_(variance), list_(static_cast<std::size_t>(variance.size()), -1) {
    for (const VertexPrediction& b : predictions) {
      if (!b.is_interpolated) continue;
      std::vector<int> gathered;
      for (int i = 0; i < b.at.end_count(); ++i) add(b.at.ends[i], gathered);
      make_unique(gathered);
      list_[static_cast<std::size_t>(b.at.vertex)] = static_cast<int>(lists_.size());
      lists_.push_back(std::move(gathered));
    }
  }

  // Appends the vertices that `v` stands for.
  void add(int v, std::vector<int>& to) const {
    const int list = list_[static_cast<std::size_t>(v)];
    if (list >= 0) {
      const std::vector<int>& gathered = lists_[static_cast<std::size_t>(list)];
      to.insert(to.end(), gathered.begin(), gathered.end());
    } else if (variance_[v] > 0.0f) {
      to.push_back(v);
    }
  }

 private:
  const Eigen::ArrayXf& variance_;
  std::vector<int> list_;  // of each vertex: index into lists_; -1: the vertex is gathered
  std::vector<std::vector<int>> lists_{};
};

// The neighbours of each vertex, in rising order, one list after another.
class Neighbours {
 public:
  Neighbours(const PatchMesh& mesh, const StandsFor& stands_for) {
    const auto count = static_cast<std::size_t>(mesh.vertex_count());
    std::vector<std::vector<int>> lists(count);
    std::vector<std::size_t> most(count, 0);  // numbers in a list before duplicates are removed
    std::vector<int> corners;
    for (int e = 0; e < mesh.element_count(); ++e) {
      corners.clear();
      for (int c = 0; c < mesh.corner_count(e); ++c) stands_for.add(mesh.corners[e][c], corners);
      make_unique(corners);
      for (const int v : corners) {
        std::vector<int>& list = lists[static_cast<std::size_t>(v)];
        for (const int u : corners) {
          if (u != v) list.push_back(u);
        }
        keep_short(list, most[static_cast<std::size_t>(v)]);
      }
    }
    first_.reserve(count + 1);
    for (std::vector<int>& list : lists) {
      first_.push_back(vertex_.size());
      make_unique(list);
      vertex_.insert(vertex_.end(), list.begin(), list.end());
      std::vector<int>().swap(list);
    }
    first_.push_back(vertex_.size());
  }

  std::span<const int> of(int v) const {
    const auto i = static_cast<std::size_t>(v);
    return {vertex_.data() + first_[i], vertex_.data() + first_[i + 1]};
  }

 private:
  // Removes duplicates once a list is twice as long as it was without them. Thousands of elements
  // between the same gathered vertices name the same neighbours.
  static void keep_short(std::vector<int>& list, std::size_t& most) {
    constexpr std::size_t least = 64;
    if (list.size() <= std::max(most, least)) return;
    make_unique(list);
    most = 2 * list.size();
  }

  std::vector<std::size_t> first_{};  // of each vertex, and the end
  std::vector<int> vertex_{};
};

// Area over the number of neighbours, m^2. The lesser one of two neighbours weighs what they
// exchange, so that no vertex takes more than its neighbours' mean.
std::vector<double> areas_per_neighbour(const PatchMesh& mesh,
                                        std::span<const VertexPrediction> predictions,
                                        const Neighbours& neighbours) {
  std::vector<double> area = vertex_areas(mesh);
  for (auto b = predictions.rbegin(); b != predictions.rend(); ++b) {
    if (!b->is_interpolated) continue;
    const auto v = static_cast<std::size_t>(b->at.vertex);
    for (int i = 0; i < b->at.end_count(); ++i) {
      area[static_cast<std::size_t>(b->at.ends[i])] += area[v] / b->at.end_count();
    }
    area[v] = 0.0;
  }
  for (std::size_t v = 0; v < area.size(); ++v) {
    area[v] /= std::max(1.0, static_cast<double>(neighbours.of(static_cast<int>(v)).size()));
  }
  return area;
}

// Sum of the channels' squares, mean of the bands.
double mean_square(const Eigen::RowVectorXf& values, int bands) {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(bands);
  for (Eigen::Index k = 0; k < values.size(); k += bands) {
    sum += values.segment(k, bands).transpose().array().cast<double>();
  }
  return sum.square().mean();
}

class NoiseExchange {
 public:
  NoiseExchange(const PatchMesh& mesh, std::span<const VertexPrediction> predictions, int bands,
                const BandArray& values, const Eigen::ArrayXf& variance)
      : neighbours_(mesh, StandsFor(predictions, variance)),
        area_(areas_per_neighbour(mesh, predictions, neighbours_)),
        bands_(bands),
        values_(values),
        variance_(variance),
        mean_noise_(Eigen::ArrayXd::Zero(variance.size())),
        beyond_(mean_noise_),
        share_(mean_noise_) {
    compare();
    find_shares();
  }

  // The new values and variances.
  void apply(BandArray& values, Eigen::ArrayXf& variance) const {
    parallel_for(static_cast<int>(variance_.size()), grain, [&](int begin, int end) {
      for (int v = begin; v < end; ++v) {
        double kept = 1.0, noise = 0.0;
        Eigen::RowVectorXf sum = Eigen::RowVectorXf::Zero(values_.cols());
        for (const int u : neighbours_.of(v)) {
          const double weight = weight_of(v, u) * std::min(share_[v], share_[u]);
          kept -= weight;
          noise += weight * weight * double{variance_[u]};
          sum += static_cast<float>(weight) * values_.row(u).matrix();
        }
        values.row(v) = static_cast<float>(kept) * values_.row(v).matrix() + sum;
        variance[v] = static_cast<float>(kept * kept * double{variance_[v]} + noise);
      }
    });
  }

 private:
  // Weight of a neighbour in the mean; together at most 1.
  double weight_of(int v, int u) const {
    const double own = area_[v] * static_cast<double>(neighbours_.of(v).size());
    return own > 0.0 ? std::min(area_[v], area_[u]) / own : 0.0;
  }

  // Compares each vertex with the mean of its neighbours.
  void compare() {
    // The median of the square of a normal variable of variance 1.
    constexpr double median_of_square = 0.455;
    parallel_for(static_cast<int>(variance_.size()), grain, [&](int begin, int end) {
      for (int v = begin; v < end; ++v) {
        double all = 0.0;
        Eigen::RowVectorXf mean = Eigen::RowVectorXf::Zero(values_.cols());
        for (const int u : neighbours_.of(v)) {
          const double weight = weight_of(v, u);
          all += weight;
          mean_noise_[v] += weight * weight * double{variance_[u]};
          mean += static_cast<float>(weight) * values_.row(u).matrix();
        }
        if (!(all > 0.0)) continue;
        mean_noise_[v] /= all * all;
        mean /= static_cast<float>(all);
        beyond_[v] = mean_square(values_.row(v).matrix() - mean, bands_) / median_of_square -
                     mean_noise_[v] - double{variance_[v]};
      }
    });
  }

  // Median of the squared differences beyond noise of a vertex and its neighbours.
  double median_around(int v, std::vector<double>& around) const {
    around.assign(1, beyond_[v]);
    for (const int u : neighbours_.of(v)) around.push_back(beyond_[u]);
    const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
    std::nth_element(around.begin(), middle, around.end());
    return *middle;
  }

  void find_shares() {
    const auto count = static_cast<int>(variance_.size());
    std::vector<double> median(static_cast<std::size_t>(count));
    parallel_for(count, grain, [&](int begin, int end) {
      std::vector<double> around;
      for (int v = begin; v < end; ++v) median[v] = median_around(v, around);
    });
    parallel_for(count, grain, [&](int begin, int end) {
      for (int v = begin; v < end; ++v) {
        const std::span<const int> around = neighbours_.of(v);
        if (around.empty()) continue;
        double sum = median[v];
        for (const int u : around) sum += median[u];
        const double mean = sum / static_cast<double>(around.size() + 1);
        const double noise = double{variance_[v]};
        share_[v] = noise / (noise + mean_noise_[v] + std::max(mean, 0.0));
      }
    });
  }

  Neighbours neighbours_;
  std::vector<double> area_;
  int bands_;
  const BandArray& values_;
  const Eigen::ArrayXf& variance_;
  Eigen::ArrayXd mean_noise_;  // squared, of the neighbours' mean
  Eigen::ArrayXd beyond_;      // squared difference to the mean beyond all noise
  Eigen::ArrayXd share_;
};

}  // namespace

void even_out_noise(const PatchMesh& mesh, std::span<const VertexPrediction> predictions, int bands,
                    BandArray& values, Eigen::ArrayXf& variance) {
  BandArray evened = values;
  Eigen::ArrayXf left = variance;
  NoiseExchange(mesh, predictions, bands, values, variance).apply(evened, left);
  values = std::move(evened);
  variance = std::move(left);
  for (const VertexPrediction& b : predictions) {
    if (!b.is_interpolated) continue;
    interpolate_vertices({&b.at, 1}, values);
    float of_ends = 0.0f;
    for (int i = 0; i < b.at.end_count(); ++i) of_ends += variance[b.at.ends[i]];
    variance[b.at.vertex] = of_ends / static_cast<float>(b.at.end_count());
  }
}

}  // namespace lightwell
