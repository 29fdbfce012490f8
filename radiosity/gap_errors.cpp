#include "radiosity/gap_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "mesh/patches/round_grid.h"
#include "mesh/patches/translucency.h"
#include "radiosity/gather/gap_sizes.h"
#include "radiosity/refine/error_reference.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr int point_count = 4;
constexpr int gap_rays = 64;
constexpr std::uint64_t gap_replica = 4000;

// Elements that two million rays measure: those of the hemisphere, and shadow rays to each light. A
// cut through many lights asks some 50 of them.
int elements_in_budget(int light_count) {
  constexpr int budget = 1 << 21, most_asked = 50;
  return budget / (point_count * gap_rays * (1 + std::min(light_count, most_asked)));
}

// A point inside an element.
struct InnerPoint {
  int element = -1;
  std::array<double, 4> weights{};  // of the corners
};

// Point k of an element: in the middle of a quarter of a quadrilateral, half-way from the centre of
// a triangle to a corner, or in its centre.
InnerPoint inner_point(const PatchMesh& mesh, int element, int k) {
  if (mesh.corner_count(element) == 4) {
    const double u = k % 2 == 0 ? 0.25 : 0.75, v = k < 2 ? 0.25 : 0.75;
    return {element, {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v}};
  }
  constexpr double third = 1.0 / 3.0;
  InnerPoint point{element, {third, third, third, 0.0}};
  if (k == 3) return point;
  for (int c = 0; c < 3; ++c) {
    point.weights[static_cast<std::size_t>(c)] = 0.5 * third + (c == k ? 0.5 : 0.0);
  }
  return point;
}

Eigen::Vector3d position(const PatchMesh& mesh, const InnerPoint& point) {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  for (int c = 0; c < mesh.corner_count(point.element); ++c) {
    at +=
        point.weights[static_cast<std::size_t>(c)] * mesh.position(mesh.corners[point.element][c]);
  }
  return at;
}

// Number of corners without light.
int dark_corners(const PatchMesh& mesh, const BandArray& irradiance, int element) {
  int count = 0;
  for (int c = 0; c < mesh.corner_count(element); ++c) {
    count += (irradiance.row(mesh.corners[element][c]) > 0.0f).any() ? 0 : 1;
  }
  return count;
}

// True if another surface is near above a point of the element.
bool lies_in_gap(const ElementCaster& caster, int element, double size) {
  const PatchMesh& mesh = caster.mesh();
  constexpr double narrowest = 1e-4;  // nearer surfaces lie on each other
  const Eigen::Vector3d normal = element_center(mesh, element).normal;
  std::array<Ray, point_count> rays;
  std::array<ElementHit, point_count> hits;
  for (int k = 0; k < point_count; ++k) {
    rays[static_cast<std::size_t>(k)] = {.origin = position(mesh, inner_point(mesh, element, k)),
                                         .direction = normal,
                                         .t_max = widest_gap * size,
                                         .origin_group = mesh.facet[element]};
  }
  caster.closest_elements(rays, hits);
  return std::ranges::any_of(
      hits, [&](const ElementHit& hit) { return hit.facet >= 0 && hit.t > narrowest * size; });
}

// The reflecting elements that lie in gaps; round shapes are left out.
std::vector<int> elements_in_gaps(const ElementCaster& caster) {
  const PatchMesh& mesh = caster.mesh();
  const std::vector<float> sizes = gap_sizes(mesh);
  std::vector<char> is_in_gap(static_cast<std::size_t>(mesh.element_count()), 0);
  parallel_for(mesh.element_count(), 1024, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      const bool reflects = scatters(mesh, mesh.patch[e]);
      if (!reflects || round_grid_of(mesh, mesh.facet[e])) continue;
      is_in_gap[static_cast<std::size_t>(e)] =
          lies_in_gap(caster, e, double{sizes[static_cast<std::size_t>(e)]}) ? 1 : 0;
    }
  });
  std::vector<int> found;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (is_in_gap[static_cast<std::size_t>(e)]) found.push_back(e);
  }
  return found;
}

// Squared difference of interpolated from gathered irradiance, mean of the bands.
double squared_error(const PatchMesh& mesh, const BandArray& irradiance, const InnerPoint& point,
                     const Spectrum& gathered) {
  Spectrum E = Spectrum::Zero(irradiance.cols());
  for (int c = 0; c < mesh.corner_count(point.element); ++c) {
    const auto weight = static_cast<float>(point.weights[static_cast<std::size_t>(c)]);
    E += weight * irradiance.row(mesh.corners[point.element][c]).transpose();
  }
  return (E - gathered).cast<double>().square().mean();
}

