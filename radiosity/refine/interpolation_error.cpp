#include "radiosity/refine/interpolation_error.h"

#include <algorithm>
#include <cmath>

#include "radiosity/refine/cell_vertices.h"
#include "radiosity/refine/error_reference.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

// Share of the noise that counts in the test for even indirect light. The product of two gathers
// has no noise in the mean, and most of the differences that noise hides are nothing.
constexpr double counted_noise = 0.25;

// A straight shadow edge crosses at most 2 sqrt(n) of the n cells of stratified rays, each of which
// is off by 0.3 in the root mean square. The two halves of a light's rays are independent.
double mixed_shadow_noise(int rays) {
  const double half = 0.5 * rays;
  const double of_half = 0.3 * std::sqrt(2.0 * std::sqrt(half)) / half;
  return std::sqrt(0.5) * of_half;
}

double mean_square(const Spectrum& difference) {
  return difference.cast<double>().square().mean();
}

}  // namespace

// Weighted sums of the squares of differences between gathered and interpolated irradiance.
struct InterpolationError::Differences {
  double direct = 0.0, both = 0.0;  // `both` without the noise of the indirect light
  double indirect = 0.0, noise = 0.0;

  void add(double weight, const Spectrum& of_direct, const Spectrum& first,
           const Spectrum& second) {
    const Eigen::ArrayXd d = of_direct.cast<double>(), a = first.cast<double>(),
                         b = second.cast<double>();
    // The noise of the two gathers is independent, so the mean of their product has none.
    const double product = (a * b).mean();
    direct += weight * d.square().mean();
    indirect += weight * product;
    both += weight * (d.square().mean() + (d * (a + b)).mean() + product);
    noise += weight * 0.25 * (a - b).square().mean();
  }
};

InterpolationError::InterpolationError(const LitScene& lit, const BandArray& radiosity,
                                       const BandArray& caustic, RefinedElements& elements,
                                       const GatherOptions& options, const RefineOptions& refine)
    : caster_(lit.caster),
      elements_(elements),
      gathers_(lit, radiosity, caustic, elements, options, refine),
      predictions_(elements, gathers_),
      shadows_(elements, gathers_),
      parts_(refine.parts),
      means_(parts_) {
  set_tolerance(refine);
  find_what_matters();
}

void InterpolationError::find_what_matters() {
  const PatchMesh& mesh = elements_.base();
  const std::vector<char> judged = judged_patches(mesh, parts_);
  matters_.assign(mesh.element_count(), 0);
  area_.assign(static_cast<std::size_t>(parts_.group_count()), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    const bool is_back = mesh.is_back[p] != 0;
    const int front = is_back && mesh.twin[e] >= 0 ? mesh.twin[e] : e;
    if (judged[p] == 0 || caster_.is_hidden(front, is_back)) continue;
    matters_[e] = 1;
    double E = 0.0;
    for (int i = 0; i < mesh.corner_count(e); ++i) E += gathers_.total(mesh.corners[e][i]).mean();
    means_.add(p, mesh.element_area[e], E / mesh.corner_count(e));
    area_[static_cast<std::size_t>(parts_.group_of(p))] += mesh.element_area[e];
  }
  means_.finish();
}

void InterpolationError::make_room() {
  gathers_.make_room();
  predictions_.make_room();
  between_.resize(elements_.side_total(), -1.0f);
}

void InterpolationError::shrink_to_fit() {
  gathers_.shrink_to_fit();
  predictions_.shrink_to_fit();
  between_.shrink_to_fit();
}

std::vector<InterpolatedVertex> InterpolationError::interpolated(const std::vector<int>& vertices) {
  std::vector<InterpolatedVertex> interpolated = predictions_.interpolated(vertices);
  make_room();
  return interpolated;
}

std::vector<VertexPrediction> InterpolationError::predictions(
    const std::vector<int>& vertices, std::span<const InterpolatedVertex> interpolated) {
  make_room();
  return predictions_.predictions(vertices, interpolated,
                                  [this](int cell, int side) { return reference(cell, side); });
}

