#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/visibility/clear_panes.h"
#include "scene/sampling.h"
#include "scene/scene.h"
#include "scene/surface_point.h"

namespace lightwell {

/// Rays to what is known of the sky: `first`, and `most` unless all get out; a third more
/// elsewhere.
struct SkyEffort {
  int first = 32;
  int most = 128;  ///< 1 to most_sky_rays
};
constexpr int most_sky_rays = 1024;

/// What reaches a point from the dome.
struct SkyGlow {
  Spectrum irradiance{};  ///< W/m^2
  bool is_mixed = false;  ///< a part of the dome is hidden, so that rays leave noise
};

/// Irradiance from the dome of a Sky, without its sun, which is another source.
///
/// The dome is cut into cells of even solid angle, 5.6 degrees wide, whose irradiance of a point
/// with nothing in the way is known. What a window shows is a small part of that, so rays are not
/// spent evenly: *sites*, cubes of space by the side that surfaces in them face, learn beforehand
/// through which cells rays get out, and a point sends its rays there, by what each would give it
/// and how likely it is open. Some go elsewhere, weighted for it, so that what no ray of the site
/// had found is right in the mean. Of the cells that are open the result is what the rays see, less
/// what they make too much of the known irradiance, times the share that is seen: with nothing in
/// the way there is no noise.
///
/// Within cells directions follow the sky's luminance on a grid of 0.7 degrees, on which maps are
/// averaged.
class SkyLight {
 public:
  /// Of a scene that has a sky. Casts rays from the mesh's surfaces to learn; the same bits for any
  /// number of threads.
  SkyLight(const Scene& scene, const PatchMesh& mesh);

  /// E per band, W/m^2, at a point. `key` decides the directions of the rays; panes dim the light
  /// that passes through them.
  SkyGlow irradiance(const ElementCaster& caster, const SurfacePoint& at, std::uint64_t key,
                     const SkyEffort& effort = {}) const;

  /// The same with nothing in the way, to 1e-4 of it; of a uniform sky or a horizontal surface to
  /// 1e-6.
  Spectrum unobstructed(const Eigen::Vector3d& normal) const;

 private:
  static constexpr int around = 64, rings = 32;  // cells
  static constexpr int cells = around * rings;
  static constexpr int fine = 8;  // grid within a cell, each way
  /// Rays tried through each cell, and those that got out.
  struct CellVisibility {
    std::array<float, cells> tried{}, open{};
  };
  /// What rays to each cell are given by, next to what it would give; 0: none is known to get out.
  using Site = std::array<float, cells>;
  struct Cell {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();  // unit
    /// int L w dw over the cell, W/m^2, L being the mean of the bands.
    Eigen::Vector3f vector = Eigen::Vector3f::Zero();
    double power = 0.0;  // int L dw
  };
  struct Draw {
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
    double density = 0.0;  // 1/sr within the cell, by luminance
  };
  /// A point's cells above its horizon that give it light.
  struct Share {
    int cell = 0;
    double E = 0.0;       // unobstructed, mean of the bands
    double likely = 0.0;  // the root of how likely it is open; 0: not known to be
    double cdf = 0.0;     // running sum of what rays are given by
    double weight = 0.0;  // its step
    bool is_open() const { return likely > 0.0; }
  };
  struct Tally {
    Eigen::ArrayXd seen_open, all_open, seen_elsewhere;  // per band
    int rays = 0, clear = 0;
  };

  void tabulate(const Sky& sky);
  void learn(const ElementCaster& caster);
  CellVisibility sample_cells(const ElementCaster& caster, std::span<const SurfacePoint> points,
                              std::uint64_t key) const;
  static Site site_of(const CellVisibility& own, std::span<const CellVisibility* const> beside);
  std::uint64_t site_key(const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                         double cube) const;
  Eigen::Vector3d direction_at(int cell, double u, double v) const;
  Draw draw(int cell, double u, double v) const;
  double irradiance_of(int cell, const Eigen::Vector3f& normal) const;
  void cast(const ElementCaster& caster, const SurfacePoint& at, std::span<const Share> shares,
            int rays, std::uint64_t key, Tally& tally) const;

  int bands_ = 0;
  ClearPanes panes_;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  // columns: north, east, up
  std::array<Cell, cells> cell_{};
  std::array<int, cells> order_{};   // in which steps go over them
  std::vector<float> radiance_{};    // of the fine grid, cell after cell, mean of the bands
  std::vector<float> row_cdf_{};     // of the rows of each cell's fine grid
  std::vector<float> column_cdf_{};  // within each of its rows
  BandArray colour_{};               // cells x bands, of radiance over its mean
  double cube_ = 1.0;                // m
  std::unordered_map<std::uint64_t, int> site_of_{};
  std::vector<Site> sites_{};
  SobolPoints sobol_;
};

}  // namespace lightwell
