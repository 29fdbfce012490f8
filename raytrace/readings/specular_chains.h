#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "radiosity/gather/final_gather.h"
#include "raytrace/shading/shade.h"

namespace lightwell {

/// A path by way of smooth surfaces from one of the first rays.
struct SpecularSeed {
  Eigen::Vector3d direction;     ///< at the point, unit
  Eigen::Vector3d origin, exit;  ///< last straight part; exit is unit
  double end = 0.0;              ///< m, of the last straight part
  double weight = 0.0;           ///< mean of the bands
};

/// Paths that meet the same smooth surfaces in the same order.
struct SpecularChain {
  ChainTurns turns{};
  std::vector<SpecularSeed> seeds{};
  double weight = 0.0;      ///< sum over seeds
  double heaviest = 0.0;    ///< weight of a seed
  bool is_straight = true;  ///< light leaves it in the direction in which it came, as from a slab
  bool is_sought = false;   ///< Newton's method seeks its paths

  void add(const SpecularSeed& seed) {
    constexpr double unbent = 1e-6;
    seeds.push_back(seed);
    weight += seed.weight;
    heaviest = std::max(heaviest, seed.weight);
    is_straight = is_straight && (seed.exit - seed.direction).norm() < unbent;
  }
};
/// Chains by SpecularSegment::chain.
using SpecularChains = std::map<std::uint64_t, SpecularChain>;

/// A point that a path is to end at, or a direction that the path is to end in.
struct PathGoal {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  bool is_direction = false;  ///< `position` is a unit direction towards a source at infinity
};

/// A path that ends at its goal.
struct PathToGoal {
  Eigen::Vector3d direction;  ///< unit, at the point
  Eigen::Vector3d exit;       ///< unit, of the last straight part
  double distance = 0.0;      ///< m, of the last straight part, to the goal
  double spread = 0.0;        ///< |det A|, m^2/sr; for a direction sr/sr
  Spectrum weight{};
};

/// Seeker of paths from a point by way of smooth surfaces to a goal, each along a given chain
/// (Mitchell & Hanrahan 1992, "Illumination from curved reflectors").
class SpecularPaths {
 public:
  /// Keeps references.
  SpecularPaths(const RayTree& tree, const GatherPoint& at) : tree_(tree), at_(at) {}

  /// Newton's method from the nearest of the first rays; empty where the chain does not lead to the
  /// goal, or where another surface hides the goal (`clearance`, m, before it).
  std::optional<PathToGoal> find(const PathGoal& goal, std::uint64_t key,
                                 const SpecularChain& chain, double clearance) const;

 private:
  struct Traced {
    Eigen::Vector3d origin, exit;
    double end = 0.0;
    Spectrum weight{};
    Media media{};
    int facet = -1;  // that the last straight part begins at
  };
  std::optional<Traced> trace(const Eigen::Vector3d& direction, std::uint64_t chain,
                              const ChainTurns& turns) const;

  const RayTree& tree_;
  const GatherPoint& at_;
};

/// Light of all straight chains over that of the chains in `found` (ascending), by the first rays
/// within ten degrees of `towards` that follow a found chain and whose last part passes the goal:
/// one ray follows all chains that go to and fro between parallel faces of glass, and these lead to
/// the goal from nearly the same direction. Chains that other rays follow, as by way of another
/// pair of parallel mirrors, lead elsewhere. At most 2.
double all_straight(const SpecularChains& chains, const PathGoal& goal,
                    const Eigen::Vector3d& towards, std::span<const std::uint64_t> found,
                    double clearance);

}  // namespace lightwell