void raise_to(float& value, double to) {
  value = std::max(value, static_cast<float>(to));
}

// An element in a gap, and its squared error relative to the reference; below 0: not measured.
struct GapElement {
  int element = -1;
  double square = -1.0;
};

// Gives elements that were not measured the mean square of those of their surface that were, or of
// all.
void spread_to_surfaces(const PatchMesh& mesh, std::vector<GapElement>& elements) {
  struct Mean {
    double sum = 0.0;
    int count = 0;
    void add(double square) {
      sum += square;
      ++count;
    }
  };
  std::map<int, Mean> of_surface;
  Mean of_all;
  const auto surface = [&](int element) { return mesh.surface[mesh.patch[element]]; };
  for (const auto& [element, square] : elements) {
    if (square < 0.0) continue;
    of_surface[surface(element)].add(square);
    of_all.add(square);
  }
  if (of_all.count == 0) return;
  for (auto& [element, square] : elements) {
    if (!(square < 0.0)) continue;
    const auto own = of_surface.find(surface(element));
    const Mean& mean = own != of_surface.end() ? own->second : of_all;
    square = mean.sum / mean.count;
  }
}

}  // namespace

void add_gap_errors(const LitScene& lit, const GatherOptions& gather, RadiositySolution& solution,
                    int most) {
  const PatchMesh& mesh = lit.mesh();
  if (solution.interpolation_error.size() != mesh.element_count()) return;
  // Caustics are in the mesh alone, and no gather at a point finds them.
  BandArray irradiance = solution.irradiance();
  const BandArray radiosity =
      gatherable_radiosity(mesh, lit.direct_light, irradiance, solution.direct_irradiance);
  const Eigen::ArrayXd reference = error_references(mesh, irradiance, solution.parts);
  std::vector<GapElement> lit_elements;
  for (const int e : elements_in_gaps(lit.caster)) {
    const int corners = mesh.corner_count(e), dark = dark_corners(mesh, irradiance, e);
    // If none of N rays found light, light from less than 3 / N of the directions may be missed
    // (rule of three, odds of 19 to 1), and the error is half of the bound.
    const double rays = static_cast<double>(corners) * gather.rays;
    if (dark > 0) raise_to(solution.interpolation_error[e], 0.5 * 3.0 / rays);
    if (dark != corners && reference[e] > 0.0) lit_elements.push_back({e});
  }
  const auto all = static_cast<int>(lit_elements.size());
  most = std::min(most, elements_in_budget(lit.direct_light.light_count()));
  const auto step = static_cast<std::size_t>(std::max(1, (all + most - 1) / most));
  std::vector<InnerPoint> inner;
  for (std::size_t i = 0; i < lit_elements.size(); i += step) {
    for (int k = 0; k < point_count; ++k) {
      inner.push_back(inner_point(mesh, lit_elements[i].element, k));
    }
  }
  if (inner.empty()) return;
  if (solution.caustic_irradiance.size() > 0) irradiance -= solution.caustic_irradiance;
  GatherOptions options = gather;
  options.rays = gap_rays;
  options.shadows.max_rays = std::min(options.shadows.max_rays, gap_rays);
  options.shadows.min_rays = std::min(options.shadows.min_rays, options.shadows.max_rays);
  options.replica += gap_replica;
  const GatherPoints points(static_cast<int>(inner.size()), [&](int i) {
    const int e = inner[static_cast<std::size_t>(i)].element;
    return GatherPoint{.position = position(mesh, inner[static_cast<std::size_t>(i)]),
                       .normal = element_center(mesh, e).normal,
                       .facet = mesh.facet[e]};
  });
  const GatheredIrradiance found = gather_irradiance(lit, radiosity, points, options);
  for (std::size_t i = 0; i < inner.size(); i += point_count) {
    double square = 0.0;
    for (std::size_t k = i; k < i + point_count; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      const Spectrum E = (found.direct.row(row) + found.indirect.row(row)).transpose();
      square += squared_error(mesh, irradiance, inner[k], E) / point_count;
    }
    lit_elements[step * (i / point_count)].square =
        square / std::pow(reference[inner[i].element], 2);
  }
  spread_to_surfaces(mesh, lit_elements);
  for (const auto& [element, square] : lit_elements) {
    raise_to(solution.interpolation_error[element], std::sqrt(square));
  }
}

}  // namespace lightwell
