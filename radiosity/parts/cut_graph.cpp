#include "radiosity/parts/cut_graph.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Components of the graph: a number from 0 for each node.
std::vector<int> components(const ExchangeGraph& graph, int& count) {
  std::vector<int> of(static_cast<std::size_t>(graph.count()), -1), open;
  count = 0;
  for (int i = 0; i < graph.count(); ++i) {
    if (of[i] >= 0) continue;
    of[i] = count;
    open.push_back(i);
    while (!open.empty()) {
      const int at = open.back();
      open.pop_back();
      for (const ExchangeGraph::Neighbor& to : graph.neighbors(at)) {
        if (of[to.node] >= 0) continue;
        of[to.node] = count;
        open.push_back(to.node);
      }
    }
    ++count;
  }
  return of;
}

// Nodes in the order of a sweep. Cut k parts the first k nodes from the others.
struct Sweep {
  std::vector<int> nodes{};
  std::vector<double> area{};      // of the first k nodes
  std::vector<double> exchange{};  // across cut k
};

// The largest exchange across the cuts from cut k on, one way or the other (`step` -1 or 1), that
// differ from cut k by at most `area`; at least one cut counts. Infinite: there is no such cut.
double largest_nearby(const Sweep& sweep, std::size_t k, int step, double area) {
  double largest = -std::numeric_limits<double>::infinity();
  if (k + step < 1 || k + step >= sweep.nodes.size()) return -largest;
  for (std::size_t i = k + step; i >= 1 && i < sweep.nodes.size(); i += step) {
    const bool is_first = i == k + step;
    if (!is_first && std::abs(sweep.area[i] - sweep.area[k]) > area) break;
    largest = std::max(largest, sweep.exchange[i]);
  }
  return largest;
}

// The cut that holds with the least share of exchange; 0: none.
std::size_t best_cut(const Sweep& sweep) {
  const std::size_t n = sweep.nodes.size();
  double least = most_shared_exchange;
  std::size_t best = 0;
  for (std::size_t k = 1; k < n; ++k) {
    const double smaller = std::min(sweep.area[k], sweep.area[n] - sweep.area[k]);
    const double share = sweep.exchange[k] / smaller;
    if (share > least || (best > 0 && share == least)) continue;
    constexpr double bottleneck = 0.5, nearby = 0.5;
    const double around = std::min(largest_nearby(sweep, k, -1, nearby * smaller),
                                   largest_nearby(sweep, k, 1, nearby * smaller));
    if (sweep.exchange[k] > bottleneck * around) continue;
    least = share;
    best = k;
  }
  return best;
}

class GraphCutter {
 public:
  explicit GraphCutter(const ExchangeGraph& graph) : graph_(graph) {
    int count = 0;
    cluster_ = components(graph, count);
    members_.resize(static_cast<std::size_t>(count));
    for (int i = 0; i < graph.count(); ++i) members_[cluster_[i]].push_back(i);
    value_.resize(cluster_.size());
    next_.resize(cluster_.size());
    position_.resize(cluster_.size());
  }

  std::vector<int> run() {
    std::vector<int> open(members_.size());
    std::iota(open.begin(), open.end(), 0);
    std::vector<int> failures(members_.size(), 0);
    for (std::uint64_t round = 0; !open.empty(); ++round) {
      diffuse(open, round);
      std::vector<int> still_open;
      for (const int cluster : open) {
        const std::vector<int> pieces = cut(cluster);
        failures.resize(members_.size(), 0);
        constexpr int most_failures = 2;
        if (pieces.size() == 1 && ++failures[cluster] >= most_failures) continue;
        still_open.insert(still_open.end(), pieces.begin(), pieces.end());
      }
      std::erase_if(still_open, [&](int c) { return members_[c].size() < 2; });
      open = std::move(still_open);
    }
    return std::move(cluster_);
  }

