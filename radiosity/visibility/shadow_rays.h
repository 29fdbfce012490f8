#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/visibility/clear_panes.h"

namespace lightwell {

/// A shadow ray and its weight.
struct ShadowSample {
  Ray ray{};
  double weight = 0.0;  ///< unoccluded kernel; a sample of weight 0 is not cast
  /// Exitance r, g, b at the sample point of an emitter that shines by a picture; null: even.
  const Eigen::Array3f* exitance = nullptr;
};

/// Sums over the shadow rays of one point or pair.
struct ShadowTally {
  double all = 0.0, seen = 0.0,
         squares = 0.0;  ///< sums of weights, of weights of unblocked rays, of squared weights

  double dimmed = 0.0;  ///< sum of weights of rays that cross clear panes or an absorbing body
  /// Sum of weight times transmittance of these rays, per band; empty without such rays.
  Spectrum through{};
  bool blocked = false;  ///< some ray of dimmed tallies meets more than clear panes
  /// Sums of weight times exitance of samples of a picture, and of those of unblocked rays.
  Eigen::Array3d pictured = Eigen::Array3d::Zero(), pictured_seen = Eigen::Array3d::Zero();

  /// Visible share of the kernel: exact where all rays agree. 0 without rays.
  double share() const { return all > 0.0 ? seen / all : 0.0; }
  /// Share of a picture's light, per band, of which `part` is the sum that is visible:
  /// pictured_seen or, behind clear panes, `through`. share() in bands in which no sample shines.
  Spectrum share_of_picture(const Eigen::Array3d& part) const {
    return (pictured > 0.0).select(part / pictured.max(1e-300), share()).cast<float>();
  }
  /// Variance of share() for independent rays.
  double variance() const {
    const double s = share();
    return all > 0.0 ? s * (1.0 - s) * squares / (all * all) : 0.0;
  }
  bool is_mixed() const {
    if (dimmed > 0.0) return blocked || seen > 0.0;
    return seen > 0.0 && seen < all;
  }
};

/// Panes and the body around a point, which dim shadow rays instead of blocking them.
struct ShadowMedium {
  const ClearPanes* panes = nullptr;  ///< null: none
  /// Absorption coefficient, 1/m, of the body that the rays run in; null: none absorbs.
  const Spectrum* absorption = nullptr;

  /// Transmittance per band of a ray that is not blocked or, if `is_blocked`, blocked by panes
  /// alone; 0 in all bands otherwise.
  Spectrum passed(const ElementCaster& caster, const Ray& ray, bool is_blocked) const;
  /// True if rays that are not blocked may arrive dimmed.
  bool absorbs() const { return absorption != nullptr; }
};

/// Casts shadow rays of many tallies in batches that suit the ray caster. Tallies accumulate in the
/// order of add(), independently of the batches.
class ShadowBatch {
 public:
  ShadowBatch(const ElementCaster& caster, std::span<ShadowTally> tallies,
              const ShadowMedium& medium = {})
      : caster_(caster), tallies_(tallies), medium_(medium) {}

  void add(int tally, const ShadowSample& sample);
  /// Casts all waiting rays. Tallies are complete only after flush().
  void flush();

 private:
  // The rest of a waiting ray's sample.
  struct Waiting {
    double weight = 0.0;
    const Eigen::Array3f* exitance = nullptr;
    int tally = 0;
  };
  void add_dimmed(const Ray& ray, const Waiting& of_ray, bool is_blocked, ShadowTally& tally) const;

  static constexpr std::size_t most = 256;
  const ElementCaster& caster_;
  std::span<ShadowTally> tallies_;
  ShadowMedium medium_;
  // Grow as rays come: many points need a single one.
  std::vector<Ray> rays_{};
  std::vector<Waiting> waiting_{};
};

}  // namespace lightwell
