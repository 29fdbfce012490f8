#include "raytrace/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "radiosity/journal/journal_phase.h"
#include "raytrace/cameras/camera_ray.h"
#include "raytrace/gloss_mask.h"
#include "raytrace/layer_film.h"
#include "raytrace/pixel_samples.h"
#include "raytrace/sampled_rows.h"
#include "raytrace/shading/shade.h"
#include "scene/errors.h"
#include "scene/facet_normals.h"
#include "scene/facet_relief.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Samples are keyed by their point on a lattice of this many steps per pixel, whatever the
// subdivision, so a finer picture keeps the samples of a coarser one.
constexpr int lattice_steps = 1 << deepest_subdivision;

struct Counters {
  std::atomic<std::int64_t> eye_rays{0}, depth_cut{0};
  // Weight of cut branches in integer steps, whose sum does not depend on the order.
  static constexpr double weight_step = 0x1p-30;
  std::atomic<std::int64_t> cut_steps{0};

  void add_cut(double weight) {
    if (weight > 0.0) cut_steps += std::llround(weight / weight_step);
  }
};

// Tracer of points of the picture, given in lattice steps from the top left corner, as points of a
// panel (see PicturePlane). Where the picture shows nothing, points are black.
class Eye {
 public:
  Eye(const CameraRays& rays, const RayTree& tree, Counters& counters)
      : rays_(rays), tree_(tree), counters_(counters) {}

  RaySample trace(int x, int y, int panel, float effort = 1.0f) const {
    const auto ray = ray_at(x, y, panel);
    if (!ray) return tree_.nothing();
    const auto key = random_key(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y));
    RaySample sample = tree_.trace(*ray, key, effort, rays_.cone(step * x, step * y, panel));
    counters_.eye_rays.fetch_add(1, std::memory_order_relaxed);
    counters_.depth_cut.fetch_add(sample.depth_cut, std::memory_order_relaxed);
    counters_.add_cut(double{sample.cut_weight});
    return sample;
  }
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
  Counters& counters_;
};

// Radiance and sampled layers, averaged together.
struct PixelValue {
  Spectrum radiance{};
  SampledLayers layers = SampledLayers::Zero();

  static PixelValue zero(int bands) { return {.radiance = Spectrum::Zero(bands)}; }
  template <class Seen>  // RaySample or PixelValue
  void add(const Seen& seen, float share) {
    radiance += share * seen.radiance;
    layers += share * seen.layers;
  }
};

// Mean radiance over a pixel's square by adaptive subdivision (Whitted 1980): the mean of the four
// corners if they agree, else of the four quarters.
class PixelMean {
 public:
  PixelMean(const Eye& eye, const RenderOptions& options)
      : eye_(eye),
        options_(options),
        cells_(1 << options.max_subdivision),
        steps_per_cell_(lattice_steps >> options.max_subdivision),
        lattice_samples_((cells_ + 1) * (cells_ + 1)),
        known_(lattice_samples_.size()) {}

  // `corners`: top left, top right, bottom left, bottom right.
  PixelValue operator()(int x, int y, const std::array<const RaySample*, 4>& corners) {
    met_gloss_ = false;
    panel_ = eye_.panel_of_pixel(x, y);
    x_ = x * lattice_steps;
    y_ = y * lattice_steps;
    if (!must_split(0, 0, cells_, corners) && (cells_ > 1 || are_alike(corners))) {
      return mean(corners);
    }
    std::fill(known_.begin(), known_.end(), 0);
    for (int c = 0; c < 4; ++c) keep(cells_ * (c & 1), cells_ * (c >> 1), *corners[c]);
    return cell_mean(0, 0, cells_);
  }

  /// Whether a sample of the last pixel, beside its corners, met a rough surface.
  bool met_gloss() const { return met_gloss_; }

 private:
  using Corners = std::array<const RaySample*, 4>;

  int slot(int i, int j) const { return j * (cells_ + 1) + i; }

  void keep(int i, int j, RaySample sample) {
    lattice_samples_[slot(i, j)] = std::move(sample);
    known_[slot(i, j)] = 1;
  }

  const RaySample* sample(int i, int j) {
    if (!known_[slot(i, j)]) {
      // Finer levels average more samples, so each sample gets less effort.
      int step = cells_;
      while ((i | j) % step != 0) step /= 2;
      const float effort = static_cast<float>(step) / static_cast<float>(cells_);
      RaySample sample =
          eye_.trace(x_ + i * steps_per_cell_, y_ + j * steps_per_cell_, panel_, effort);
      met_gloss_ = met_gloss_ || sample.sees_gloss;
      keep(i, j, std::move(sample));
    }
    return &lattice_samples_[slot(i, j)];
  }

