#include "radiosity/parts/find_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "radiosity/parts/cracks.h"
#include "radiosity/parts/cut_graph.h"
#include "radiosity/parts/exchange_graph.h"
#include "radiosity/parts/part_rays.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Sets `is_outside` of patches of which enough rays leave the scene. Where a house stands on the
// ground, its wall takes up to half of the rays of the small patches beside the wall, so half of
// the rays suffice (0.4 with the noise of 32 rays) on a facet of which enough leave as a whole.
void mark_outside(const PatchMesh& mesh, std::vector<PartRayEnds>& arrivals) {
  constexpr double enough = 0.7, beside_a_wall = 0.4;
  std::map<std::pair<int, char>, std::array<double, 2>> escaped_and_all;
  const auto side_of = [&](std::size_t i) -> std::array<double, 2>& {
    const int patch = static_cast<int>(i);
    return escaped_and_all[{mesh.facet[mesh.first_element[patch]], mesh.is_back[patch]}];
  };
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    if (!arrivals[i].takes_part) continue;
    auto& [escaped, all] = side_of(i);
    escaped += mesh.area[static_cast<int>(i)] * arrivals[i].escaped;
    all += mesh.area[static_cast<int>(i)];
  }
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    if (!arrivals[i].takes_part) continue;
    const auto [escaped, all] = side_of(i);
    arrivals[i].is_outside =
        arrivals[i].escaped > (escaped > enough * all ? beside_a_wall : enough);
  }
}

// The node of each patch, -1 for those that take no part. Patches that see little but the outside
// share one.
std::vector<int> nodes_of(const std::vector<PartRayEnds>& arrivals, int& count) {
  std::vector<int> node(arrivals.size(), -1);
  int of_outside = -1;
  count = 0;
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    if (!arrivals[i].takes_part) continue;
    const bool is_of_outside = arrivals[i].is_outside;
    if (is_of_outside && of_outside >= 0) {
      node[i] = of_outside;
    } else {
      node[i] = count++;
      if (is_of_outside) of_outside = node[i];
    }
  }
  return node;
}

// The exchange of both directions, weighted by the inverse of the variance of each: rays of a patch
// of area A out of N find A_i F_ij to a variance proportional to A / N.
std::vector<ExchangeLink> links_of(const PatchMesh& mesh, const std::vector<int>& node,
                                   const std::vector<PartRayEnds>& arrivals) {
  std::vector<ExchangeLink> links;
  for (int i = 0; i < mesh.patch_count(); ++i) {
    for (const RayArrivals& at : arrivals[i].at) {
      if (node[at.patch] < 0 || at.patch == i) continue;
      const double both = mesh.area[i] * mesh.area[at.patch] / (mesh.area[i] + mesh.area[at.patch]);
      links.push_back({node[i], node[at.patch], static_cast<float>(both * double{at.share})});
    }
  }
  return links;
}

// The clusters of the patches that are too small, or too flat, to be parts of their own.
class TinyClusters {
 public:
  TinyClusters(const PatchMesh& mesh, const std::vector<PartRayEnds>& arrivals)
      : mesh_(mesh), arrivals_(arrivals) {
    // A thousand rooms may be parts, and the inside of a table leg is none.
    constexpr double smallest = 1.0 / 1024.0;
    for (int i = 0; i < mesh.patch_count(); ++i) {
      if (arrivals[i].takes_part && !arrivals[i].is_outside) {
        smallest_area_ += smallest * mesh.area[i];
      }
    }
  }

  // 1 for each cluster that is to join another; `cluster` of each patch, -1: none.
  std::vector<char> find(const std::vector<int>& cluster) const {
    const std::vector<ClusterSums> sums = sums_of_clusters(mesh_, arrivals_, cluster);
    ClusterSums largest;
    for (const ClusterSums& of : sums) {
      if (of.is_enclosed() && of.area > largest.area) largest = of;
    }
    std::vector<char> is_tiny;
    for (const ClusterSums& of : sums) {
      constexpr int fewest = 4;  // a room has as many walls
      is_tiny.push_back(of.patches < fewest || of.area < smallest_area_ || is_crack(of) ||
                        is_hollow(of, largest));
    }
    return is_tiny;
  }

