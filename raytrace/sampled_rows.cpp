#include "raytrace/sampled_rows.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "scene/parallel.h"

namespace lightwell {
namespace {

// Calls body(x, y) for each pixel of rows `first` to `end`, in slices, so that this thread reports
// progress and handles interruption between slices.
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

}  // namespace

void set_pixel(const RaySample& mean, int x, int y, Image& image, LayerFilm& layers) {
  const Eigen::Index pixel = Eigen::Index{y} * image.width + x;
  image.radiance.row(pixel) = mean.radiance.transpose();
  layers.set_sampled(pixel, mean.layers);
}

SampledRows sample_rows(const PixelSamples& samples, int first_row, int rows,
                        const Progress& progress, double part, Image& image, LayerFilm& layers,
                        const GlossMask* only) {
  const int top = std::max(0, first_row - sampled_neighbours),
            bottom = std::min(image.height, first_row + rows + sampled_neighbours);
  std::vector<PixelTally> tallies(static_cast<std::size_t>(bottom - top) *
                                  static_cast<std::size_t>(image.width));
  std::vector<std::optional<NearbyNoise>> noisy(tallies.size());
  const auto slot = [&](int x, int y) {
    return static_cast<std::size_t>(y - top) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(x);
  };
  const auto is_sampled = [&](int x, int y) { return !only || only->has_gloss(x, y); };
  for_each_pixel(image.width, top, bottom, progress, part, [&](int x, int y) {
    if (!is_sampled(x, y)) return;
    PixelTally& tally = tallies[slot(x, y)] = samples.first_samples(x, y);
    if (!tally.is_good(samples.options().noise)) {
      noisy[slot(x, y)] = NearbyNoise{.brightest = tally.brightest, .mean = tally.mean_light()};
    }
  });
  const auto noise_beside = [&](int x, int y) {
    NearbyNoise beside;
    int count = 0;
    for (int j = std::max(top, y - sampled_neighbours);
         j < std::min(bottom, y + sampled_neighbours + 1); ++j) {
      for (int i = std::max(0, x - sampled_neighbours);
           i < std::min(image.width, x + sampled_neighbours + 1); ++i) {
        const std::optional<NearbyNoise>& found = noisy[slot(i, j)];
        if (!found) continue;
        beside.brightest = std::max(beside.brightest, found->brightest);
        beside.mean += found->mean;
        ++count;
      }
    }
    if (count > 0) beside.mean /= count;
    return beside;
  };
  for_each_pixel(image.width, first_row, first_row + rows, progress, part, [&](int x, int y) {
    if (!is_sampled(x, y)) return;
    PixelTally& tally = tallies[slot(x, y)];
    samples.take_more(x, y, noise_beside(x, y), tally);
    set_pixel(samples.mean(tally), x, y, image, layers);
  });
  SampledRows result;
  for (int y = first_row; y < first_row + rows; ++y) {
    for (int x = 0; x < image.width; ++x) {
      result.samples += tallies[slot(x, y)].count;
      result.depth_cut += tallies[slot(x, y)].sum.depth_cut;
      result.cut_weight += double{tallies[slot(x, y)].sum.cut_weight};
    }
  }
  return result;
}

}  // namespace lightwell
