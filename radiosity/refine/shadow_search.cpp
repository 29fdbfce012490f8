#include "radiosity/refine/shadow_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "radiosity/refine/cell_vertices.h"
#include "scene/random_purpose.h"

namespace lightwell {
namespace {

constexpr int probe_count = 16;

}  // namespace

ShadowSearch::ShadowSearch(RefinedElements& elements, const VertexGathers& gathers)
    : elements_(elements),
      gathers_(gathers),
      probes_(probe_count),
      peaks_(gathers.lit().direct_light) {}

double ShadowSearch::error(int cell, int side, double at_vertices, double shadow_noise) const {
  double error = probed_error(cell, side) + peaks_error(cell, side);
  // An edge that passes the middle by an eighth of its penumbra makes an error of an eighth of the
  // corners' range in the centre and in the middles of the two edges that it crosses. With
  // Simpson's weights the mean square is (16 + 2 * 4) / 36 / 8^2 = 0.0104, about 0.1^2, of the
  // squared range.
  constexpr double by_chance = 0.1;
  const double range = direct_range(cell, side);
  if (at_vertices < std::pow(by_chance * range, 2) && has_edge(cell, side)) {
    const double of_parts = parts_error(cell, side);
    if (of_parts > beyond_doubt * shadow_noise) error += of_parts - shadow_noise;
  }
  return error;
}

// Largest difference of direct light between corners, mean of the bands, W/m^2.
double ShadowSearch::direct_range(int cell, int side) const {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (int i = 0; i < elements_.corner_count(cell); ++i) {
    const double E = gathers_.direct().row(elements_.corner_vertex(cell, side, i)).mean();
    low = std::min(low, E);
    high = std::max(high, E);
  }
  return high - low;
}

// True if some vertices of the cell see the whole of a light and others do not, or some see nothing
// of a light and others something.
bool ShadowSearch::has_edge(int cell, int side) const {
  EmitterVisibility some, all{.whole = ~std::uint64_t{0}, .hidden = ~std::uint64_t{0}};
  for_each_vertex(elements_, cell, side, [&](int v) {
    const EmitterVisibility visibility = gathers_.visibility(v);
    some.whole |= visibility.whole;
    some.hidden |= visibility.hidden;
    all.whole &= visibility.whole;
    all.hidden &= visibility.hidden;
  });
  return some.whole != all.whole || some.hidden != all.hidden;
}

// u and v in [0, 1].
ShadowSearch::CellPoint ShadowSearch::point_in(int cell, int side, double u, double v) const {
  Eigen::Vector4d weights;
  if (elements_.corner_count(cell) == 4) {
    weights = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
  } else {
    weights << triangle_point(u, v), 0.0;
  }
  return point_in(cell, side, weights);
}

ShadowSearch::CellPoint ShadowSearch::point_in(int cell, int side,
                                               const Eigen::Vector4d& weights) const {
  const int n = elements_.corner_count(cell);
  CellPoint found{.direct = Spectrum::Zero(gathers_.lit().scene.bands.count())};
  for (int i = 0; i < n; ++i) {
    const int corner = elements_.corner_vertex(cell, side, i);
    found.position += weights[i] * elements_.position(corner);
    found.direct += static_cast<float>(weights[i]) * gathers_.direct().row(corner).transpose();
  }
  return found;
}

ShadowSearch::Plane ShadowSearch::plane_of(int cell, int side) const {
  const int element = elements_.element(cell, side);
  return {element_center(elements_.base(), element).normal, elements_.base().facet[element]};
}

// Gathers direct light at the point and compares it with the interpolated one; mean of the bands.
double ShadowSearch::squared_error(const Plane& plane, const CellPoint& at, std::uint64_t key,
                                   EmitterVisibility* visibility) const {
  const LitScene lit = gathers_.lit();
  const Spectrum E = lit.direct_light.irradiance(lit.caster,
                                                 {.at = {at.position, plane.normal, plane.facet},
                                                  .key = key,
                                                  .shadows = gathers_.options().shadows},
                                                 visibility);
  const Spectrum difference = E - at.direct;
  return difference.cast<double>().square().mean();
}

// Mean over the middles of the four parts.
double ShadowSearch::parts_error(int cell, int side) const {
  const Plane plane = plane_of(cell, side);
  const std::uint64_t key =
      random_key(static_cast<std::uint64_t>(2 * cell + side), RandomPurpose::refinement_quarters);
  double error = 0.0;
  for (int k = 0; k < 4; ++k) {
    const CellPoint at = point_in(cell, side, k % 2 == 0 ? 0.25 : 0.75, k < 2 ? 0.25 : 0.75);
    error += squared_error(plane, at, random_key(key, static_cast<std::uint64_t>(k))) / 4.0;
  }
  return error;
}

double ShadowSearch::greatest_peak_error(int cell, int side) const {
  const Plane plane = plane_of(cell, side);
  double error = 0.0;
  for (const LightPeak& peak : peaks_.of_cell(elements_, cell, side, plane.normal, plane.facet)) {
    error = std::max(error, peak.share * peak.light * peak.light);
  }
  return error;
}

// Peaks are compared one at a time: if one is missed, the cell is split, and its parts find others.
double ShadowSearch::peaks_error(int cell, int side) const {
  const Plane plane = plane_of(cell, side);
  const std::vector<LightPeak> peaks =
      peaks_.of_cell(elements_, cell, side, plane.normal, plane.facet);
  // Numbers of keys behind those of the four parts.
  constexpr std::uint64_t behind_parts = 4;
  const std::uint64_t key =
      random_key(static_cast<std::uint64_t>(2 * cell + side), RandomPurpose::refinement_quarters);
  double error = 0.0;
  for (std::size_t k = 0; k < peaks.size(); ++k) {
    if (peaks[k].share * peaks[k].light * peaks[k].light <= error) continue;
    EmitterVisibility visibility;
    const double squared =
        squared_error(plane, point_in(cell, side, peaks[k].weights),
                      random_key(key, behind_parts + static_cast<std::uint64_t>(k)), &visibility);
    if (squared < std::pow(beyond_doubt * visibility.drawn_noise, 2)) continue;
    error = std::max(error, peaks[k].share * squared);
  }
  return error;
}

// Mean over the probes of each light, added over the lights; 0 where a probe sees as the vertices
// do.
double ShadowSearch::probed_error(int cell, int side) const {
  std::uint64_t whole = ~std::uint64_t{0}, hidden = whole;
  for_each_vertex(elements_, cell, side, [&](int v) {
    const EmitterVisibility visibility = gathers_.visibility(v);
    whole &= visibility.whole;
    hidden &= visibility.hidden;
  });
  const LitScene lit = gathers_.lit();
  const Plane plane = plane_of(cell, side);
  const std::uint64_t key =
      random_key(static_cast<std::uint64_t>(2 * cell + side), RandomPurpose::refinement_probes);
  double error = 0.0;
  const std::size_t lights =
      std::min<std::size_t>(static_cast<std::size_t>(lit.direct_light.light_count()), 64);
  for (std::size_t e = 0; e < lights; ++e) {
    const bool all_see = (whole >> e & 1U) != 0;
    if (!all_see && (hidden >> e & 1U) == 0) continue;
    for (int k = 0; k < probe_count; ++k) {
      const Eigen::Array4f u = probes_.point(k, random_key(key, e));
      const CellPoint at = point_in(cell, side, u[0], u[1]);
      const auto sees = lit.direct_light.sees(static_cast<int>(e), lit.caster,
                                              {at.position, plane.normal, plane.facet}, u[2], u[3]);
      if (!sees || *sees == all_see) continue;
      error +=
          squared_error(plane, at, random_key(key, e, static_cast<std::uint64_t>(k))) / probe_count;
    }
  }
  return error;
}

}  // namespace lightwell