 private:
  static bool is_crack(const ClusterSums& of) {
    constexpr double crack = 1.0 / 32.0;
    return of.is_enclosed() && of.mean_length() < crack * std::sqrt(of.area);
  }

  // The inside of a drawer, a lampshade or a column beside the room that it stands in. The mean
  // length of rays is 4 V / A in a convex room (Cauchy): 2.6 m in a living room of 4 m x 5 m x 3 m,
  // 1 m in the smallest toilet, 0.5 m in a column half a metre thick, 0.1 m in a drawer.
  static bool is_hollow(const ClusterSums& of, const ClusterSums& largest) {
    constexpr double small = 1.0 / 20.0, shallow = 1.0 / 5.0;
    return of.is_enclosed() && of.area < small * largest.area &&
           of.mean_length() < shallow * largest.mean_length();
  }

  const PatchMesh& mesh_;
  const std::vector<PartRayEnds>& arrivals_;
  double smallest_area_ = 0.0;  // of a part, m^2
};

// Renumbers clusters in falling order of area. Tiny clusters that exchange nothing with any other
// join the largest.
std::vector<double> sort_by_area(const PatchMesh& mesh, const std::vector<char>& is_tiny,
                                 std::vector<int>& cluster) {
  std::vector<double> area(is_tiny.size(), 0.0);
  for (int i = 0; i < mesh.patch_count(); ++i) {
    if (cluster[i] >= 0) area[cluster[i]] += mesh.area[i];
  }
  std::vector<int> order(area.size()), number(area.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](int a, int b) { return area[a] > area[b]; });
  std::vector<double> sorted;
  for (const int c : order) {
    const bool joins_first = !sorted.empty() && is_tiny[c] != 0;
    number[c] = joins_first ? 0 : static_cast<int>(sorted.size());
    if (joins_first) {
      sorted.front() += area[c];
    } else {
      sorted.push_back(area[c]);
    }
  }
  for (int& c : cluster) c = c < 0 ? -1 : number[c];
  return sorted;
}

// Names parts by the one or two surfaces that have most of their area, those of which most lies in
// the part first. Equal names are numbered.
void name_parts(const Scene& scene, const PatchMesh& mesh, SceneParts& parts) {
  std::vector<std::map<int, double>> area(parts.parts.size());
  std::vector<double> whole(scene.surfaces.size(), 0.0);
  for (int i = 0; i < mesh.patch_count(); ++i) {
    if (parts.of_patch[i] < 0) continue;
    area[parts.of_patch[i]][mesh.surface[i]] += mesh.area[i];
    whole[mesh.surface[i]] += mesh.area[i];
  }
  std::map<std::string, int> uses;
  for (std::size_t p = 0; p < area.size(); ++p) {
    std::vector<std::tuple<bool, double, int>> by_area;
    for (const auto& [surface, size] : area[p]) {
      by_area.emplace_back(size <= 0.5 * whole[surface], -size, surface);
    }
    std::ranges::sort(by_area);
    std::string& name = parts.parts[p].name;
    for (std::size_t i = 0; i < std::min<std::size_t>(by_area.size(), 2); ++i) {
      const std::string& surface = scene.surfaces[std::get<2>(by_area[i])].name;
      if (surface.empty() || surface == name) continue;
      name += (name.empty() ? "" : ", ") + surface;
    }
    if (name.empty()) name = "part";
    if (const int use = ++uses[name]; use > 1) name += fmt::format(" ({})", use);
  }
}

// The numbers of clusters from 0 on without gaps, in the order in which they are met.
void renumber(std::vector<int>& cluster) {
  std::map<int, int> number;
  for (int& c : cluster) c = number.try_emplace(c, static_cast<int>(number.size())).first->second;
}

