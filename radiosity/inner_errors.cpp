#include "radiosity/inner_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "radiosity/gather/gatherable_radiosity.h"
#include "radiosity/refine/error_reference.h"

namespace lightwell {
namespace {

// Elements that two million rays measure: those of the hemisphere, and shadow rays to each light. A
// cut through many lights asks some 50 of them.
int elements_in_budget(int rays, int light_count) {
  constexpr int budget = 1 << 21, most_asked = 50;
  return std::max(1, budget / (inner_point_count * rays * (1 + std::min(light_count, most_asked))));
}

// Weights of the corners in point k of an element.
std::array<double, 4> corner_weights(const PatchMesh& mesh, int element, int k) {
  if (mesh.corner_count(element) == 4) {
    const double u = k % 2 == 0 ? 0.25 : 0.75, v = k < 2 ? 0.25 : 0.75;
    return {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
  }
  constexpr double third = 1.0 / 3.0;
  std::array<double, 4> weights{third, third, third, 0.0};
  if (k == 3) return weights;
  for (int c = 0; c < 3; ++c) {
    weights[static_cast<std::size_t>(c)] = 0.5 * third + (c == k ? 0.5 : 0.0);
  }
  return weights;
}

// Squared difference of interpolated from gathered irradiance at point k, mean of the bands.
double squared_error(const PatchMesh& mesh, const BandArray& irradiance, const InnerError& of,
                     int k, const Spectrum& gathered) {
  const std::array<double, 4> weights = corner_weights(mesh, of.element, k);
  Spectrum E = Spectrum::Zero(irradiance.cols());
  for (int c = 0; c < mesh.corner_count(of.element); ++c) {
    const auto weight = static_cast<float>(weights[static_cast<std::size_t>(c)]);
    E += weight * irradiance.row(mesh.corners[of.element][c]).transpose();
  }
  return (E - gathered).cast<double>().square().mean();
}

// Squares of elements as the range of their corners lets expect, up to a factor.
double expected_square(const PatchMesh& mesh, const BandArray& irradiance,
                       const Eigen::ArrayXd& reference, int element) {
  return squared_range(mesh, irradiance, element) / std::pow(reference[element], 2) +
         std::pow(unseen_range, 2);
}

// Gives elements that were not measured their expected square, times the ratio of measured squares
// to expected ones of their surface, or of all (a ratio estimator; Cochran 1977, chapter 6).
void spread_to_surfaces(const PatchMesh& mesh, const std::vector<double>& expected,
                        std::vector<InnerError>& elements) {
  struct Ratio {
    double measured = 0.0, expected = 0.0;
    void add(double square, double as_expected) {
      measured += square;
      expected += as_expected;
    }
  };
  std::map<int, Ratio> of_surface;
  Ratio of_all;
  const auto surface = [&](int element) { return mesh.surface[mesh.patch[element]]; };
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const auto& [element, square] = elements[i];
    if (square < 0.0) continue;
    of_surface[surface(element)].add(square, expected[i]);
    of_all.add(square, expected[i]);
  }
  if (!(of_all.expected > 0.0)) return;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    auto& [element, square] = elements[i];
    if (!(square < 0.0)) continue;
    const auto own = of_surface.find(surface(element));
    const Ratio& ratio = own != of_surface.end() ? own->second : of_all;
    square = ratio.measured / ratio.expected * expected[i];
  }
}

GatherOptions gather_inside(const GatherOptions& gather, const InnerEffort& effort) {
  GatherOptions options = gather;
  options.rays = effort.rays;
  options.shadows.max_rays = std::min(options.shadows.max_rays, effort.rays);
  options.shadows.min_rays = std::min(options.shadows.min_rays, options.shadows.max_rays);
  options.replica += effort.replica;
  return options;
}

}  // namespace

Eigen::Vector3d inner_position(const PatchMesh& mesh, int element, int k) {
  const std::array<double, 4> weights = corner_weights(mesh, element, k);
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  for (int c = 0; c < mesh.corner_count(element); ++c) {
    at += weights[static_cast<std::size_t>(c)] * mesh.position(mesh.corners[element][c]);
  }
  return at;
}

void measure_inside(const LitScene& lit, const GatherOptions& gather,
                    const RadiositySolution& solution, const InnerEffort& effort,
                    std::vector<InnerError>& elements) {
  const PatchMesh& mesh = lit.mesh();
  BandArray irradiance = solution.irradiance();
  const Eigen::ArrayXd reference = error_references(mesh, irradiance, solution.parts);
  std::erase_if(elements, [&](const InnerError& of) { return !(reference[of.element] > 0.0); });
  if (elements.empty()) return;
  std::vector<double> expected;
  for (const InnerError& element : elements) {
    expected.push_back(expected_square(mesh, irradiance, reference, element.element));
  }
  const auto all = static_cast<int>(elements.size());
  const int most =
      std::min(effort.most, elements_in_budget(effort.rays, lit.direct_light.light_count()));
  const int step = std::max(1, (all + most - 1) / most);
  const int measured = (all + step - 1) / step;
  BandArray own;
  if (!effort.radiosity) own = gatherable_radiosity(lit, irradiance, solution.direct_irradiance);
  const BandArray& radiosity = effort.radiosity ? *effort.radiosity : own;
  if (solution.caustic_irradiance.size() > 0) irradiance -= solution.caustic_irradiance;
  const auto of = [&](int i) -> InnerError& {
    return elements[static_cast<std::size_t>(step) * static_cast<std::size_t>(i)];
  };
  const GatherPoints points(inner_point_count * measured, [&](int i) {
    const int e = of(i / inner_point_count).element;
    return GatherPoint{.position = inner_position(mesh, e, i % inner_point_count),
                       .normal = element_center(mesh, e).normal,
                       .facet = mesh.facet[e]};
  });
  const GatheredIrradiance found =
      gather_irradiance(lit, radiosity, points, gather_inside(gather, effort));
  for (int i = 0; i < measured; ++i) {
    double square = 0.0;
    for (int k = 0; k < inner_point_count; ++k) {
      const Eigen::Index row = inner_point_count * i + k;
      const Spectrum E = (found.direct.row(row) + found.indirect.row(row)).transpose();
      square += squared_error(mesh, irradiance, of(i), k, E) / inner_point_count;
      if (!effort.counts_noise) square -= double{found.variance[row]} / inner_point_count;
    }
    of(i).square = std::max(square, 0.0) / std::pow(reference[of(i).element], 2);
  }
  spread_to_surfaces(mesh, expected, elements);
}

void raise_to_measured(const std::vector<InnerError>& elements, RadiositySolution& solution) {
  for (const auto& [element, square] : elements) {
    float& error = solution.interpolation_error[element];
    error = std::max(error, static_cast<float>(std::sqrt(std::max(square, 0.0))));
  }
}

}  // namespace lightwell
