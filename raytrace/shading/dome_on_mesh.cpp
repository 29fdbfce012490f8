#include "raytrace/shading/dome_on_mesh.h"

#include <algorithm>

#include "radiosity/emitters/free_source.h"
#include "radiosity/refine/error_reference.h"

namespace lightwell {
namespace {

// Returns whether no light but source number `dome` belongs to its channel.
bool is_alone_in_channel(const PatchMesh& mesh, const RadiositySolution& solution, int dome) {
  const int channel = solution.source_channel[dome];
  if (channel < 0 || std::ranges::count(solution.source_channel, channel) != 1) return false;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (solution.patch_channel[p] == channel) return false;
  }
  return true;
}

BandArray irradiance_of_dome(const PatchMesh& mesh, const DirectLight& direct_light,
                             const RadiositySolution& solution) {
  const FreeSource* const dome = direct_light.dome();
  if (!dome) return {};
  if (direct_light.light_count() == 1) return solution.direct_irradiance;
  if (solution.channels.empty() || !is_alone_in_channel(mesh, solution, dome->number)) return {};
  const LightChannel& channel =
      solution.channels[static_cast<std::size_t>(solution.source_channel[dome->number])];
  return channel.direct_irradiance.rowwise() * channel.scale.transpose();
}

bool is_even_over(const PatchMesh& mesh, const BandArray& E, int element) {
  float least = 0.0f, most = 0.0f;
  for (int c = 0; c < mesh.corner_count(element); ++c) {
    const float here = E.row(mesh.corners[element][c]).mean();
    least = c == 0 ? here : std::min(least, here);
    most = std::max(most, here);
  }
  return most > 0.0f && most - least <= DomeOnMesh::even * most;
}

// Mean of the corners and the bands, W/m^2.
double mean_over(const PatchMesh& mesh, const BandArray& E, int element) {
  const int n = mesh.corner_count(element);
  double sum = 0.0;
  for (int c = 0; c < n; ++c) sum += E.row(mesh.corners[element][c]).cast<double>().mean();
  return sum / n;
}

// RMS error of the light of a patch's part, relative to its mean irradiance, up to `most`.
double error_of_part(const RadiositySolution& solution, int patch, double most) {
  const auto part = static_cast<std::size_t>(solution.parts.judged_with(patch));
  const double estimate = part < solution.parts.parts.size()
                              ? solution.parts.parts[part].error_estimate
                              : solution.error_estimate;
  return std::clamp(estimate, 0.0, most);
}

/// Power that arrives on all elements, W, mean of the bands, of irradiance at the vertices.
double arriving_power(const PatchMesh& mesh, const BandArray& E) {
  double sum = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e)
    sum += mesh.element_area[e] * mean_over(mesh, E, e);
  return sum;
}

/// Factor of the relative error of the dome's light since the solve: errors are relative to the
/// mean irradiance, of which the dome may now be more or less.
float growth_of_error(const PatchMesh& mesh, const RadiositySolution& solution, int dome) {
  if (solution.channels.empty()) return 1.0f;
  BandArray solved = BandArray::Zero(solution.direct_irradiance.rows(), solution.bands.count());
  for (const LightChannel& channel : solution.channels) {
    solved += channel.direct_irradiance + channel.indirect_irradiance;
  }
  const double now = arriving_power(mesh, solution.irradiance());
  if (!(now > 0.0)) return 1.0f;
  const auto channel = static_cast<std::size_t>(solution.source_channel[dome]);
  const double of_dome = double{solution.channels[channel].scale.mean()};
  return static_cast<float>(of_dome * arriving_power(mesh, solved) / now);
}

}  // namespace

DomeOnMesh dome_on_mesh(const PatchMesh& mesh, const DirectLight& direct_light,
                        const RadiositySolution& solution, double indirect_error) {
  if (solution.interpolation_error.size() != mesh.element_count()) return {};
  DomeOnMesh dome{.irradiance = irradiance_of_dome(mesh, direct_light, solution)};
  if (dome.irradiance.size() == 0) return {};
  const float growth = growth_of_error(mesh, solution, direct_light.dome()->number);
  const BandArray irradiance = solution.irradiance();
  const Eigen::ArrayXd reference = error_references(mesh, irradiance, solution.parts);
  dome.excess.resize(static_cast<std::size_t>(mesh.element_count()));
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double own = mean_over(mesh, irradiance, e);
    const double as_good =
        error_of_part(solution, mesh.patch[e], indirect_error) * own / reference[e];
    float allowed = std::max(DomeOnMesh::small_error, static_cast<float>(as_good));
    if (is_even_over(mesh, dome.irradiance, e)) allowed = std::max(allowed, DomeOnMesh::most_error);
    dome.excess[static_cast<std::size_t>(e)] = growth * solution.interpolation_error[e] / allowed;
  }
  return dome;
}

}  // namespace lightwell
