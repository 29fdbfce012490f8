#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/elements/element_caster.h"
#include "radiosity/visibility/clear_panes.h"

namespace lightwell {

/// A shadow ray, and what it would carry if nothing were in its way.
struct ShadowSample {
  Ray ray{};
  double weight = 0.0;  ///< of the unoccluded kernel; a sample of weight 0 is not cast
};

/// What the shadow rays of one point or pair found.
struct ShadowTally {
  double all = 0.0, seen = 0.0,
         squares = 0.0;  ///< of weights, of those not blocked, of all squared

  double dimmed = 0.0;   ///< of those that reach through clear panes
  Spectrum through{};    ///< what those carry; empty: there are none
  bool blocked = false;  ///< something that is no pane is in the way of one

  /// Visible share, weighted as the kernel is: exact where all rays agree. 0 without rays.
  double share() const { return all > 0.0 ? seen / all : 0.0; }
  /// Variance of share(), the rays taken as independent.
  double variance() const {
    const double s = share();
    return all > 0.0 ? s * (1.0 - s) * squares / (all * all) : 0.0;
  }
  bool is_mixed() const {
    if (dimmed > 0.0) return blocked || seen > 0.0;
    return seen > 0.0 && seen < all;
  }
};

/// Casts shadow rays of many tallies together, in batches that suit the ray caster. Tallies are
/// added to in the order of add(), whatever the batches.
class ShadowBatch {
 public:
  /// Rays that meet nothing but `panes`, if given, are dimmed and not blocked.
  ShadowBatch(const ElementCaster& caster, std::span<ShadowTally> tallies,
              const ClearPanes* panes = nullptr)
      : caster_(caster), tallies_(tallies), panes_(panes) {}

  void add(int tally, const ShadowSample& sample);
  /// Casts what add() has left waiting; the tallies are complete only after it.
  void flush();

 private:
  void add_through_panes(const Ray& ray, double weight, ShadowTally& tally) const;

  static constexpr std::size_t size = 256;
  const ElementCaster& caster_;
  std::span<ShadowTally> tallies_;
  const ClearPanes* panes_;
  std::size_t count_ = 0;
  std::array<Ray, size> rays_;
  std::array<double, size> weights_;
  std::array<int, size> tally_of_;
};

}  // namespace lightwell
