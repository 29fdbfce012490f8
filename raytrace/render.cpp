#include "raytrace/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "raytrace/camera_ray.h"
#include "raytrace/layer_film.h"
#include "raytrace/pixel_samples.h"
#include "raytrace/shade.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Samples are keyed by their place on a lattice of this many steps per pixel, whatever the
// subdivision in force, so that a finer picture keeps the samples of a coarser one.
constexpr int max_levels = 6;
constexpr int lattice_steps = 1 << max_levels;

constexpr std::uint64_t edge_purpose = 0xed6e;

void check(const RenderOptions& options) {
  const auto fail = [](const std::string& what) { throw std::invalid_argument("render: " + what); };
  const auto within = [&](const char* what, int value, int low, int high) {
    if (value >= low && value <= high) return;
    fail(fmt::format("{} is {}, it must lie between {} and {}", what, value, low, high));
  };
  within("max_subdivision", options.max_subdivision, 0, max_levels);
  within("max_depth", options.max_depth, 0, deepest_tree);
  within("gather_rays", options.gather_rays, 1, most_gather_rays);
  within("glossy_rays", options.glossy_rays, 1, 256);
  within("sampling.most", options.sampling.most, 0, SampleOptions::limit);
  within("sampling.least", options.sampling.least, 1, SampleOptions::limit);
  if (!(options.sampling.noise >= 0.0f)) fail("sampling.noise must not be negative");
  if (!(options.contrast > 0.0f)) fail("contrast must be above 0");
  if (!(options.min_contribution >= 0.0f)) fail("min_contribution must not be negative");
}

struct Counters {
  std::atomic<std::int64_t> eye_rays{0}, depth_cut{0};
};

// Looks at points of the picture, given in lattice steps from its top left corner.
class Eye {
 public:
  Eye(const CameraRays& rays, const RayTree& tree, Counters& counters)
      : rays_(rays), tree_(tree), counters_(counters) {}

  Sight look(int x, int y, float effort = 1.0f) const {
    const auto key = random_key(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y));
    Sight sight = tree_.look(ray(x, y), key, effort);
    counters_.eye_rays.fetch_add(1, std::memory_order_relaxed);
    counters_.depth_cut.fetch_add(sight.depth_cut, std::memory_order_relaxed);
    return sight;
  }
  std::uint64_t fingerprint(double x, double y) const { return tree_.fingerprint(ray(x, y)); }

 private:
  Ray ray(double x, double y) const {
    constexpr double step = 1.0 / lattice_steps;
    return rays_.ray(step * x, step * y);
  }

  const CameraRays& rays_;
  const RayTree& tree_;
  Counters& counters_;
};

// What a pixel is the mean of: radiance, and the layers that go with it.
struct PixelValue {
  Spectrum radiance{};
  SampledLayers layers = SampledLayers::Zero();

  static PixelValue zero(int bands) { return {.radiance = Spectrum::Zero(bands)}; }
  template <class Seen>  // a Sight or another PixelValue
  void add(const Seen& seen, float share) {
    radiance += share * seen.radiance;
    layers += share * seen.layers;
  }
};

// Mean radiance over one pixel's square by adaptive subdivision (Whitted 1980): the mean of the
// four corners where they agree, else of the four quarters.
class PixelMean {
 public:
  PixelMean(const Eye& eye, const RenderOptions& options)
      : eye_(eye),
        options_(options),
        cells_(1 << options.max_subdivision),
        steps_per_cell_(lattice_steps >> options.max_subdivision),
        sights_((cells_ + 1) * (cells_ + 1)),
        known_(sights_.size()) {}

  // `corners`: top left, top right, bottom left, bottom right.
  PixelValue operator()(int x, int y, const std::array<const Sight*, 4>& corners) {
    x_ = x * lattice_steps;
    y_ = y * lattice_steps;
    if (!must_split(0, 0, cells_, corners) && (cells_ > 1 || look_alike(corners))) {
      return mean(corners);
    }
    std::fill(known_.begin(), known_.end(), 0);
    for (int c = 0; c < 4; ++c) keep(cells_ * (c & 1), cells_ * (c >> 1), *corners[c]);
    return cell_mean(0, 0, cells_);
  }

