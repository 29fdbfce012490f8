#include "radiosity/form_factors/near_exchange.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/openings/portals.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

// Expected rays of a pair from which a closed form pays.
constexpr int fewest_near_rays = 12;
// Counted rays from which the count alone decides for a closed form.
constexpr int plenty_of_rays = 128;

// Form factor to a disc of the same area, between centres; too large rather than too small where
// one patch reaches behind the other's plane.
double rough_form_factor(const PatchOutline& from, const PatchOutline& to, double area_to) {
  const Eigen::Vector3d way = to.center - from.center;
  const double squared = way.squaredNorm();
  const double cosines = std::max(0.0, from.normal.dot(way) + to.radius) *
                         std::max(0.0, from.radius - to.normal.dot(way));
  return cosines * area_to / (squared * (std::numbers::pi * squared + area_to));
}

static_assert(NearExchange::worst_count_error * NearExchange::worst_count_error >
              fewest_near_rays - 1);

}  // namespace

NearExchange::NearExchange(const ElementCaster& caster, double target_error, const Portals* portals)
    : area_(caster.mesh().area),
      target_error_(target_error),
      portals_(portals),
      outlines_(patch_outlines(caster.mesh())) {
  if (target_error > 0.0) shafts_.emplace(caster, outlines_);
}

// True if counts leave too much variance in F_ij and the pair can be clipped exactly.
bool NearExchange::is_exact_due(int i, int j, double variance, Between& between) const {
  if (!shafts_ || !(variance > target_error_ * target_error_)) return false;
  if (shafts_->is_covered(i) || shafts_->is_covered(j)) return false;
  shafts_->find(i, j, between);
  return shafts_->has_exact(i, j, between);
}

double NearExchange::find_pairs(int patch, const EstimatedRow& row,
                                std::vector<Pair>& pairs) const {
  double worst_variance = 0.0;
  Between between;
  for (std::size_t k = 0; k < row.shares.size(); ++k) {
    const int j = row.shares[k].patch;
    const int first = static_cast<int>(std::lround(row.shares[k].value * row.rays));
    const bool polygons =
        outlines_[patch].is_polygon() && outlines_[j].is_polygon() &&
        !(portals_ && portals_->part(outlines_[patch].center, outlines_[j].center));
    // Pairs are chosen by geometry. A choice by counts would correct counts that are high by chance
    // but not those that are low, and bias all rows downwards.
    const bool is_worth_it =
        polygons && (first >= plenty_of_rays ||
                     row.rays * rough_form_factor(outlines_[patch], outlines_[j], area_[j]) >=
                         fewest_near_rays);
    if (!is_worth_it) {
      worst_variance = std::max(worst_variance, first / (row.rays * row.rays));
      continue;
    }
    const int hidden = row.hidden.empty() ? 0 : row.hidden[k];
    const int all = first + hidden;
    // U^2 V (1 - V) / all with U = all / rays and V = first / all.
    const double variance = static_cast<double>(first) * hidden / (all * row.rays * row.rays);
    if (!is_exact_due(patch, j, variance, between)) {
      worst_variance = std::max(worst_variance, variance);
    }
    pairs.push_back({.patch = j, .first = first, .all = all});
  }
  return std::sqrt(worst_variance);
}

void NearExchange::add_row(const PairExchange& closed_form, int i, RecordSpan row,
                           RecordSpan column, std::vector<FormFactor>& exchange) const {
  Between between;
  for_each_pair(i, row, column, [&](int j, const std::byte* own, const std::byte* other) {
    int first = 0, all = 0;
    for (const std::byte* record : {own, other}) {
      if (!record) continue;
      first += reinterpret_cast<const Pair*>(record)->first;
      all += reinterpret_cast<const Pair*>(record)->all;
    }
    const double unoccluded = closed_form.between(i, j);
    const double seen = static_cast<double>(first) / all;
    const double F = unoccluded / std::min(area_[i], area_[j]);
    double S = unoccluded * seen;
    if (is_exact_due(i, j, F * F * seen * (1.0 - seen) / all, between)) {
      constexpr double share_of_target = 0.1;
      const auto exact =
          shafts_->visible(i, j, between, unoccluded, share_of_target * target_error_);
      if (exact) S = exact->value;
    }
    // Patches that lie on each other, face to face, have no closed form; their counts are exact. A
    // known exchange of 0 is stored, too.
    if (unoccluded > 0.0) exchange.push_back({j, static_cast<float>(S)});
  });
}

void NearExchange::exchange(RecordStore pairs, const Progress& progress,
                            const std::function<void(int, std::vector<FormFactor>&)>& take,
                            const JournalPhase& phase) const {
  const PairExchange closed_form(outlines_);
  const int n = pairs.row_count();
  // Ranges are those of the process with the least room, so that all processes go through the same.
  for (const ColumnRange range : column_ranges(pairs, phase.least(pairs.budget().block_bytes()))) {
    const ColumnBlock block(pairs, range.first, range.last);
    const int slice = 256 * phase.processes();  // rows; a fraction of a second
    for (int begin = range.first; begin < range.last; begin += slice) {
      const auto report_progress = [&] {
        report(progress, "closed forms", static_cast<double>(begin) / n);
      };
      report_progress();
      const int size = std::min(slice, range.last - begin);
      std::vector<std::vector<FormFactor>> rows(static_cast<std::size_t>(size));
      const auto compute = [&](int low, int high) {
        for (int k = low; k < high; ++k) {
          std::vector<FormFactor>& row = rows[static_cast<std::size_t>(k)];
          if (phase.recall(begin + k, row)) continue;
          row.clear();
          add_row(closed_form, begin + k, pairs.row(begin + k), block.column(begin + k), row);
          phase.keep(begin + k, row);
        }
      };
      phase.for_each({begin, size, 1}, compute, report_progress);
      for (int k = 0; k < size; ++k) {
        take(begin + k, rows[static_cast<std::size_t>(k)]);
        pairs.release(begin + k);
      }
    }
  }
  report(progress, "closed forms", 1.0);
}

}  // namespace lightwell