 private:
  // Sets the values of the clusters' nodes to random numbers smoothed by diffusion within each
  // cluster; the mean over each is 0.
  void diffuse(const std::vector<int>& clusters, std::uint64_t round) {
    std::vector<int> nodes;
    for (const int c : clusters) nodes.insert(nodes.end(), members_[c].begin(), members_[c].end());
    for (const int i : nodes) {
      value_[i] = random_uniform(random_key(static_cast<std::uint64_t>(i),
                                            RandomPurpose::part_vectors, round)) -
                  0.5;
    }
    // Light spreads within a room in a few of these steps. The steps in the end average old and new
    // values, since parallel plates alone pass light to and fro.
    constexpr int steps = 24, averaging = 4;
    for (int step = 0; step < steps; ++step) {
      const double kept = step < steps - averaging ? 0.0 : 0.5;
      constexpr int grain = 256;
      parallel_for(static_cast<int>(nodes.size()), grain, [&](int begin, int end) {
        for (int n = begin; n < end; ++n) {
          const int i = nodes[n];
          next_[i] = kept * value_[i] + (1.0 - kept) * spread(i);
        }
      });
      for (const int c : clusters) take_next(c);
    }
  }

  // The mean of the values that node i exchanges light with, in its cluster; what leaves the
  // cluster or the scene keeps the node's own value.
  double spread(int i) const {
    double sum = 0.0, inside = 0.0;
    for (const auto& [node, exchange] : graph_.neighbors(i)) {
      if (cluster_[node] != cluster_[i]) continue;
      sum += double{exchange} * value_[node];
      inside += double{exchange};
    }
    return value_[i] + (sum - inside * value_[i]) / graph_.area(i);
  }

  void take_next(int cluster) {
    double sum = 0.0, area = 0.0;
    for (const int i : members_[cluster]) {
      sum += graph_.area(i) * next_[i];
      area += graph_.area(i);
    }
    for (const int i : members_[cluster]) value_[i] = next_[i] - sum / area;
  }

  Sweep sweep_of(int cluster) {
    Sweep sweep{.nodes = members_[cluster]};
    std::ranges::sort(sweep.nodes, [&](int a, int b) {
      return std::pair(value_[a], a) < std::pair(value_[b], b);
    });
    const std::size_t n = sweep.nodes.size();
    for (std::size_t k = 0; k < n; ++k) position_[sweep.nodes[k]] = k;
    sweep.area.assign(n + 1, 0.0);
    sweep.exchange.assign(n + 1, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      double change = 0.0;
      for (const auto& [node, exchange] : graph_.neighbors(sweep.nodes[k])) {
        if (cluster_[node] != cluster) continue;
        change += position_[node] > k ? double{exchange} : -double{exchange};
      }
      sweep.area[k + 1] = sweep.area[k] + graph_.area(sweep.nodes[k]);
      // Rounding may leave a little less than nothing.
      sweep.exchange[k + 1] = std::max(sweep.exchange[k] + change, 0.0);
    }
    return sweep;
  }

  // Cuts a cluster, and what is left, as long as cuts hold; returns the clusters that it became.
  std::vector<int> cut(int cluster) {
    std::vector<int> open{cluster}, done;
    while (!open.empty()) {
      const int at = open.back();
      open.pop_back();
      const Sweep sweep = sweep_of(at);
      const std::size_t k = best_cut(sweep);
      if (k == 0) {
        done.push_back(at);
        continue;
      }
      const int fresh = static_cast<int>(members_.size());
      const auto middle = sweep.nodes.begin() + static_cast<std::ptrdiff_t>(k);
      members_.emplace_back(middle, sweep.nodes.end());
      members_[at].assign(sweep.nodes.begin(), middle);
      for (std::vector<int>* side : {&members_[at], &members_[fresh]}) std::ranges::sort(*side);
      for (const int i : members_[fresh]) cluster_[i] = fresh;
      open.push_back(at);
      open.push_back(fresh);
    }
    return done;
  }

  const ExchangeGraph& graph_;
  std::vector<int> cluster_;               // of each node
  std::vector<std::vector<int>> members_;  // of each cluster, in rising order
  std::vector<double> value_, next_;       // of each node
  std::vector<std::size_t> position_;      // of each node in the sweep
};

// Clusters, with the exchange between any two.
class ClusterGraph {
 public:
  ClusterGraph(const ExchangeGraph& graph, const std::vector<int>& cluster) {
    const int count = cluster.empty() ? 0 : *std::ranges::max_element(cluster) + 1;
    area_.assign(static_cast<std::size_t>(count), 0.0);
    links_.resize(area_.size());
    parent_.resize(area_.size());
    std::iota(parent_.begin(), parent_.end(), 0);
    for (int i = 0; i < graph.count(); ++i) {
      area_[cluster[i]] += graph.area(i);
      for (const auto& [node, exchange] : graph.neighbors(i)) {
        if (cluster[node] != cluster[i]) links_[cluster[i]][cluster[node]] += double{exchange};
      }
    }
  }

