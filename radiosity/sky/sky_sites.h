#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/sky/sky_cells.h"
#include "radiosity/visibility/clear_panes.h"
#include "scene/surface_point.h"

namespace lightwell {

/// Factor on the rays to cells that are not known as open, for the `open` and `elsewhere` sums of
/// sampling weights: at most a third as many rays go there as to open cells; if no cell is known as
/// open, all do. Fewer would be as exact in the mean, but each ray that gets out would weigh more
/// and leave a bright dot in a picture.
double thinning_elsewhere(double open, double elsewhere);

/// Visibility of the sky from *sites*: cubes of space, by the side that the surfaces in them face.
/// Rays cast beforehand from surfaces of each site find through which cells of the sky rays get
/// out, so that points near by can send their rays there. The rays of a site are cast when a point
/// in the site is first asked for: a picture, or a few probes, ask for few sites.
///
/// A hole that is small against a cell lets few rays of few sites out. The sites that found nothing
/// learn from these *ways out*: a point that moves along a way is seen from another place until it
/// has passed the hole, so bisection finds the hole as that place sees it, however small it is.
class SkySites {
 public:
  /// Per cell, the sampling weight of its rays beside its unobstructed irradiance; 0: no ray of the
  /// site got out.
  using Weights = std::array<float, SkyCells::count>;
  struct Site {
    Weights weights{};
    /// Running sum over the cells of the weights that single rays are drawn by: power, times what
    /// `weights` says, times the cosine to the axis that surfaces of the site face.
    std::array<float, SkyCells::count> sum{};
    /// Share of the rays through each cell that got out: those of the site, or where it has none,
    /// those of the cells and sites beside.
    std::array<float, SkyCells::count> open{};
  };

  /// Sites of the surfaces of the caster's mesh, which must outlive them, or last until find_all().
  /// Surfaces that move are at rest. `cells` and `panes` must outlive the sites.
  SkySites(const SkyCells& cells, const ClearPanes& panes, double scene_diagonal,
           const ElementCaster& caster);

  /// Casts the rays of all sites. The mesh is not read afterwards.
  void find_all();

  /// The site that holds a point; null: no surface lies there. May be called by any number of
  /// threads, and gives the same bits for any.
  const Site* find(const SurfacePoint& at) const;
  /// The site of points of which nothing is known: all cells count by their power.
  const Site& unknown() const { return unknown_; }
  /// Weights of a point that lies in no site, from rays of the point alone.
  Weights sample(const ElementCaster& caster, const SurfacePoint& at, std::uint64_t key) const;

 private:
  /// A ray that got out of the scene.
  struct WayOut {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // unit
    int alike = 0;                                         // rays of the same place that got out
  };
  /// Rays tried through each cell, and those that got out.
  struct CellVisibility {
    std::array<float, SkyCells::count> tried{}, open{};
    std::vector<WayOut> ways{};  // two at most
  };
  using Points = std::vector<SurfacePoint>;
  struct Collector;
  /// A cube on one side of surfaces, and what is known of it so far.
  struct Place {
    Place(std::uint64_t of, Points at) : key(of), points(std::move(at)) {}
    std::uint64_t key;
    Points points;
    std::once_flag is_sampled{}, is_found{};
    std::unique_ptr<const CellVisibility> visibility{};
    std::unique_ptr<const Site> site{};
  };

  const CellVisibility& visibility_of(Place& place) const;
  const Site& site_of(Place& place) const;
  CellVisibility visibility_by_ways(const ElementCaster& caster,
                                    std::span<const SurfacePoint> points, std::uint64_t key,
                                    const CellVisibility& by_rays) const;
  CellVisibility sample_cells(const ElementCaster& caster, std::span<const SurfacePoint> points,
                              std::uint64_t key) const;
  const std::vector<WayOut>& ways_out() const;
  std::optional<Eigen::Vector3d> direction_out(const ElementCaster& caster,
                                               const SurfacePoint& point, const WayOut& way) const;
  bool gets_out(const ElementCaster& caster, const Ray& ray) const;
  static Weights weights_of(const CellVisibility& own,
                            std::span<const CellVisibility* const> beside);
  Site site_by(const Weights& weights, const Eigen::Vector3d& axis) const;

  const SkyCells& cells_;
  const ClearPanes& panes_;
  std::optional<ElementCaster> caster_;  // empty: all sites are found
  double cube_ = 1.0;                    // m, edge of a site
  std::unordered_map<std::uint64_t, int> place_of_{};
  Eigen::AlignedBox3d bounds_{};  // of the surfaces
  mutable std::deque<Place> places_{};
  mutable std::once_flag are_ways_found_{};
  mutable std::vector<WayOut> ways_out_{};
  Site unknown_{};
};

}  // namespace lightwell
