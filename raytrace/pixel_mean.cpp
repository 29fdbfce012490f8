#include "raytrace/pixel_mean.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "scene/random_purpose.h"

namespace lightwell {
namespace {

PixelValue scaled(const PixelValue& value, float share) {
  return {.radiance = share * value.radiance, .layers = share * value.layers};
}

// Contrast of a cell: the largest difference between corners in any band, over the bands' mean of
// the largest value.
float spread(const PixelMean::Corners& c) {
  float widest = 0.0f, sum = 0.0f;
  for (Eigen::Index k = 0; k < c[0]->radiance.size(); ++k) {
    const auto [low, high] =
        std::minmax({c[0]->radiance[k], c[1]->radiance[k], c[2]->radiance[k], c[3]->radiance[k]});
    widest = std::max(widest, high - low);
    sum += high;
  }
  return widest > 0.0f ? widest * static_cast<float>(c[0]->radiance.size()) / sum : 0.0f;
}

// About the noise of a corner, relative to the bands' mean of the largest value.
float noise_of_corner(const PixelMean::Corners& c) {
  float variance = 0.0f;
  Spectrum high = c[0]->radiance;
  for (const RaySample* sample : c) {
    variance += sample->variance / static_cast<float>(c.size());
    high = high.max(sample->radiance);
  }
  return variance > 0.0f ? std::sqrt(variance) / high.mean() : 0.0f;
}

PixelValue mean(const PixelMean::Corners& c) {
  PixelValue sum{.radiance = c[0]->radiance, .layers = c[0]->layers};
  for (int i = 1; i < 4; ++i) sum.add(*c[i], 1.0f);
  return scaled(sum, 0.25f);
}

bool are_alike(const PixelMean::Corners& c) {
  return std::all_of(c.begin(), c.end(), [&](const RaySample* sample) {
    return sample->fingerprint == c[0]->fingerprint;
  });
}

// Surfaces that rays within a cell see, but none of its corners.
struct BetweenCorners {
  std::uint64_t fingerprint = 0;
  double x = 0.0, y = 0.0;  // of the first of the rays
  int votes = 0;
};

void count_vote(std::uint64_t fingerprint, double x, double y,
                std::vector<BetweenCorners>& between) {
  const auto known = std::ranges::find(between, fingerprint, &BetweenCorners::fingerprint);
  if (known != between.end()) {
    ++known->votes;
  } else {
    between.push_back({.fingerprint = fingerprint, .x = x, .y = y, .votes = 1});
  }
}

}  // namespace

PixelMean::PixelMean(const Eye& eye, const RenderOptions& options)
    : eye_(eye),
      options_(options),
      cells_(1 << options.max_subdivision),
      steps_per_cell_(lattice_steps >> options.max_subdivision),
      lattice_samples_((cells_ + 1) * (cells_ + 1)),
      known_(lattice_samples_.size()) {}

PixelValue PixelMean::operator()(int x, int y, const Corners& corners) {
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

void PixelMean::keep(int i, int j, RaySample sample) {
  lattice_samples_[slot(i, j)] = std::move(sample);
  known_[slot(i, j)] = 1;
}

const RaySample* PixelMean::sample(int i, int j) {
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

PixelValue PixelMean::cell_mean(int i, int j, int size) {
  const Corners corners = {sample(i, j), sample(i + size, j), sample(i, j + size),
                           sample(i + size, j + size)};
  if (must_split(i, j, size, corners)) return split(i, j, size);
  return size == 1 && !are_alike(corners) ? edge_mean(i, j, corners) : mean(corners);
}

PixelValue PixelMean::split(int i, int j, int size) {
  const int half = size / 2;
  PixelValue sum = cell_mean(i, j, half);
  sum.add(cell_mean(i + half, j, half), 1.0f);
  sum.add(cell_mean(i, j + half, half), 1.0f);
  sum.add(cell_mean(i + half, j + half, half), 1.0f);
  return scaled(sum, 0.25f);
}

// Mean over a cell of the finest level with an edge in it. The weight of a corner is the share of
// the cell that looks like the corner. The shares come from rays without shadow rays, so edges
// are resolved many times finer than samples, as the edge of a lamp against a wall a hundred
// times darker needs. Of the surfaces that no corner shows, such as a thin bar, the one that most
// of the rays see has a sample of its own; a single ray is not worth one.
PixelValue PixelMean::edge_mean(int i, int j, const Corners& c) const {
  const double x = x_ + i * steps_per_cell_, y = y_ + j * steps_per_cell_;
  const std::uint64_t key = random_key(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y),
                                       RandomPurpose::pixel_edges);
  PixelValue sum = PixelValue::zero(static_cast<int>(c[0]->radiance.size()));
  std::vector<BetweenCorners> between;
  int votes = 0;
  for (int s = 0; s < edge_points_.count(); ++s) {
    const Eigen::Array4f u = edge_points_.point(s, key);
    const double at_x = x + u[0] * steps_per_cell_, at_y = y + u[1] * steps_per_cell_;
    const std::uint64_t seen = eye_.fingerprint(at_x, at_y, panel_);
    const auto alike = [&](const RaySample* sample) { return sample->fingerprint == seen; };
    const auto count = std::count_if(c.begin(), c.end(), alike);
    if (count == 0) {
      count_vote(seen, at_x, at_y, between);
      continue;
    }
    ++votes;
    for (const RaySample* sample : c) {
      if (alike(sample)) sum.add(*sample, 1.0f / static_cast<float>(count));
    }
  }
  constexpr int fewest_votes = 2;  // a 128th of a pixel by the default subdivision
  const auto most = std::ranges::max_element(between, {}, &BetweenCorners::votes);
  if (most != between.end() && most->votes >= fewest_votes) {
    sum.add(eye_.trace(most->x, most->y, panel_, 1.0f / static_cast<float>(cells_)),
            static_cast<float>(most->votes));
    votes += most->votes;
  }
  return votes > 0 ? scaled(sum, 1.0f / static_cast<float>(votes)) : mean(c);
}

bool PixelMean::must_split(int i, int j, int size, const Corners& c) const {
  if (size < 2) return false;
  if (!are_alike(c)) return true;
  // The range of four samples of a normal distribution is less than 3.6 standard deviations in 95
  // of 100 cases (Tippett 1925), so a greater one is an edge, not noise.
  constexpr float range = 3.6f;
  const float noise = noise_of_corner(c);
  if (!(spread(c) <= options_.contrast + range * noise)) return true;
  // The mean of four corners has half the noise of one, and counts by its side in that of the
  // pixel, where cells of that side are as many as the pixel's area over theirs.
  const float of_pixel = 0.5f * noise * static_cast<float>(size) / static_cast<float>(cells_);
  if (of_pixel > options_.sampling.noise) return true;
  // Something thin may pass between the corners. The fingerprint at the middle costs no shadow
  // rays.
  const int half = size * steps_per_cell_ / 2;
  return eye_.fingerprint(x_ + i * steps_per_cell_ + half, y_ + j * steps_per_cell_ + half,
                          panel_) != c[0]->fingerprint;
}

}  // namespace lightwell