void InterpolationError::gather(const std::vector<int>& vertices,
                                std::span<const InterpolatedVertex> interpolated) {
  make_room();
  gathers_.gather_direct_at(vertices);
  std::vector<int> others = indices_without(interpolated, vertices.size());
  for (int& index : others) index = vertices[index];
  gathers_.gather_indirect_at(others);
  for (const int v : vertices) gathers_.interpolate_indirect(v);
}

double InterpolationError::expected(int cell, int side) const {
  if (!matters(elements_.element(cell, side)) || !(reference(cell, side) > 0.0)) return 0.0;
  Spectrum low = gathers_.total(elements_.corner_vertex(cell, side, 0)), high = low;
  for (int i = 1; i < elements_.corner_count(cell); ++i) {
    const Spectrum E = gathers_.total(elements_.corner_vertex(cell, side, i));
    low = low.min(E);
    high = high.max(E);
  }
  return (mean_square(high - low) + shadows_.greatest_peak_error(cell, side)) /
             std::pow(reference(cell, side), 2) +
         std::pow(unseen_range, 2);
}

// Irradiance that errors in the cell are relative to, W/m^2.
double InterpolationError::reference(int cell, int side) const {
  double sum = 0.0;
  for (int i = 0; i < elements_.corner_count(cell); ++i) {
    sum += gathers_.total(elements_.corner_vertex(cell, side, i)).mean();
  }
  const int patch = elements_.base().patch[elements_.element(cell, side)];
  return error_reference(means_.of_patch(patch), sum / elements_.corner_count(cell));
}

// Differences count if they are beyond doubt; `hidden` gets what noise may hide otherwise. The
// noise of the sky and of clusters of lights is known at each vertex, and is left to the final
// gather instead: to split a cell would not reduce it. Of many cells whose differences are noise,
// some exceed twice the noise, and few four times.
InterpolationError::Squares InterpolationError::beyond_noise(const Differences& differences,
                                                             double shadow_noise,
                                                             double drawn_noise) {
  constexpr double beyond_drawn = 4.0;
  // The product of only two gathers, over one cell, has an error of about the noise.
  const bool indirect_counts = differences.indirect > beyond_doubt * differences.noise;
  const double error = indirect_counts ? differences.both : differences.direct;
  const double noise = shadow_noise + drawn_noise;
  const bool shadow_counts = error > beyond_doubt * shadow_noise + beyond_drawn * drawn_noise;
  return {.error = shadow_counts ? error - noise : 0.0,
          .hidden = (indirect_counts ? 0.0 : differences.noise) +
                    (shadow_counts ? 0.0 : std::clamp(error - drawn_noise, 0.0, shadow_noise)),
          .direct = differences.direct,
          .shadow_noise = noise,
          .indirect = std::max(differences.indirect, 0.0) + counted_noise * differences.noise,
          .noise = differences.noise};
}

