#include "radiosity/solvers/solve_channels.h"

#include <algorithm>

#include "mesh/patches/translucency.h"
#include "radiosity/solvers/mirrored_shares.h"
#include "radiosity/solvers/patches_alone.h"

namespace lightwell {
namespace {

// Limit of solvers, because form factors are floats.
constexpr double least_tolerance = 1e-7;

BandArray emission_of(const PatchMesh& mesh, const std::vector<int>& patch_channel, int channel) {
  BandArray M = mesh.emission;
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    if (patch_channel[static_cast<std::size_t>(i)] != channel) M.row(i).setZero();
  }
  return M;
}

// Channel of each patch; -1: no emission.
std::vector<int> channels_of_patches(const PatchMesh& mesh, const EmitterChannels& channels) {
  std::vector<int> channel;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const bool emits = (mesh.emission.row(p) > 0.0f).any();
    channel.push_back(emits ? channels.of_surface[mesh.surface[p]] : -1);
  }
  return channel;
}

std::vector<std::string> surfaces_of(const Scene& scene, const EmitterChannels& channels,
                                     int channel) {
  std::vector<std::string> names;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    if (channels.of_surface[s] == channel) names.push_back(scene.surfaces[s].name);
  }
  for (std::size_t i = 0; i < channels.of_source.size(); ++i) {
    if (channels.of_source[i] != channel) continue;
    names.push_back(free_source_name(scene, static_cast<int>(i)));
  }
  return names;
}

}  // namespace

BandArray emission_columns(const PatchMesh& mesh, const EmitterChannels& channels) {
  if (channels.empty()) return mesh.emission;
  const Eigen::Index bands = mesh.emission.cols();
  const std::vector<int> channel = channels_of_patches(mesh, channels);
  BandArray M =
      BandArray::Zero(mesh.patch_count(), static_cast<Eigen::Index>(channels.names.size()) * bands);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const int c = channel[static_cast<std::size_t>(p)];
    if (c >= 0) M.row(p).segment(c * bands, bands) = mesh.emission.row(p);
  }
  return M;
}

Eigen::ArrayXf for_each_channel(const Spectrum& of_bands, Eigen::Index columns) {
  return of_bands.replicate(columns / of_bands.size(), 1);
}

void name_channels(const Scene& scene, const PatchMesh& mesh, const EmitterChannels& channels,
                   RadiositySolution& solution) {
  solution.patch_channel = channels_of_patches(mesh, channels);
  solution.source_channel = channels.of_source;
  solution.full_emission = mesh.emission;
  for (int c = 0; c < static_cast<int>(channels.names.size()); ++c) {
    solution.channels.push_back({.name = channels.names[static_cast<std::size_t>(c)],
                                 .surfaces = surfaces_of(scene, channels, c),
                                 .scale = Spectrum::Ones(mesh.emission.cols())});
  }
}

void solve_channels(const Scene& scene, const PatchMesh& mesh, const FormFactors& form_factors,
                    const FreeLight& free_light, const EmitterChannels& channels,
                    SolverMethod method, const SolverOptions& options,
                    RadiositySolution& solution) {
  const auto count = static_cast<int>(channels.names.size());
  const Eigen::Index bands = mesh.emission.cols();
  name_channels(scene, mesh, channels, solution);
  SolverOptions part = options;
  part.tolerance =
      std::max(options.tolerance / count, std::min(options.tolerance, least_tolerance));
  part.observer = {};
  double residual = 0.0;  // upper bound of the sum's residual, W/m^2
  PatchMesh lit = patches_alone(mesh);
  for (int c = 0; c < count; ++c) {
    lit.emission = emission_of(mesh, solution.patch_channel, c);
    const FreeLight arriving = of_channel(free_light, c, static_cast<int>(bands));
    part.arriving = arriving.irradiance;
    part.start.resize(0, 0);
    if (options.start.size() > 0) part.start = options.start.middleCols(c * bands, bands);
    RadiositySolution solved = solve_radiosity(method, lit, form_factors, part);
    residual += solved.residual * static_cast<double>(solved.patch_radiosity.maxCoeff());
    if (solved.outcome != Outcome::converged) solution.outcome = solved.outcome;
    LightChannel& channel = solution.channels[static_cast<std::size_t>(c)];
    channel.patch_radiosity = std::move(solved.patch_radiosity);
    channel.energy = band_energy(scene, lit, form_factors, channel.patch_radiosity, arriving);
    channel.free_energy = free_energy(arriving);
  }
  const auto largest = static_cast<double>(solution.patch_radiosity.maxCoeff());
  solution.residual = largest > 0.0 ? residual / largest : 0.0;
}

BandEnergy band_energy(const Scene& scene, const PatchMesh& mesh, const FormFactors& form_factors,
                       const BandArray& B, const FreeLight& free_light) {
  BandArray E = gather(form_factors, B);
  if (!free_light.empty()) E += free_light.irradiance;
  const BandArray scattered = scattered_by_patches(mesh, E);
  MirroredShares mirrored(scene, mesh, B.cols());
  for (int i = 0; i < mesh.patch_count(); ++i) {
    const Spectrum lost = (form_factors.absorbed_by_specular(i) + form_factors.escaped(i) - 1.0f) *
                          B.row(i).transpose();
    mirrored.lose(mesh.area[i] * lost.cast<double>());
    mirrored.arrive(mesh.area[i] * E.row(i).transpose().cast<double>(), i);
  }
  if (!free_light.empty()) {
    mirrored.lose(free_light.absorbed + free_light.escaped - free_light.emitted);
  }
  mirrored.settle();
  BandEnergy energy = BandEnergy::Zero(4, B.cols());
  for (int i = 0; i < mesh.patch_count(); ++i) {
    const double A = mesh.area[i];
    const Spectrum B_i = B.row(i).transpose(), E_i = E.row(i).transpose();
    const Spectrum M_i = mesh.emission.row(i).transpose(), share = scattered_share(mesh, i);
    Spectrum kept(B.cols());
    for (Eigen::Index k = 0; k < kept.size(); ++k) {
      kept[k] = static_cast<float>(mirrored.kept(i, k, share[k]));
    }
    const auto add = [&](int row, const Spectrum& per_area) {
      energy.row(row) += A * per_area.cast<double>().transpose();
    };
    add(0, M_i);
    add(1, kept * E_i + form_factors.absorbed_by_specular(i) * B_i);
    add(2, form_factors.escaped(i) * B_i);
    add(3, M_i + scattered.row(i).transpose() - B_i);
  }
  if (!free_light.empty()) {
    energy.row(0) += free_light.emitted.transpose();
    energy.row(1) += free_light.absorbed.transpose();
    energy.row(2) += free_light.escaped.transpose();
  }
  return energy;
}

FreeEnergy free_energy(const FreeLight& free_light) {
  if (free_light.empty()) return {};
  FreeEnergy energy(2, free_light.emitted.size());
  energy.row(0) = free_light.emitted.transpose();
  energy.row(1) = free_light.missed.transpose();
  return energy;
}

}  // namespace lightwell