  int count() const { return static_cast<int>(area_.size()); }
  double area(int c) const { return area_[c]; }
  bool exists(int c) const { return parent_[c] == c; }
  const std::map<int, double>& links(int c) const { return links_[c]; }
  double share(int a, int b) const { return links_[a].at(b) / std::min(area_[a], area_[b]); }
  int root(int c) const {
    while (parent_[c] != c) c = parent_[c];
    return c;
  }

  // Joins cluster b with a, which stays.
  void join(int a, int b) {
    parent_[b] = a;
    area_[a] += area_[b];
    for (const auto& [to, exchange] : links_[b]) {
      links_[to].erase(b);
      if (to == a) continue;
      links_[a][to] += exchange;
      links_[to][a] += exchange;
    }
    links_[b].clear();
  }

 private:
  std::vector<double> area_;
  std::vector<std::map<int, double>> links_;
  std::vector<int> parent_;
};

void join_by_share(ClusterGraph& clusters) {
  std::priority_queue<std::tuple<double, int, int>> queue;
  const auto add = [&](int c) {
    for (const auto& [to, exchange] : clusters.links(c)) {
      const double share = clusters.share(c, to);
      if (share > most_shared_exchange) queue.emplace(share, -std::min(c, to), -std::max(c, to));
    }
  };
  for (int c = 0; c < clusters.count(); ++c) add(c);
  while (!queue.empty()) {
    const auto [share, minus_a, minus_b] = queue.top();
    queue.pop();
    const int a = -minus_a, b = -minus_b;
    const bool is_current = clusters.exists(a) && clusters.exists(b) &&
                            clusters.links(a).contains(b) && clusters.share(a, b) == share;
    if (!is_current) continue;
    clusters.join(a, b);
    add(a);
  }
}

}  // namespace

void join_clusters(const ExchangeGraph& graph, std::span<const char> joins_any,
                   std::vector<int>& cluster) {
  ClusterGraph clusters(graph, cluster);
  std::vector<std::pair<double, int>> by_area;
  for (std::size_t c = 0; c < joins_any.size(); ++c) {
    if (joins_any[c] != 0) by_area.emplace_back(clusters.area(static_cast<int>(c)), c);
  }
  std::ranges::sort(by_area);
  for (const auto& [area, c] : by_area) {
    if (!clusters.exists(c) || clusters.links(c).empty()) continue;
    const auto& links = clusters.links(c);
    const auto most = std::ranges::max_element(
        links, [](const auto& a, const auto& b) { return a.second < b.second; });
    clusters.join(most->first, c);
  }
  // Two rooms stay apart although a small cluster that joined one of them exchanges light with the
  // other.
  if (joins_any.empty()) join_by_share(clusters);
  std::vector<int> number(static_cast<std::size_t>(clusters.count()), -1);
  int count = 0;
  for (int& c : cluster) {
    int& at = number[clusters.root(c)];
    if (at < 0) at = count++;
    c = at;
  }
}

namespace {

// Moves nodes that exchange more than half of their light with another cluster than their own: a
// sweep by noisy values may leave a few on the wrong side.
void move_strays(const ExchangeGraph& graph, std::vector<int>& cluster) {
  constexpr int most_passes = 3;
  for (int pass = 0; pass < most_passes; ++pass) {
    std::vector<int> moved = cluster;
    for (int i = 0; i < graph.count(); ++i) {
      std::map<int, double> with;
      for (const auto& [node, exchange] : graph.neighbors(i)) {
        with[cluster[node]] += double{exchange};
      }
      for (const auto& [c, exchange] : with) {
        if (exchange > 0.5 * graph.area(i)) moved[i] = c;
      }
    }
    if (moved == cluster) break;
    cluster = std::move(moved);
  }
}

}  // namespace

std::vector<int> cut_graph(const ExchangeGraph& graph) {
  std::vector<int> cluster = GraphCutter(graph).run();
  join_clusters(graph, {}, cluster);
  move_strays(graph, cluster);
  join_clusters(graph, {}, cluster);
  return cluster;
}

}  // namespace lightwell
