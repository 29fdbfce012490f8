#include "cli/picture_in_time.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "radiosity/journal/pace.h"

namespace lightwell {
namespace {

RenderOptions options_of(const RenderArguments& arguments, const RenderOptions& given) {
  RenderOptions options = arguments.options();
  options.max_subdivision = std::min(options.max_subdivision, given.max_subdivision);
  options.layers = given.layers;
  options.records = given.records;
  options.run = given.run;
  return options;
}

// The same arguments, and those of quicker pictures.
std::vector<RenderArguments> from_best_to_quickest(const RenderArguments& arguments) {
  RenderArguments draft = arguments, interpolated = arguments;
  draft.quality = interpolated.quality = "draft";
  if (draft.pass == "gather") draft.pass = "auto";
  interpolated.pass = "interpolate";
  return {arguments, draft, interpolated};
}

// Records of indirect light, which the picture and its draft share; null: there are none, or they
// take more than half of the time.
std::shared_ptr<const IrradianceRecords> records_in_time(SceneRenderer& renderer,
                                                         const Camera& camera,
                                                         const RenderArguments& arguments,
                                                         const RenderOptions& given) {
  constexpr double most_of_time = 0.5;
  RenderOptions options = options_of(arguments, given);
  std::shared_ptr<const IrradianceRecords> records;
  finishes_in_time(given.run.with_share(most_of_time), [&](const RunControl& in_time) {
    options.run = in_time;
    records = renderer.records(camera, options);
  });
  return records;
}

// Samples of each pixel in the quickest picture, and the first ones of gloss in quicker pictures.
constexpr int quick_samples = 4;

// A few samples for each pixel, with light from the solution.
RenderOptions quickest(const RenderOptions& given) {
  RenderOptions options;
  options.pass = Pass::interpolate;
  options.glossy_rays = 1;
  options.sampling.most = options.sampling.least = quick_samples;
  options.photons = 0;
  options.layers = given.layers;
  options.run = given.run;
  options.run.journal = nullptr;
  return options;
}

// Copies the rows of `from`, from the top to before `end`.
void copy_rows(const Image& from, int first, int end, Image& to) {
  const auto pixel = static_cast<Eigen::Index>(first) * from.width;
  const auto pixels = static_cast<Eigen::Index>(end - first) * from.width;
  to.radiance.middleRows(pixel, pixels) = from.radiance.middleRows(pixel, pixels);
  if (from.layers.values.size() == 0) return;
  to.layers.values.middleRows(pixel, pixels) = from.layers.values.middleRows(pixel, pixels);
}

// Renders with `picture.arguments` until the time is up, or until the pace is too slow. Returns
// whether the picture was given up; otherwise its rows, or as many as there are, are in `picture`.
bool is_given_up(SceneRenderer& renderer, const Camera& camera, const RenderOptions& given,
                 bool may_give_up, PictureInTime& picture) {
  RenderOptions options = options_of(picture.arguments, given);
  if (given.run.has_limit()) options.has_records = given.records != nullptr;
  options.sampling.least = std::min(options.sampling.least, given.sampling.least);
  // Rows tell the pace; the photons of caustics come first, and all pictures share them.
  Pace pace(given.run.time_left());
  bool gave_up = false;
  RunControl run = given.run;
  run.progress = [&](std::string_view phase, double share) {
    gave_up = may_give_up && phase == "render" && pace.is_too_slow(share);
    return !gave_up && (!given.run.progress || given.run.progress(phase, share));
  };
  Image rows;
  picture.rows = 0;
  options.rows_done = [&](const Image& image, int first, int count) {
    if (rows.radiance.size() == 0) rows = image;
    copy_rows(image, first, first + count, rows);
    picture.rows = first + count;
  };
  try {
    finishes_in_time(run, [&](const RunControl& in_time) {
      options.run = in_time;
      rows = renderer.render(camera, options, &picture.rendered);
    });
  } catch (const Interrupted&) {
    if (!gave_up) throw;
  }
  picture.image = std::move(rows);
  return gave_up;
}

// Renders with the first of `candidates` that keeps the pace, and returns its rows.
PictureInTime best_in_time(SceneRenderer& renderer, const Camera& camera,
                           const std::vector<RenderArguments>& candidates,
                           const RenderOptions& given) {
  PictureInTime picture;
  RenderOptions options = given;
  const bool is_limited = given.run.has_limit();
  if (is_limited) {
    options.records = records_in_time(renderer, camera, candidates.front(), given);
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool may_give_up = is_limited && i + 1 < candidates.size();
    if (i > 0) {
      // The noise of few rays would split all pixels to the end.
      options.max_subdivision = 1;
      options.sampling.least = quick_samples;
    }
    picture.arguments = candidates[i];
    if (!is_given_up(renderer, camera, options, may_give_up, picture)) break;
  }
  return picture;
}

}  // namespace

PictureInTime render_in_time(SceneRenderer& renderer, const Camera& camera,
                             const RenderArguments& arguments, const RenderOptions& given) {
  const std::vector<RenderArguments> candidates = from_best_to_quickest(arguments);
  PictureInTime picture;
  RenderReport of_quick;
  Image quick;
  if (given.run.has_limit()) quick = renderer.render(camera, quickest(given), &of_quick);
  if (given.run.is_time_up()) {
    picture.arguments = candidates.back();
  } else {
    picture = best_in_time(renderer, camera, candidates, given);
    if (picture.rows == camera.height) return picture;
  }
  if (quick.width == 0) quick = renderer.render(camera, quickest(given), &of_quick);
  if (picture.rows > 0) copy_rows(picture.image, 0, picture.rows, quick);
  picture.image = std::move(quick);
  picture.rendered = of_quick;
  return picture;
}

}  // namespace lightwell
