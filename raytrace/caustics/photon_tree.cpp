#include "raytrace/caustics/photon_tree.h"

#include <algorithm>
#include <numeric>

namespace lightwell {

PhotonSums each_photon(const CausticPhotons& photons) {
  PhotonSums sums{.position = photons.position, .element = photons.element, .power = photons.power};
  if (sums.count() > 0) sums.square = photons.power.rowwise().mean().square();
  return sums;
}

PhotonTree build_photon_tree(const PatchMesh& mesh, const LightRegions& regions,
                             const PhotonSums& photons) {
  PhotonTree result;
  result.root.assign(static_cast<std::size_t>(regions.count()), -1);
  const int count = photons.count();
  for (const Eigen::Vector3d& p : photons.position) result.origin += p / count;
  const auto region_of = [&](int photon) {
    return regions
        .of_element[static_cast<std::size_t>(photons.element[static_cast<std::size_t>(photon)])];
  };
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, region_of);
  for (const int i : order) {
    const auto p = static_cast<std::size_t>(i);
    result.tree.discs.push_back(
        {.center = (photons.position[p] - result.origin).cast<float>(),
         .normal = element_center(mesh, photons.element[p]).normal.cast<float>(),
         .photon = i});
  }
  for (int begin = 0; begin < count;) {
    const int region = region_of(order[static_cast<std::size_t>(begin)]);
    int end = begin;
    while (end < count && region_of(order[static_cast<std::size_t>(end)]) == region) ++end;
    result.root[static_cast<std::size_t>(region)] = result.tree.build(begin, end);
    begin = end;
  }
  return result;
}

PhotonSums clustered(const PhotonTree& tree, const PhotonSums& photons, int most) {
  std::vector<int> nodes;
  for (const int root : tree.root) {
    if (root >= 0) tree.tree.collect(root, most, nodes);
  }
  const auto count = static_cast<Eigen::Index>(nodes.size());
  PhotonSums sums{.power = BandArray::Zero(count, photons.power.cols()),
                  .square = Eigen::ArrayXf::Zero(count)};
  for (Eigen::Index row = 0; row < count; ++row) {
    const DiscTree::Node& node =
        tree.tree.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(row)])];
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = node.begin; i < node.end; ++i) {
      const int photon = tree.tree.discs[static_cast<std::size_t>(i)].photon;
      sum += photons.position[static_cast<std::size_t>(photon)];
      sums.power.row(row) += photons.power.row(photon);
      sums.square[row] += photons.square[photon];
    }
    const int first = tree.tree.discs[static_cast<std::size_t>(node.begin)].photon;
    sums.position.push_back(sum / (node.end - node.begin));
    sums.element.push_back(photons.element[static_cast<std::size_t>(first)]);
  }
  return sums;
}

}  // namespace lightwell
