#include "radiosity/near_exchange.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "radiosity/pair_exchange.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

// Rays that a pair should expect to be worth a closed form.
constexpr int fewest_rays = 12;
// As many that the count itself may decide.
constexpr int plenty_of_rays = 128;

// Of a disk of the same area, seen from centre to centre.
double rough_form_factor(const PatchOutline& from, const PatchOutline& to, double area_to) {
  const Eigen::Vector3d way = to.center - from.center;
  const double squared = way.squaredNorm();
  const double cosines = std::max(0.0, from.normal.dot(way)) * std::max(0.0, -to.normal.dot(way));
  return cosines * area_to / (squared * (std::numbers::pi * squared + area_to));
}
static_assert(NearExchange::worst_count_error * NearExchange::worst_count_error > fewest_rays - 1);

}  // namespace

NearExchange::NearExchange(const PatchMesh& mesh)
    : area_(mesh.area), outlines_(static_cast<std::size_t>(mesh.patch_count())) {
  parallel_for(mesh.patch_count(), 256, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) outlines_[i] = patch_outline(mesh, i);
  });
}

double NearExchange::look(int patch, const EstimatedRow& row, std::vector<Pair>& pairs) const {
  double worst_variance = 0.0;
  for (std::size_t k = 0; k < row.shares.size(); ++k) {
    const int j = row.shares[k].patch;
    const int first = static_cast<int>(std::lround(row.shares[k].value * row.rays));
    const bool polygons = outlines_[patch].is_polygon() && outlines_[j].is_polygon();
    // Geometry picks the pairs. If counts did, those that came out high by chance would be put
    // right and those that came out low would not, and all rows would be too small.
    const bool is_worth_it =
        polygons &&
        (first >= plenty_of_rays ||
         row.rays * rough_form_factor(outlines_[patch], outlines_[j], area_[j]) >= fewest_rays);
    if (!is_worth_it) {
      worst_variance = std::max(worst_variance, first / (row.rays * row.rays));
      continue;
    }
    const int hidden = row.hidden.empty() ? 0 : row.hidden[k];
    const int all = first + hidden;
    // U^2 V (1 - V) / all with U = all / rays.
    worst_variance =
        std::max(worst_variance, static_cast<double>(first) * hidden / (all * row.rays * row.rays));
    pairs.push_back({.i = std::min(patch, j), .j = std::max(patch, j), .first = first, .all = all});
  }
  return std::sqrt(worst_variance);
}

std::vector<SymmetricEntry> NearExchange::exchange(std::vector<Pair> pairs,
                                                   const Progress& progress) const {
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.i, a.j, a.first, a.all) < std::tie(b.i, b.j, b.first, b.all);
  });
  std::size_t kept = 0;
  for (const Pair& pair : pairs) {
    if (kept > 0 && pairs[kept - 1].i == pair.i && pairs[kept - 1].j == pair.j) {
      pairs[kept - 1].first += pair.first;
      pairs[kept - 1].all += pair.all;
    } else {
      pairs[kept++] = pair;
    }
  }
  pairs.resize(kept);
  const PairExchange closed_form(outlines_);
  std::vector<SymmetricEntry> entries(pairs.size());
  const int count = static_cast<int>(pairs.size());
  constexpr int slice = 1 << 16;
  for (int begin = 0; begin < count; begin += slice) {
    report(progress, "closed forms", static_cast<double>(begin) / count);
    parallel_for(std::min(slice, count - begin), 64, [&](int low, int high) {
      for (int k = begin + low; k < begin + high; ++k) {
        const Pair& pair = pairs[k];
        const double unoccluded = closed_form.between(pair.i, pair.j);
        entries[k] = {pair.i, pair.j, unoccluded * pair.first / pair.all};
      }
    });
  }
  report(progress, "closed forms", 1.0);
  // Patches that lie on each other, face to face, have no closed form; their counts are exact.
  std::erase_if(entries, [](const SymmetricEntry& entry) { return !(entry.value > 0.0); });
  return entries;
}

}  // namespace lightwell