// Simpson's rule in both directions: 16/36 in the centre, 4/36 at each edge, nothing at the
// corners, where interpolation is exact. In triangles a third at each edge.
InterpolationError::Squares InterpolationError::lattice_error(int cell, int side) const {
  const int n = elements_.corner_count(cell);
  const double at_edge = n == 4 ? 4.0 / 36.0 : 1.0 / 3.0, at_center = 16.0 / 36.0;
  const BandArray &direct = gathers_.direct(), &first = gathers_.first(),
                  &second = gathers_.second();
  Differences differences;
  double shadow_noise = 0.0, drawn_noise = 0.0;
  const double of_one = mixed_shadow_noise(gathers_.options().shadows.max_rays);
  const auto add_shadow_noise = [&](int v, double weight) {
    const EmitterVisibility visibility = gathers_.visibility(v);
    shadow_noise += weight * std::pow(of_one * visibility.noisy, 2);
    drawn_noise += weight * std::pow(visibility.drawn_noise, 2);
  };
  Spectrum mean_direct = Spectrum::Zero(direct.cols()), mean_first = mean_direct,
           mean_second = mean_direct;
  for (int i = 0; i < n; ++i) {
    const int a = elements_.corner_vertex(cell, side, i);
    const int b = elements_.corner_vertex(cell, side, (i + 1) % n);
    const int v = elements_.edge_vertex(cell, side, i);
    const auto off = [&](const BandArray& values) -> Spectrum {
      return (values.row(v) - 0.5f * (values.row(a) + values.row(b))).transpose();
    };
    differences.add(at_edge, off(direct), off(first), off(second));
    add_shadow_noise(v, at_edge);
    // The squared weights of each corner in its two edges and in the centre.
    add_shadow_noise(a, 2 * at_edge * 0.25 + (n == 4 ? at_center / 16.0 : 0.0));
    mean_direct += direct.row(a).transpose() / static_cast<float>(n);
    mean_first += first.row(a).transpose() / static_cast<float>(n);
    mean_second += second.row(a).transpose() / static_cast<float>(n);
  }
  if (n == 4) {
    const int v = elements_.center_vertex(cell, side);
    differences.add(at_center, direct.row(v).transpose() - mean_direct,
                    first.row(v).transpose() - mean_first, second.row(v).transpose() - mean_second);
    add_shadow_noise(v, at_center);
  }
  return beyond_noise(differences, shadow_noise, drawn_noise);
}

// Indirect light is gathered, or interpolated where the parent's is even.
void InterpolationError::gather_for(const std::vector<int>& cells) {
  std::vector<int> vertices, to_gather, to_interpolate;
  for (const int cell : cells) {
    for (int side = 0; side < elements_.side_count(cell); ++side) {
      if (!matters(elements_.element(cell, side))) continue;
      const std::size_t first = vertices.size();
      for_each_vertex(elements_, cell, side, [&](int v) { vertices.push_back(v); });
      std::vector<int>& indirect =
          predictions_.is_interpolated(cell, side) ? to_interpolate : to_gather;
      indirect.insert(indirect.end(), vertices.begin() + static_cast<std::ptrdiff_t>(first),
                      vertices.end());
    }
  }
  make_room();
  gathers_.gather_direct_at(vertices);
  gathers_.gather_indirect_at(to_gather);
  for (const int v : to_interpolate) gathers_.interpolate_indirect(v);
}

std::vector<InterpolationError::Measured> InterpolationError::measure(
    const std::vector<int>& cells) {
  gather_for(cells);
  const int count = static_cast<int>(cells.size());
  std::vector<Measured> measured(cells.size());
  constexpr int slice = 4096;  // cells between two reports of progress, which may stop the work
  for (int begin = 0; begin < count; begin += slice) {
    report(gathers_.options().run.progress, "refine", static_cast<double>(begin) / count);
    parallel_for(std::min(slice, count - begin), 16, [&](int low, int high) {
      for (int i = begin + low; i < begin + high; ++i) {
        for (int side = 0; side < elements_.side_count(cells[i]); ++side) {
          measure(cells[i], side, measured[i]);
        }
      }
    });
  }
  return measured;
}

void InterpolationError::measure(int cell, int side, Measured& measured) {
  if (!matters(elements_.element(cell, side))) return;
  const double E = reference(cell, side);
  if (!(E > 0.0)) return;
  CornerPredictions::CellSide& known = predictions_.side(cell, side);
  known.was_interpolated = predictions_.is_interpolated(cell, side);
  const Squares lattice = lattice_error(cell, side);
  float& between = between_[elements_.side_number(cell, side)];
  if (between < 0.0f) {
    const double found = shadows_.error(cell, side, lattice.direct, lattice.shadow_noise);
    between = static_cast<float>(found / (E * E));
  }
  measured.error[side] = lattice.error / (E * E) + between;
  measured.hidden[side] = lattice.hidden / (E * E);
  if (known.was_interpolated) return;
  known.indirect = static_cast<float>(lattice.indirect / (E * E));
  known.noise = static_cast<float>(lattice.noise / (E * E));
}

}  // namespace lightwell