 private:
  using Corners = std::array<const Sight*, 4>;

  int slot(int i, int j) const { return j * (cells_ + 1) + i; }

  void keep(int i, int j, Sight sight) {
    sights_[slot(i, j)] = std::move(sight);
    known_[slot(i, j)] = 1;
  }

  const Sight* sight(int i, int j) {
    if (!known_[slot(i, j)]) {
      // Samples of a finer level are more to average.
      int step = cells_;
      while ((i | j) % step != 0) step /= 2;
      const float effort = static_cast<float>(step) / static_cast<float>(cells_);
      keep(i, j, eye_.look(x_ + i * steps_per_cell_, y_ + j * steps_per_cell_, effort));
    }
    return &sights_[slot(i, j)];
  }

  PixelValue cell_mean(int i, int j, int size) {
    const Corners corners = {sight(i, j), sight(i + size, j), sight(i, j + size),
                             sight(i + size, j + size)};
    if (must_split(i, j, size, corners)) return split(i, j, size);
    return size == 1 && !look_alike(corners) ? edge_mean(i, j, corners) : mean(corners);
  }

  PixelValue split(int i, int j, int size) {
    const int half = size / 2;
    PixelValue sum = cell_mean(i, j, half);
    sum.add(cell_mean(i + half, j, half), 1.0f);
    sum.add(cell_mean(i, j + half, half), 1.0f);
    sum.add(cell_mean(i + half, j + half, half), 1.0f);
    return scaled(sum, 0.25f);
  }

  static PixelValue scaled(const PixelValue& value, float share) {
    return {.radiance = share * value.radiance, .layers = share * value.layers};
  }

  // Largest difference between corners in any band, over the bands' mean of the largest value.
  static float spread(const Corners& c) {
    float widest = 0.0f, sum = 0.0f;
    for (Eigen::Index k = 0; k < c[0]->radiance.size(); ++k) {
      const auto [low, high] =
          std::minmax({c[0]->radiance[k], c[1]->radiance[k], c[2]->radiance[k], c[3]->radiance[k]});
      widest = std::max(widest, high - low);
      sum += high;
    }
    return widest > 0.0f ? widest * static_cast<float>(c[0]->radiance.size()) / sum : 0.0f;
  }

  static PixelValue mean(const Corners& c) {
    PixelValue sum{.radiance = c[0]->radiance, .layers = c[0]->layers};
    for (int i = 1; i < 4; ++i) sum.add(*c[i], 1.0f);
    return scaled(sum, 0.25f);
  }