  PixelValue cell_mean(int i, int j, int size) {
    const Corners corners = {sample(i, j), sample(i + size, j), sample(i, j + size),
                             sample(i + size, j + size)};
    if (must_split(i, j, size, corners)) return split(i, j, size);
    return size == 1 && !are_alike(corners) ? edge_mean(i, j, corners) : mean(corners);
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

  // Contrast of a cell: the largest difference between corners in any band, over the bands' mean of
  // the largest value.
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

  // Mean over a cell of the finest level with an edge in it. The weight of a corner is the share of
  // the cell that looks like the corner. The shares come from rays without shadow rays, so edges
  // are resolved many times finer than samples, as the edge of a lamp against a wall a hundred
  // times darker needs.
  PixelValue edge_mean(int i, int j, const Corners& c) const {
    const double x = x_ + i * steps_per_cell_, y = y_ + j * steps_per_cell_;
    const std::uint64_t key = random_key(static_cast<std::uint64_t>(x),
                                         static_cast<std::uint64_t>(y), RandomPurpose::pixel_edges);
    PixelValue sum = PixelValue::zero(static_cast<int>(c[0]->radiance.size()));
    int votes = 0;
    for (int s = 0; s < edge_points_.count(); ++s) {
      const Eigen::Array4f u = edge_points_.point(s, key);
      const std::uint64_t seen =
          eye_.fingerprint(x + u[0] * steps_per_cell_, y + u[1] * steps_per_cell_, panel_);
      const auto alike = [&](const RaySample* sample) { return sample->fingerprint == seen; };
      const auto count = std::count_if(c.begin(), c.end(), alike);
      if (count == 0) continue;  // a surface that no corner shows
      ++votes;
      for (const RaySample* sample : c) {
        if (alike(sample)) sum.add(*sample, 1.0f / static_cast<float>(count));
      }
    }
    return votes > 0 ? scaled(sum, 1.0f / static_cast<float>(votes)) : mean(c);
  }

  static bool are_alike(const Corners& c) {
    return std::all_of(c.begin(), c.end(), [&](const RaySample* sample) {
      return sample->fingerprint == c[0]->fingerprint;
    });
  }

  bool must_split(int i, int j, int size, const Corners& c) const {
    if (size < 2) return false;
    if (!are_alike(c)) return true;
    if (!(spread(c) <= options_.contrast)) return true;
    // Something thin may pass between the corners. The fingerprint at the middle costs no shadow
    // rays.
    const int half = size * steps_per_cell_ / 2;
    return eye_.fingerprint(x_ + i * steps_per_cell_ + half, y_ + j * steps_per_cell_ + half,
                            panel_) != c[0]->fingerprint;
  }

  const Eye& eye_;
  const RenderOptions& options_;
  const SobolPoints edge_points_{16};
  int cells_, steps_per_cell_;
  int x_ = 0, y_ = 0, panel_ = 0;
  bool met_gloss_ = false;
  std::vector<RaySample> lattice_samples_;  // samples at this pixel's lattice points
  std::vector<char> known_;
};

// A row of pixel corners, each as a point of the panel to its right and below.
using CornerRow = std::vector<RaySample>;

// Corners of the pixel of column x between two rows of corners: those of the rows, or, where a
// panel ends, ones traced anew in the pixel's own panel.
class PixelCorners {
 public:
  PixelCorners(const Eye& eye, int x, int y, const CornerRow& top, const CornerRow& bottom)
      : corners_{&top[x], &top[x + 1], &bottom[x], &bottom[x + 1]} {
    const int panel = eye.panel_of_pixel(x, y);
    for (int c = 1; c < 4; ++c) {
      const int right = x + (c & 1), below = y + (c >> 1);
      if (eye.panel_of_pixel(right, below) == panel) continue;
      own_[c] = eye.trace(right * lattice_steps, below * lattice_steps, panel);
      corners_[c] = &own_[c];
    }
  }
  const std::array<const RaySample*, 4>& operator*() const { return corners_; }

