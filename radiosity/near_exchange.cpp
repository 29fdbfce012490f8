#include "radiosity/near_exchange.h"

#include <algorithm>
#include <cmath>

#include "radiosity/pair_exchange.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

// Fewer rays than this tell too little about what stands between.
constexpr int fewest_rays = 12;
static_assert(NearExchange::worst_count_error * NearExchange::worst_count_error > fewest_rays - 1);

}  // namespace

NearExchange::NearExchange(const PatchMesh& mesh)
    : mesh_(mesh), outlines_(static_cast<std::size_t>(mesh.patch_count())) {
  parallel_for(mesh.patch_count(), 256, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) outlines_[i] = patch_outline(mesh, i);
  });
  for (const PatchOutline& outline : outlines_) {
    int steepest = 0;
    outline.normal.cwiseAbs().maxCoeff(&steepest);
    axes_.push_back({(steepest + 1) % 3, (steepest + 2) % 3});
  }
}

bool NearExchange::contains(int patch, const Eigen::Vector3d& point) const {
  const auto [x, y] = axes_[patch];
  bool inside = false;
  for (const auto& loop : outlines_[patch].loops) {
    const Eigen::Vector3d* before = &loop.back();
    for (const Eigen::Vector3d& at : loop) {
      const Eigen::Vector3d &a = *before, &b = at;
      before = &at;
      if ((a[y] > point[y]) == (b[y] > point[y])) continue;
      if (point[x] < a[x] + (point[y] - a[y]) / (b[y] - a[y]) * (b[x] - a[x])) inside = !inside;
    }
  }
  return inside;
}

double NearExchange::look(int patch, const EstimatedRow& row, std::span<const CastRay> rays,
                          std::vector<Pair>& pairs) const {
  if (rays.empty()) return 0.0;
  const auto count = static_cast<double>(rays.size());
  const bool has_outline = outlines_[patch].is_polygon();
  double worst_variance = 0.0;
  for (const FormFactor& share : row.shares) {
    const int j = share.patch;
    const PatchOutline& other = outlines_[j];
    const int first = static_cast<int>(std::lround(share.value * count));
    if (first < fewest_rays || !has_outline || !other.is_polygon()) {
      worst_variance = std::max(worst_variance, first / (count * count));
      continue;
    }
    int blocked = 0;
    const double offset = other.normal.dot(other.loops[0][0]);
    const double squared_radius = other.radius * other.radius;
    for (const CastRay& ray : rays) {
      if (ray.patch == j) continue;
      const double facing = other.normal.dot(ray.direction);
      if (!(facing < 0.0)) continue;
      const double t = (offset - other.normal.dot(ray.origin)) / facing;
      if (!(t > ray.t)) continue;
      const Eigen::Vector3d at = ray.origin + t * ray.direction;
      if ((at - other.center).squaredNorm() > squared_radius || !contains(j, at)) continue;
      ++blocked;
    }
    const int all = first + blocked;
    // U^2 V (1 - V) / all with U = all / count.
    worst_variance =
        std::max(worst_variance, static_cast<double>(first) * blocked / (all * count * count));
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