  // The smallest cell with an edge in it: each corner weighs what share of the cell looks like it.
  // Shares come from rays without shadow rays, which makes edges many times finer than samples; a
  // lamp's edge against a wall a hundred times darker needs that.
  PixelValue edge_mean(int i, int j, const Corners& c) const {
    const double x = x_ + i * steps_per_cell_, y = y_ + j * steps_per_cell_;
    const std::uint64_t key =
        random_key(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y), edge_purpose);
    PixelValue sum = PixelValue::zero(static_cast<int>(c[0]->radiance.size()));
    int votes = 0;
    for (int s = 0; s < edge_points_.count(); ++s) {
      const Eigen::Array4f u = edge_points_.point(s, key);
      const std::uint64_t seen =
          eye_.fingerprint(x + u[0] * steps_per_cell_, y + u[1] * steps_per_cell_);
      const auto alike = [&](const Sight* sight) { return sight->fingerprint == seen; };
      const auto count = std::count_if(c.begin(), c.end(), alike);
      if (count == 0) continue;  // a third thing, which no corner shows
      ++votes;
      for (const Sight* sight : c) {
        if (alike(sight)) sum.add(*sight, 1.0f / static_cast<float>(count));
      }
    }
    return votes > 0 ? scaled(sum, 1.0f / static_cast<float>(votes)) : mean(c);
  }

  static bool look_alike(const Corners& c) {
    return std::all_of(c.begin(), c.end(),
                       [&](const Sight* sight) { return sight->fingerprint == c[0]->fingerprint; });
  }

  bool must_split(int i, int j, int size, const Corners& c) const {
    if (size < 2) return false;
    if (!look_alike(c)) return true;
    if (!(spread(c) <= options_.contrast)) return true;
    // Something thin may pass between the corners; to see what is in the middle costs no shadow
    // rays.
    const int half = size * steps_per_cell_ / 2;
    return eye_.fingerprint(x_ + i * steps_per_cell_ + half, y_ + j * steps_per_cell_ + half) !=
           c[0]->fingerprint;
  }

  const Eye& eye_;
  const RenderOptions& options_;
  const SobolPoints edge_points_{16};
  int cells_, steps_per_cell_;
  int x_ = 0, y_ = 0;
  std::vector<Sight> sights_;  // of this pixel's lattice points
  std::vector<char> known_;
};

// A row of pixel corners.
using CornerRow = std::vector<Sight>;

void look_at_corners(const Eye& eye, int first_row, std::span<CornerRow> rows) {
  constexpr int grain = 32;
  const int columns = static_cast<int>(rows.front().size());
  parallel_for(static_cast<int>(rows.size()) * columns, grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int row = i / columns, column = i % columns;
      rows[row][column] = eye.look(column * lattice_steps, (first_row + row) * lattice_steps);
    }
  });
}

void average_pixels(const Eye& eye, const RenderOptions& options, int first_row,
                    std::span<const CornerRow> corners, Image& image, LayerFilm& layers) {
  constexpr int grain = 32;
  const int rows = static_cast<int>(corners.size()) - 1;
  parallel_for(rows * image.width, grain, [&](int begin, int end) {
    PixelMean pixel_mean(eye, options);
    for (int i = begin; i < end; ++i) {
      const int row = i / image.width, x = i % image.width, y = first_row + row;
      const CornerRow& top = corners[row];
      const CornerRow& bottom = corners[row + 1];
      const PixelValue value = pixel_mean(x, y, {&top[x], &top[x + 1], &bottom[x], &bottom[x + 1]});
      const Eigen::Index pixel = Eigen::Index{y} * image.width + x;
      image.radiance.row(pixel) = value.radiance.transpose();
      layers.set_sampled(pixel, value.layers);
    }
  });
}

// Calls body(x, y) for each pixel of rows `first` to `end`, in slices that keep progress and
// interruption on this thread.
template <class Body>
void for_each_pixel(int width, int first, int end, const Progress& progress, double part,
                    Body&& body) {
  constexpr int slice = 512, grain = 8;
  const int count = (end - first) * width;
  for (int begin = 0; begin < count; begin += slice) {
    parallel_for(std::min(slice, count - begin), grain, [&](int from, int to) {
      for (int i = begin + from; i < begin + to; ++i) body(i % width, first + i / width);
    });
    report(progress, "render", part);
  }
}

