#include "raytrace/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>

#include "radiosity/journal/journal_phase.h"
#include "raytrace/cameras/camera_ray.h"
#include "raytrace/eye.h"
#include "raytrace/layer_film.h"
#include "raytrace/picture_fingerprint.h"
#include "raytrace/picture_records.h"
#include "raytrace/pixel_samples.h"
#include "raytrace/shading/shade.h"
#include "raytrace/tile_renderer.h"
#include "scene/errors.h"
#include "scene/facet_normals.h"
#include "scene/facet_relief.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

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

// Returns the values of full rows of the picture, which are contiguous in memory.
std::span<float> rows_of(BandArray& values, int width, int first_row, int rows) {
  const auto row = static_cast<std::size_t>(width * values.cols());
  return {values.data() + first_row * row, rows * row};
}

// Calls render_tile(tile, first row, rows) for all tiles of the picture, with progress, and
// options.rows_done from the top down. Several processes do tiles in any order, so their rows are
// done at the end. Returns the number of tiles.
int for_each_tile(const JournalPhase& phase, int tile_rows, const Image& image,
                  const RenderOptions& options,
                  const std::function<void(int, int, int)>& render_tile) {
  const int height = image.height, count = (height + tile_rows - 1) / tile_rows;
  const bool is_alone = phase.processes() == 1;
  const auto first_row = [&](int tile) { return std::min(tile * tile_rows, height); };
  const auto rows = [&](int tile) { return first_row(tile + 1) - first_row(tile); };
  const auto done = [&](int tile) {
    if (options.rows_done) options.rows_done(image, first_row(tile), rows(tile));
  };
  const auto report_progress = [&](int tile) {
    report(options.run.progress, "render", static_cast<double>(first_row(tile)) / height);
  };
  phase.for_each_in_turn(count, report_progress, [&](int tile) {
    render_tile(tile, first_row(tile), rows(tile));
    if (is_alone) done(tile);
  });
  for (int tile = 0; tile < count && !is_alone; ++tile) done(tile);
  report_progress(count);
  return count;
}

}  // namespace

Image render(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
             const RadiositySolution& solution, const Camera& camera, const RenderOptions& options,
             RenderReport* render_report) {
  const auto start = std::chrono::steady_clock::now();
  validate(options);
  const CameraRays rays(camera);
  RayTree tree(scene, caster, direct_light, solution, options);
  tree.set_records(options.records ? options.records
                                   : find_records({scene, caster, direct_light}, solution, camera,
                                                  rays, options));
  RayCounters counters;
  const Eye eye(rays, tree, counters);
  Image image{.width = camera.width, .height = camera.height};
  image.radiance.resize(std::int64_t{camera.width} * camera.height, scene.bands.count());
  LayerFilm layers(options.layers, image);

  std::optional<Exposure> exposure = exposure_of(scene, caster.mesh(), camera);
  const JournalPhase phase(options.run, "picture", [&](Fingerprint& print) {
    add_picture_inputs(print, caster, solution, camera, options);
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
  // With several processes only the calling thread reports.
  RenderOptions silent = options;
  if (phase.processes() > 1) silent.run.progress = {};
  TileRenderer tiles(eye, samples, sampled, silent, counters, image, layers);
  int recalled = 0;
  const auto render_tile = [&](int tile, int y, int rows) {
    auto values = std::tuple(rows_of(image.radiance, camera.width, y, rows),
                             rows_of(image.layers.values, camera.width, y, rows));
    RayCounts of_tile;
    if (phase.recall(tile, values, of_tile)) {
      counters.add(of_tile);
      ++recalled;
      return;
    }
    const RayCounts before = counters.since({});
    tiles.render(y, rows);
    parallel_for(rows, 1, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        layers.finish_row(y + i, scene.bands, rays, caster, tree.visible_lamps());
      }
    });
    phase.keep(tile, values, counters.since(before));
  };
  const int count = for_each_tile(phase, tiles.tile_rows(), image, options, render_tile);
  if (render_report) {
    *render_report = {
        .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
        .eye_rays = counters.eye_rays,
        .depth_cut = counters.depth_cut,
        .cut_share = static_cast<double>(counters.cut_steps) * RayCounts::weight_step /
                     static_cast<double>(std::max<std::int64_t>(1, counters.eye_rays)),
        .tiles = count,
        .recalled_tiles = recalled};
  }
  return image;
}

}  // namespace lightwell
