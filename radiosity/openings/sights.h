#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/openings/find_openings.h"

namespace lightwell {

/// View through one side of an opening.
struct Sight {
  double brightness = 0.0;  ///< sum over paths
  double reference = 0.0;   ///< sum over paths of what errors are relative to
  int paths = 0;            ///< that ended on this side
  double distance = 0.0;    ///< metres, sum over paths that ended on a surface
  double squares = 0.0;     ///< m^2, sum over paths of their squared distances
  Eigen::AlignedBox3d region{};

  /// Largest distance of an end of a path from the middle of the opening, measured across the
  /// opening in half of its width.
  double spread = 0.0;

  double mean() const { return paths > 0 ? brightness / paths : 0.0; }
};

/// Paths from points of openings to what the openings show.
class Sights {
 public:
  /// `brightness` is that of each element, and so is `reference`; empty: not wanted. Keeps
  /// references.
  Sights(const ElementCaster& caster, const std::vector<float>& brightness,
         std::span<const float> reference = {})
      : caster_(caster), brightness_(brightness), reference_(reference) {}

  static constexpr int most_paths = 128;

  /// Adds paths begin to end - 1 from points of the opening towards its front (`side` 0) or back,
  /// and more of them until one has come out on that side: few paths get through a deep passage.
  void look(const Opening& opening, std::uint64_t key, int side, int begin, int end,
            Sight& sight) const;

 private:
  bool is_in_passage(const Eigen::Vector3d& at, const Eigen::Vector3d& normal, int facet,
                     double width) const;
  void follow(const Opening& opening, std::uint64_t path, const Eigen::Vector3d& outwards,
              Sight& sight) const;

  const ElementCaster& caster_;
  const std::vector<float>& brightness_;
  std::span<const float> reference_;
};

}  // namespace lightwell