// Many looks for every pixel of some rows; first ones also of the rows beside them.
void sample_pixels(const PixelSamples& samples, int first_row, int rows, const Progress& progress,
                   Counters& counters, Image& image, LayerFilm& layers) {
  const int top = std::max(0, first_row - 1), bottom = std::min(image.height, first_row + rows + 1);
  const double part = static_cast<double>(first_row) / image.height;
  std::vector<PixelTally> tallies(static_cast<std::size_t>(bottom - top) * image.width);
  std::vector<char> good(tallies.size());
  const auto slot = [&](int x, int y) {
    return static_cast<std::size_t>(y - top) * image.width + x;
  };
  for_each_pixel(image.width, top, bottom, progress, part, [&](int x, int y) {
    PixelTally& tally = tallies[slot(x, y)] = samples.first_looks(x, y);
    good[slot(x, y)] = tally.is_good(samples.options().noise);
  });
  const auto is_beside_noise = [&](int x, int y) {
    for (int j = std::max(top, y - 1); j < std::min(bottom, y + 2); ++j) {
      for (int i = std::max(0, x - 1); i < std::min(image.width, x + 2); ++i) {
        if (!good[slot(i, j)]) return true;
      }
    }
    return false;
  };
  for_each_pixel(image.width, first_row, first_row + rows, progress, part, [&](int x, int y) {
    PixelTally& tally = tallies[slot(x, y)];
    samples.look_on(x, y, is_beside_noise(x, y), tally);
    const float share = 1.0f / static_cast<float>(tally.count);
    const Eigen::Index pixel = Eigen::Index{y} * image.width + x;
    image.radiance.row(pixel) = share * tally.sum.radiance.transpose();
    layers.set_sampled(pixel, share * tally.sum.layers);
    counters.eye_rays.fetch_add(tally.count, std::memory_order_relaxed);
    counters.depth_cut.fetch_add(tally.sum.depth_cut, std::memory_order_relaxed);
  });
}

// Rough surfaces and lenses show nothing sharp that subdivision could find the edges of.
SampleOptions sampling_for(const Scene& scene, const CameraRays& rays,
                           const RenderOptions& options) {
  SampleOptions sampling = options.sampling;
  const auto is_rough = [](const Material& m) { return m.gloss_roughness() > 0.0f; };
  const bool needed = rays.has_lens() || std::ranges::any_of(scene.materials, is_rough);
  if (sampling.most == 0 && needed) sampling.most = SampleOptions::most_by_default;
  return sampling;
}

}  // namespace

Image render(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
             const RadiositySolution& solution, const Camera& camera, const RenderOptions& options,
             RenderReport* render_report) {
  const auto start = std::chrono::steady_clock::now();
  check(options);
  const CameraRays rays(camera);
  const RayTree tree(scene, caster, direct_light, solution, options);
  Counters counters;
  const Eye eye(rays, tree, counters);
  Image image{.width = camera.width, .height = camera.height};
  image.radiance.resize(std::int64_t{camera.width} * camera.height, scene.bands.count());
  LayerFilm layers(options.layers, image);

  // Strips keep memory small and let the caller stop the work soon; they share a row of corners.
  constexpr int pixels_per_strip = 8192;
  const SampleOptions sampling = sampling_for(scene, rays, options);
  std::optional<PixelSamples> samples;
  if (sampling.most > 0) samples.emplace(rays, tree, sampling);
  constexpr int sampled_rows = 16;
  const int strip_rows = samples ? sampled_rows : std::max(1, pixels_per_strip / camera.width);
  std::vector<CornerRow> corners(strip_rows + 1, CornerRow(camera.width + 1));
  report(options.progress, "render", 0.0);
  if (!samples) look_at_corners(eye, 0, {corners.data(), 1});
  for (int y = 0; y < camera.height; y += strip_rows) {
    const int rows = std::min(strip_rows, camera.height - y);
    if (samples) {
      sample_pixels(*samples, y, rows, options.progress, counters, image, layers);
    } else {
      look_at_corners(eye, y + 1, {corners.data() + 1, static_cast<std::size_t>(rows)});
      average_pixels(eye, options, y, {corners.data(), static_cast<std::size_t>(rows) + 1}, image,
                     layers);
      std::swap(corners.front(), corners[rows]);
    }
    parallel_for(rows, 1, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        layers.finish_row(y + i, scene.bands, camera, rays, caster);
      }
    });
    report(options.progress, "render", static_cast<double>(y + rows) / camera.height);
  }
  if (render_report) {
    *render_report = {
        .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
        .eye_rays = counters.eye_rays,
        .depth_cut = counters.depth_cut};
  }
  return image;
}

}  // namespace lightwell
