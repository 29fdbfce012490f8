#include "raytrace/sampled_rows.h"

#include <algorithm>

#include "scene/parallel.h"

namespace lightwell {
namespace {

// Calls body(x, y) for each pixel of rows `first` to `end`, in slices, so that this thread reports
// progress and handles interruption between slices.
template <class Body>
void for_each_pixel(int width, int first, int end, const std::function<void()>& report_slice,
                    Body&& body) {
  constexpr int slice = 512, grain = 8;
  const int count = (end - first) * width;
  for (int begin = 0; begin < count; begin += slice) {
    parallel_for(std::min(slice, count - begin), grain, [&](int from, int to) {
      for (int i = begin + from; i < begin + to; ++i) body(i % width, first + i / width);
    });
    report_slice();
  }
}

}  // namespace

void set_pixel(const RaySample& mean, int x, int y, Image& image, LayerFilm& layers) {
  const Eigen::Index pixel = Eigen::Index{y} * image.width + x;
  image.radiance.row(pixel) = mean.radiance.transpose();
  layers.set_sampled(pixel, mean.layers);
}

// Takes the first samples of the rows from `top` to before `bottom` that have none yet.
void RowSampler::take_first(int top, int bottom, const std::function<void()>& report_slice,
                            const GlossMask* only) {
  while (!known_.empty() && top_ < top) {
    known_.pop_front();
    ++top_;
  }
  if (known_.empty()) top_ = top;
  const int first = top_ + static_cast<int>(known_.size());
  const auto width = static_cast<std::size_t>(image_.width);
  for (int y = first; y < bottom; ++y) {
    known_.push_back({.tallies = std::vector<PixelTally>(width),
                      .noisy = std::vector<std::optional<NearbyNoise>>(width)});
  }
  for_each_pixel(image_.width, first, bottom, report_slice, [&](int x, int y) {
    if (only && !only->has_gloss(x, y)) return;
    const auto at = static_cast<std::size_t>(x);
    PixelTally& tally = row(y).tallies[at] = samples_.first_samples(x, y);
    if (!tally.is_good(samples_.options().noise)) {
      row(y).noisy[at] = NearbyNoise{.brightest = tally.brightest, .mean = tally.mean_light()};
    }
  });
}

NearbyNoise RowSampler::noise_beside(int x, int y) const {
  NearbyNoise beside;
  int count = 0;
  const int bottom = top_ + static_cast<int>(known_.size());
  for (int j = std::max(top_, y - sampled_neighbours);
       j < std::min(bottom, y + sampled_neighbours + 1); ++j) {
    const FirstSamples& of_row = known_[static_cast<std::size_t>(j - top_)];
    for (int i = std::max(0, x - sampled_neighbours);
         i < std::min(image_.width, x + sampled_neighbours + 1); ++i) {
      const std::optional<NearbyNoise>& found = of_row.noisy[static_cast<std::size_t>(i)];
      if (!found) continue;
      beside.brightest = std::max(beside.brightest, found->brightest);
      beside.mean += found->mean;
      ++count;
    }
  }
  if (count > 0) beside.mean /= count;
  return beside;
}

SampledRows RowSampler::sample(int first_row, int rows, const std::function<void()>& report_slice,
                               const GlossMask* only) {
  const int top = std::max(0, first_row - sampled_neighbours),
            bottom = std::min(image_.height, first_row + rows + sampled_neighbours);
  // Filled rows have no tallies any more.
  if (first_row != next_row_) known_.clear();
  next_row_ = -1;  // until all rows are filled
  take_first(top, bottom, report_slice, only);
  for_each_pixel(image_.width, first_row, first_row + rows, report_slice, [&](int x, int y) {
    if (only && !only->has_gloss(x, y)) return;
    PixelTally& tally = row(y).tallies[static_cast<std::size_t>(x)];
    samples_.take_more(x, y, noise_beside(x, y), tally);
    set_pixel(samples_.mean(tally), x, y, image_, layers_);
  });
  SampledRows result;
  for (int y = first_row; y < first_row + rows; ++y) {
    for (const PixelTally& tally : row(y).tallies) {
      result.samples += tally.count;
      result.depth_cut += tally.sum.depth_cut;
      result.cut_weight += double{tally.sum.cut_weight};
    }
    row(y).tallies = {};
  }
  next_row_ = first_row + rows;
  return result;
}

}  // namespace lightwell
