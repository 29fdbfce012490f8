#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <optional>

#include "raytrace/cameras/camera_ray.h"
#include "raytrace/gloss_mask.h"
#include "raytrace/shading/render_options.h"
#include "raytrace/shading/shade.h"
#include "scene/sampling.h"

namespace lightwell {

/// Steps of the lattice per pixel. Samples are keyed by their point on the lattice, whatever the
/// subdivision, so a finer picture keeps the samples of a coarser one.
inline constexpr int lattice_steps = 1 << deepest_subdivision;

/// Counts of rays. The weight of cut branches is in integer steps, so that sums do not depend on
/// the order.
struct RayCounts {
  static constexpr double weight_step = 0x1p-30;
  std::int64_t eye_rays = 0, depth_cut = 0, cut_steps = 0;
};

/// Counts of a picture's rays, added up by all threads.
struct RayCounters {
  std::atomic<std::int64_t> eye_rays{0}, depth_cut{0}, cut_steps{0};

  /// Returns the counts since `before`.
  RayCounts since(const RayCounts& before) const {
    return {.eye_rays = eye_rays - before.eye_rays,
            .depth_cut = depth_cut - before.depth_cut,
            .cut_steps = cut_steps - before.cut_steps};
  }
  void add(const RayCounts& counts) {
    eye_rays += counts.eye_rays;
    depth_cut += counts.depth_cut;
    cut_steps += counts.cut_steps;
  }

  void add_cut(double weight) {
    if (weight > 0.0) cut_steps += std::llround(weight / RayCounts::weight_step);
  }
};

/// Tracer of points of the picture, given in lattice steps from the top left corner, as points of a
/// panel (see PicturePlane). Where the picture shows nothing, points are black.
class Eye {
 public:
  Eye(const CameraRays& rays, const RayTree& tree, RayCounters& counters)
      : rays_(rays), tree_(tree), counters_(counters) {}

  /// Traces a point; the random numbers are those of the lattice point above and to its left.
  RaySample trace(double x, double y, int panel, float effort = 1.0f) const {
    const auto ray = ray_at(x, y, panel);
    if (!ray) return tree_.nothing();
    const auto key = random_key(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y));
    RaySample sample = tree_.trace(*ray, key, effort, rays_.cone(step * x, step * y, panel));
    counters_.eye_rays.fetch_add(1, std::memory_order_relaxed);
    counters_.depth_cut.fetch_add(sample.depth_cut, std::memory_order_relaxed);
    counters_.add_cut(double{sample.cut_weight});
    return sample;
  }
  /// Returns the same eye with counters of its own.
  Eye counting_in(RayCounters& counters) const { return {rays_, tree_, counters}; }
  std::uint64_t fingerprint(double x, double y, int panel) const {
    const auto ray = ray_at(x, y, panel);
    return ray ? tree_.fingerprint(*ray, rays_.cone(step * x, step * y, panel)) : 0;
  }
  /// Returns the panel of a pixel.
  int panel_of_pixel(int x, int y) const { return rays_.panel_at(x + 0.5, y + 0.5); }
  /// Returns the pixels with gloss of rows `first` to `end` of a picture of `width` columns.
  GlossMask gloss(int width, int first, int end) const {
    return GlossMask(rays_, tree_, width, first, end);
  }

 private:
  static constexpr double step = 1.0 / lattice_steps;

  std::optional<Ray> ray_at(double x, double y, int panel) const {
    return rays_.ray_at(step * x, step * y, panel);
  }

  const CameraRays& rays_;
  const RayTree& tree_;
  RayCounters& counters_;
};

}  // namespace lightwell