 private:
  std::array<RaySample, 4> own_{};
  std::array<const RaySample*, 4> corners_;
};

// Pixels that many samples are taken of, beside subdivision.
struct SampledPixels {
  const PixelSamples& samples;
  const GlossMask& mask;
};

void trace_corners(const Eye& eye, int first_row, std::span<CornerRow> rows,
                   const GlossMask* mask = nullptr) {
  constexpr int grain = 32;
  const int columns = static_cast<int>(rows.front().size());
  parallel_for(static_cast<int>(rows.size()) * columns, grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int row = i / columns, column = i % columns;
      if (mask && !mask->is_corner_of_matt_pixel(column, first_row + row)) continue;
      const int y = first_row + row;
      rows[row][column] =
          eye.trace(column * lattice_steps, y * lattice_steps, eye.panel_of_pixel(column, y));
    }
  });
}

void count_samples(const PixelTally& tally, Counters& counters) {
  counters.eye_rays += tally.count;
  counters.depth_cut += tally.sum.depth_cut;
  counters.add_cut(double{tally.sum.cut_weight});
}

// Fills pixels by subdivision. Those of `sampled` are left out, except where subdivision finds
// gloss that no corner shows.
void average_pixels(const Eye& eye, const RenderOptions& options, int first_row,
                    std::span<const CornerRow> corners, const SampledPixels* sampled,
                    Counters& counters, Image& image, LayerFilm& layers) {
  constexpr int grain = 32;
  const int rows = static_cast<int>(corners.size()) - 1;
  parallel_for(rows * image.width, grain, [&](int begin, int end) {
    PixelMean pixel_mean(eye, options);
    for (int i = begin; i < end; ++i) {
      const int row = i / image.width, x = i % image.width, y = first_row + row;
      if (sampled && sampled->mask.has_gloss(x, y)) continue;
      const PixelCorners pixel_corners(eye, x, y, corners[row], corners[row + 1]);
      const PixelValue value = pixel_mean(x, y, *pixel_corners);
      if (sampled && pixel_mean.met_gloss()) {
        PixelTally tally = sampled->samples.first_samples(x, y);
        sampled->samples.take_more(x, y, true, tally);
        set_pixel(sampled->samples.mean(tally), x, y, image, layers);
        count_samples(tally, counters);
        continue;
      }
      const Eigen::Index pixel = Eigen::Index{y} * image.width + x;
      image.radiance.row(pixel) = value.radiance.transpose();
      layers.set_sampled(pixel, value.layers);
    }
  });
}

// Returns the interval of the shutter; empty if nothing moves while it is open.
std::optional<Exposure> exposure_of(const Scene& scene, const PatchMesh& mesh,
                                    const Camera& camera) {
  const auto moves = [](const auto& thing) { return thing.motion >= 0; };
  if (!camera.is_open_for_a_while()) return std::nullopt;
  if (!moves(camera) && std::ranges::none_of(scene.surfaces, moves)) return std::nullopt;
  const double instant = scene.motions.front().rest_time, middle = camera.shutter_middle();
  constexpr double rounding = 1e-9;
  if (!(std::abs(middle - instant) <= rounding * std::max(1.0, std::abs(instant)))) {
    throw InputError(
        fmt::format("camera '{}': the middle of its shutter is {:g} s, but light is solved for "
                    "{:g} s; move the "
                    "shutter there, or place the scene at rest at another time and solve it again",
                    camera.name, middle, instant));
  }
  Exposure exposure{.caster = ElementCaster(mesh, scene),
                    .open = camera.shutter_open,
                    .close = camera.shutter_close};
  if (moves(camera)) exposure.camera = scene.motions[static_cast<std::size_t>(camera.motion)];
  return exposure;
}

// Which pixels get many samples.
enum class Sampled { none, with_gloss, all };

// Returns which pixels get many samples: by default those that show rough surfaces, and all with
// lenses and motion, which have no sharp edges for subdivision to find.
Sampled sampled_pixels(const Scene& scene, const CameraRays& rays, bool is_exposure,
                       const RenderOptions& options) {
  if (options.sampling.most > 0 || is_exposure || rays.has_lens()) return Sampled::all;
  const auto is_rough = [](const Material& m) {
    return m.gloss_roughness() > 0.0f || (m.pattern && m.pattern->roughness);
  };
  return std::ranges::any_of(scene.materials, is_rough) ? Sampled::with_gloss : Sampled::none;
}

void add_motion(Fingerprint& print, const RigidMotion& motion) {
  print.add(motion.pivot);
  print.add(motion.axis);
  print.add(motion.rest_time);
  for (const MotionKey& key : motion.keys) {
    print.add(key.time);
    print.add(key.degrees);
    print.add(key.translation);
  }
}