// Parts the outside from rooms that it was not cut from, since a window is wide or walls mirror.
// The light of a room that loses little of it to the outside and the sky is a small share of the
// light outside, and errors that count as shares of both are no measure of it. An outside that is
// smaller than the room, such as what stands before the open side of a box, counts little beside
// it.
void part_outside(const PatchMesh& mesh, const std::vector<PartRayEnds>& arrivals,
                  const std::vector<int>& node, const std::vector<ExchangeLink>& links,
                  std::vector<int>& cluster) {
  constexpr double most_open = 0.2;  // a room of 4 m x 5 m x 3 m with a wall of glass has 0.13
  int outside = -1;
  std::vector<double> area(cluster.size(), 0.0), escaped(area);
  for (int i = 0; i < mesh.patch_count(); ++i) {
    if (node[i] < 0) continue;
    area[node[i]] += mesh.area[i];
    escaped[node[i]] += mesh.area[i] * arrivals[i].escaped;
    if (arrivals[i].is_outside) outside = node[i];
  }
  if (outside < 0) return;
  const auto is_joined = [&](int n) { return cluster[n] == cluster[outside]; };
  std::vector<ExchangeLink> inside;
  for (const ExchangeLink& link : links) {
    const bool leads_out = link.a == outside || link.b == outside;
    if (!leads_out && is_joined(link.a) && is_joined(link.b)) inside.push_back(link);
  }
  const std::vector<int> part = cut_graph(ExchangeGraph(area, inside));
  std::vector<double> all(cluster.size(), 0.0), open(all);  // of the new parts
  for (std::size_t n = 0; n < cluster.size(); ++n) {
    all[part[n]] += area[n];
    open[part[n]] += escaped[n];
  }
  for (const auto& [a, b, exchange] : links) {
    if (part[a] == part[b] || !is_joined(a) || !is_joined(b)) continue;
    for (const int n : {a, b}) open[part[n]] += double{exchange};
  }
  const int others = *std::ranges::max_element(cluster) + 1, with_outside = cluster[outside];
  for (int n = 0; n < static_cast<int>(cluster.size()); ++n) {
    if (n == outside || cluster[n] != with_outside) continue;
    const double room = all[part[n]];
    if (open[part[n]] <= most_open * room && room <= area[outside]) cluster[n] = others + part[n];
  }
  renumber(cluster);
}

std::vector<int> to_patches(const std::vector<int>& node, const std::vector<int>& cluster) {
  std::vector<int> of(node.size(), -1);
  for (std::size_t i = 0; i < node.size(); ++i) of[i] = node[i] < 0 ? -1 : cluster[node[i]];
  return of;
}

}  // namespace

SceneParts find_parts(const Scene& scene, const ElementCaster& caster, const LightPaths& paths,
                      const Progress& progress) {
  const PatchMesh& mesh = caster.mesh();
  std::vector<PartRayEnds> arrivals = cast_part_rays(scene, caster, paths, progress);
  mark_outside(mesh, arrivals);
  int nodes = 0;
  const std::vector<int> node = nodes_of(arrivals, nodes);
  SceneParts parts{.of_patch = std::vector<int>(node.size(), -1)};
  if (nodes == 0) return parts;
  std::vector<double> area(static_cast<std::size_t>(nodes), 0.0);
  for (int i = 0; i < mesh.patch_count(); ++i) {
    if (node[i] >= 0) area[node[i]] += mesh.area[i];
  }
  const std::vector<ExchangeLink> links = links_of(mesh, node, arrivals);
  const ExchangeGraph graph(std::move(area), links);
  std::vector<int> cluster = cut_graph(graph);
  part_outside(mesh, arrivals, node, links, cluster);
  const TinyClusters tiny(mesh, arrivals);
  join_clusters(graph, tiny.find(to_patches(node, cluster)), cluster);
  parts.of_patch = to_patches(node, cluster);
  for (const double of : sort_by_area(mesh, tiny.find(parts.of_patch), parts.of_patch)) {
    parts.parts.push_back({.area = of});
  }
  name_parts(scene, mesh, parts);
  mark_lit_by_cracks(scene, caster, paths, arrivals, parts);
  return parts;
}

}  // namespace lightwell
