#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "radiosity/gather/bright_patches.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/gather/gap_light.h"
#include "radiosity/gather/read_radiosity.h"
#include "radiosity/openings/portals.h"
#include "radiosity/paths/light_path.h"
#include "scene/coat.h"
#include "scene/hemisphere_sets.h"
#include "scene/sampling.h"

namespace lightwell {

/// Indirect irradiance at points by rays over the hemisphere, for gather_irradiance(), whose
/// arguments these are.
class HemisphereGather {
 public:
  /// `points` give the numbers of rays to prepare for. Keeps references to all but `points`.
  HemisphereGather(const LitScene& lit, const BandArray& radiosity, const GatherOptions& options,
                   const GatherPoints& points);
  /// Shares of vertices in place of their light (see gather_shares()).
  HemisphereGather(const LitScene& lit, const GatherOptions& options, const GatherPoints& points);

  /// E = (1/N) sum B over N cosine-distributed rays and, if there are bright patches or portals,
  /// rays aimed at them besides; B of all kinds is weighted by the balance heuristic. Writes the
  /// columns of `irradiance`, W/m^2, and the variance of the mean of the bands, (W/m^2)^2. The
  /// first and the second half of the rays are each stratified.
  void gather(const GatherPoint& at, std::uint64_t key, float* irradiance, float& variance) const;

  /// The same light as the base under a coat at the point gets it, by CoatedBase::factor() of each
  /// ray, and as it arrives: columns x 2, W/m^2. The factor is over its mean for the
  /// cosine-distributed rays, so that the two are equal in even light.
  Eigen::ArrayX2d gather_at_base(const GatherPoint& at, std::uint64_t key,
                                 const CoatedBase& base) const;

 private:
  HemisphereGather(const LitScene& lit, ReadRadiosity radiosity, BrightPatches bright,
                   const GatherOptions& options, const GatherPoints& points);

  // Sums over the rays of a point under a coat: of the factors of the cosine-distributed rays, and
  // of the light of all rays by their factors.
  struct AtBase {
    const CoatedBase& base;
    double factors = 0.0;
    Eigen::ArrayXd light{};
  };
  // A gather point, and the bright patches, portals and exits of a gap that are seen from there.
  struct Place {
    const GatherPoint& at;
    std::uint64_t key = 0;
    int rays = 0;  // cosine-distributed
    BrightPatches::View bright{};
    Portals::View portals{};
    std::optional<GapExits> exits{};
    AtBase* at_base = nullptr;  // null: the light of no base is wanted
  };
  using Sums = std::array<Eigen::ArrayXd, 2>;  // of the two halves of the rays

  Sums sums(Place& place) const;
  template <class Add>
  static void add_to(const Place& place, const Ray& ray, Eigen::ArrayXd& sum, Add&& add);
  double aimed_density(const Place& place, const Ray& ray, const ElementHit& hit) const;

  void aim_at_bright(const Place& place, Sums& sum) const;

  void aim_at_portals(const Place& place, Sums& sum) const;

  void aim_at_exits(const Place& place, Sums& sum) const;

  template <class Draw, class Counts>
  void aim(const Place& place, const SobolPoints& aims, std::uint64_t key, int first_index,
           Draw draw, Counts counts, Sums& sum) const;

  void add(const Place& place, const Ray& ray, const ElementHit& hit, std::uint64_t index,
           double aimed, Eigen::ArrayXd& sum) const;

  void add_straight(const Place& place, const Ray& ray, const ElementHit& hit, double share,
                    Eigen::ArrayXd& sum) const;

  void add_of_gap(const Place& place, const Ray& ray, const ElementHit& hit, std::uint64_t key,
                  double share, Eigen::ArrayXd& sum) const;

  bool is_in_gap(const Place& place, const Ray& ray, const ElementHit& hit) const;

  bool is_near_portal(const Place& place, const Ray& ray, const ElementHit& hit) const;

  void add_path(const Ray& ray, const ElementHit& hit, std::uint64_t key, double share,
                Eigen::ArrayXd& sum) const;

  float half_difference(const std::array<Eigen::ArrayXd, 2>& sum, int count) const;

  const ElementCaster& caster_;
  ReadRadiosity radiosity_;
  LightPaths paths_;
  const GatherOptions& options_;
  Eigen::Index bands_;
  Spectrum dome_{};  // scale of the sky's light per band; empty without a sky
  Eigen::Index dome_column_ = 0;
  std::map<int, HemisphereSets> sets_;  // by number of rays
  BrightPatches bright_;
  GapLight gaps_;
  // Points of rays aimed at bright patches and at portals, by the number of rays in sets_.
  std::map<int, SobolPoints> aims_, portal_aims_;
};

}  // namespace lightwell