// Adds motions and the shutter's interval.
void add_exposure(Fingerprint& print, const Scene& scene, const Exposure& exposure) {
  print.add(exposure.open);
  print.add(exposure.close);
  for (const Surface& surface : scene.surfaces) print.add(surface.motion);
  for (const RigidMotion& motion : scene.motions) add_motion(print, motion);
  if (exposure.camera) add_motion(print, *exposure.camera);
}

// Adds all inputs of a picture except the scene, which identifies the journal.
void add_inputs(Fingerprint& print, const ElementCaster& caster, const RadiositySolution& solution,
                const Camera& camera, const RenderOptions& options) {
  print.add(caster.mesh());
  print.add(solution.direct_irradiance);
  print.add(solution.indirect_irradiance);
  // add_exposure() has the camera's motion and shutter.
  const auto& [name, position, direction, up, fov_degrees, width, height, lens_radius,
               focus_distance, blades, shutter_open, shutter_close, motion, projection, view_width,
               near_distance, far_distance, shift, window, distortion, circle_degrees,
               eye_separation] = camera;
  // Left out are `caustics`, `slant`, `found_virtual_lights` and `visible_lamps`, which follow from
  // the rest; `layers`, whose names render() adds; `run` and `rows_done`, which change no bit.
  const auto& [pass, max_depth, min_contribution, shadows, gather_rays, virtual_lights,
               found_virtual_lights, photons, caustics, slant, visible_lamps, glossy_rays, sampling,
               max_subdivision, contrast, layers, run, rows_done] = options;
  const auto& [min_shadow_rays, max_shadow_rays, sky_rays, cluster_share, many_lights] = shadows;
  const auto& [most_samples, least_samples, noise] = sampling;
  for (const Eigen::Vector3d* v : {&position, &direction, &up}) print.add(*v);
  print.add(fov_degrees);
  print.add(width);
  print.add(height);
  print.add(pass);
  print.add(max_depth);
  print.add(min_contribution);
  print.add(min_shadow_rays);
  print.add(max_shadow_rays);
  print.add(sky_rays);
  print.add(cluster_share);
  print.add(many_lights);
  print.add(max_subdivision);
  print.add(contrast);
  print.add(solution.caustic_irradiance);
  print.add(lens_radius);
  print.add(focus_distance);
  print.add(blades);
  print.add(projection);
  print.add(view_width);
  print.add(near_distance);
  print.add(far_distance);
  print.add(shift.x());
  print.add(shift.y());
  for (const double edge : {window.left, window.top, window.right, window.bottom}) print.add(edge);
  const auto& [k1, k2, k3, p1, p2] = distortion;
  for (const double coefficient : {k1, k2, k3, p1, p2}) print.add(coefficient);
  print.add(circle_degrees);
  print.add(eye_separation);
  print.add(gather_rays);
  print.add(virtual_lights);
  print.add(glossy_rays);
  print.add(photons);
  print.add(most_samples);
  print.add(least_samples);
  print.add(noise);
}

// Returns the values of full rows of the picture, which are contiguous in memory.
std::span<float> rows_of(BandArray& values, int width, int first_row, int rows) {
  const auto row = static_cast<std::size_t>(width * values.cols());
  return {values.data() + first_row * row, rows * row};
}

// Renderer of tiles, which are strips of full rows. Strips share a row of corners; pixels that are
// `sampled` hold many samples instead.
class TileRenderer {
 public:
  TileRenderer(const Eye& eye, const PixelSamples& samples, Sampled sampled,
               const RenderOptions& options, Counters& counters, Image& image, LayerFilm& layers)
      : eye_(eye),
        samples_(samples),
        sampled_(sampled),
        options_(options),
        counters_(counters),
        image_(image),
        layers_(layers),
        corners_(tile_rows() + 1, CornerRow(image.width + 1)) {}

  /// Rows of a tile: few enough to stop soon and to lose little, enough to keep all threads busy.
  int tile_rows() const {
    // Each tile also takes, and discards, the first samples of a row on either side.
    constexpr int sampled_rows = 16;
    if (sampled_ != Sampled::none) return sampled_rows;
    constexpr int pixels_per_tile = 8192;
    return std::max(1, pixels_per_tile / image_.width);
  }
  /// Fills radiance and sampled layers of a tile.
  void render(int first_row, int rows) {
    if (sampled_ == Sampled::all) return sample(first_row, rows, nullptr);
    if (sampled_ == Sampled::none) return subdivide(first_row, rows, nullptr);
    const int above = std::max(0, first_row - 1);
    const int below = std::min(image_.height, first_row + rows + 1);
    const GlossMask mask = eye_.gloss(image_.width, above, below);
    subdivide(first_row, rows, &mask);
    sample(first_row, rows, &mask);
  }

 private:
  void sample(int first_row, int rows, const GlossMask* only) {
    const double part = static_cast<double>(first_row) / image_.height;
    const SampledRows took =
        sample_rows(samples_, first_row, rows, options_.run.progress, part, image_, layers_, only);
    counters_.eye_rays += took.samples;
    counters_.depth_cut += took.depth_cut;
    counters_.add_cut(took.cut_weight);
  }

  void subdivide(int first_row, int rows, const GlossMask* mask) {
    const auto count = static_cast<std::size_t>(rows);
    if (row_of_corners_ != first_row) trace_corners(eye_, first_row, {corners_.data(), 1}, mask);
    trace_corners(eye_, first_row + 1, {corners_.data() + 1, count}, mask);
    std::optional<SampledPixels> sampled;
    if (mask) sampled.emplace(SampledPixels{.samples = samples_, .mask = *mask});
    average_pixels(eye_, options_, first_row, {corners_.data(), count + 1},
                   sampled ? &*sampled : nullptr, counters_, image_, layers_);
    std::swap(corners_.front(), corners_[rows]);
    row_of_corners_ = first_row + rows;
  }

  const Eye& eye_;
  const PixelSamples& samples_;
  Sampled sampled_;
  const RenderOptions& options_;
  Counters& counters_;
  Image& image_;
  LayerFilm& layers_;
  std::vector<CornerRow> corners_;
  int row_of_corners_ = -1;  // row of corners_.front(); -1: none yet
};

}  // namespace

Image render(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
             const RadiositySolution& solution, const Camera& camera, const RenderOptions& options,
             RenderReport* render_report) {
  const auto start = std::chrono::steady_clock::now();
  validate(options);
  const CameraRays rays(camera);
  const RayTree tree(scene, caster, direct_light, solution, options);
  Counters counters;
  const Eye eye(rays, tree, counters);
  Image image{.width = camera.width, .height = camera.height};
  image.radiance.resize(std::int64_t{camera.width} * camera.height, scene.bands.count());
  LayerFilm layers(options.layers, image);

  std::optional<Exposure> exposure = exposure_of(scene, caster.mesh(), camera);
  const JournalPhase phase(options.run.journal, "picture", [&](Fingerprint& print) {
    add_inputs(print, caster, solution, camera, options);
    if (exposure) add_exposure(print, scene, *exposure);
    if (const FacetNormals normals(scene); !normals.is_empty()) print.add(normals.hash());
    if (const FacetRelief relief(scene); !relief.is_empty()) print.add(relief.hash());
    for (const std::string& name : image.layers.names) print.add(name);
  });
  const Sampled sampled = sampled_pixels(scene, rays, exposure.has_value(), options);
  SampleOptions sampling = options.sampling;
  if (sampling.most == 0) sampling.most = SampleOptions::most_by_default;
  // Beside subdivided pixels, which are means over their squares, the window would count the light
  // of some points twice and that of others not at all.
  const PixelFilter filter = sampled == Sampled::all ? PixelFilter::window : PixelFilter::square;
  const PixelSamples samples(rays, tree, sampling, filter, std::move(exposure));
  TileRenderer tiles(eye, samples, sampled, options, counters, image, layers);
  report(options.run.progress, "render", 0.0);
  int tile = 0, recalled = 0;
  for (int y = 0; y < camera.height; y += tiles.tile_rows(), ++tile) {
    const int rows = std::min(tiles.tile_rows(), camera.height - y);
    auto values = std::tuple(rows_of(image.radiance, camera.width, y, rows),
                             rows_of(image.layers.values, camera.width, y, rows));
    if (phase.recall(tile, values)) {
      ++recalled;
    } else {
      tiles.render(y, rows);
      parallel_for(rows, 1, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
          layers.finish_row(y + i, scene.bands, rays, caster, tree.visible_lamps());
        }
      });
      phase.keep(tile, values);
    }
    if (options.rows_done) options.rows_done(image, y, rows);
    report(options.run.progress, "render", static_cast<double>(y + rows) / camera.height);
  }
  if (render_report) {
    *render_report = {
        .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
        .eye_rays = counters.eye_rays,
        .depth_cut = counters.depth_cut,
        .cut_share = static_cast<double>(counters.cut_steps) * Counters::weight_step /
                     static_cast<double>(std::max<std::int64_t>(1, counters.eye_rays)),
        .tiles = tile,
        .recalled_tiles = recalled};
  }
  return image;
}

}  // namespace lightwell
