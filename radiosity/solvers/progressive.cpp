#include "radiosity/solvers/progressive.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "mesh/patches/translucency.h"
#include "radiosity/form_factors/ray_cast_rows.h"
#include "radiosity/journal/journal_phase.h"
#include "radiosity/solvers/mirrored_shares.h"
#include "radiosity/solvers/solve_channels.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr int fewest_round_rays = 16, least_round = 16;

enum Energy { emitted_row, absorbed_row, escaped_row, unshot_row };  // rows of BandEnergy

// Power of a patch, W: absolute values summed over all bands.
double power(const PatchMesh& mesh, const BandArray& radiosity, int patch) {
  return mesh.area[patch] * radiosity.row(patch).abs().cast<double>().sum();
}

}  // namespace

ShotRows cast_shots(const ElementCaster& caster, const LightPaths& paths, int most_rays) {
  struct Casting {
    RowCaster rows;
    std::mutex mutex{};
    // Reused, since its size is that of the mesh.
    std::vector<std::unique_ptr<RowCaster::Scratch>> idle{};
  };
  const auto casting = std::make_shared<Casting>(RowCaster(caster, paths, most_rays));
  const PatchMesh& mesh = caster.mesh();
  return [casting, &mesh](std::span<const RowRequest> requests, std::span<EstimatedRow> rows) {
    parallel_for(static_cast<int>(requests.size()), 1, [&](int begin, int end) {
      std::unique_ptr<RowCaster::Scratch> scratch;
      {
        const std::lock_guard lock(casting->mutex);
        if (!casting->idle.empty()) {
          scratch = std::move(casting->idle.back());
          casting->idle.pop_back();
        }
      }
      if (!scratch) scratch = std::make_unique<RowCaster::Scratch>(mesh);
      for (int k = begin; k < end; ++k) {
        rows[k] = casting->rows.cast(requests[k].patch, requests[k].rays, *scratch);
      }
      const std::lock_guard lock(casting->mutex);
      casting->idle.push_back(std::move(scratch));
    });
  };
}

ShotRows stored_shots(const FormFactors& form_factors) {
  return [&form_factors](std::span<const RowRequest> requests, std::span<EstimatedRow> rows) {
    for (std::size_t k = 0; k < requests.size(); ++k) {
      const int i = requests[k].patch;
      const std::span<const FormFactor> direct = form_factors.row(i);
      const SpecularRow specular = form_factors.specular_row(i);
      rows[k] = {.shares = {direct.begin(), direct.end()},
                 .specular_patch = {specular.patch.begin(), specular.patch.end()},
                 .specular_share = specular.value,
                 .specular_escaped = form_factors.escaped(i),
                 .absorbed = form_factors.absorbed_by_specular(i),
                 .cut = Spectrum::Zero(form_factors.escaped(i).size())};
    }
  };
}

ProgressiveRadiosity::ProgressiveRadiosity(const Scene& scene, const PatchMesh& mesh, ShotRows rows,
                                           const ProgressiveOptions& options,
                                           const EmitterChannels& channels,
                                           const FreeLight& free_light)
    : scene_(scene),
      mesh_(mesh),
      rows_(std::move(rows)),
      options_(options),
      channels_(channels),
      radiosity_(emission_columns(mesh, channels)),
      unshot_(radiosity_),
      energy_(BandEnergy::Zero(4, radiosity_.cols())) {
  Eigen::ArrayXd reflected = Eigen::ArrayXd::Zero(mesh.reflectance.cols());
  for (int i = 0; i < mesh.patch_count(); ++i) {
    if (!(mesh.area[i] > 0.0)) {
      throw std::invalid_argument(fmt::format("patch {} has area {}", i, mesh.area[i]));
    }
    reflected += mesh.area[i] * scattered_share(mesh, i).cast<double>();
    energy_.row(emitted_row) += mesh.area[i] * radiosity_.row(i).cast<double>();
  }
  if (!free_light.empty()) take_in(free_light);
  emitted_ = energy_.row(emitted_row).sum();
  // A bound on the sum of reflections in a room without losses.
  constexpr double most_reflected = 0.99;
  reflections_ = (1.0 / (1.0 - (reflected / mesh.area.sum()).min(most_reflected))).cast<float>();
}

void ProgressiveRadiosity::take_in(const FreeLight& free_light) {
  const Eigen::Index bands = mesh_.emission.cols();
  MirroredShares mirrored(scene_, mesh_, unshot_.cols());
  for (int i = 0; mirrored.has_coats() && i < mesh_.patch_count(); ++i) {
    mirrored.arrive(mesh_.area[i] * free_light.irradiance.row(i).transpose().cast<double>(), i);
  }
  mirrored.lose(free_light.absorbed + free_light.escaped - free_light.emitted);
  mirrored.settle();
  for (int i = 0; i < mesh_.patch_count(); ++i) {
    for (Eigen::Index k = 0; k < unshot_.cols(); ++k) {
      const float E = free_light.irradiance(i, k);
      energy_(absorbed_row, k) +=
          mesh_.area[i] * double{E} * mirrored.kept(i, k, scatter(i, k, k % bands, E));
    }
  }
  free_energy_ = free_energy(free_light);
  energy_.row(emitted_row) += free_light.emitted.transpose();
  energy_.row(absorbed_row) += free_light.absorbed.transpose();
  energy_.row(escaped_row) += free_light.escaped.transpose();
}

double ProgressiveRadiosity::unshot_share() const {
  if (!(emitted_ > 0.0)) return 0.0;
  double sum = 0.0;
  for (int i = 0; i < mesh_.patch_count(); ++i) sum += power(mesh_, unshot_, i);
  return sum / emitted_;
}

double ProgressiveRadiosity::done() const {
  const double unshot = unshot_share();
  if (unshot <= options_.tolerance) return 1.0;
  return std::clamp(std::log(unshot) / std::log(options_.tolerance), 0.0, 1.0);
}

Eigen::ArrayXf ProgressiveRadiosity::ambient() const {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(unshot_.cols());
  for (int i = 0; i < mesh_.patch_count(); ++i) {
    sum += mesh_.area[i] * unshot_.row(i).transpose().cast<double>();
  }
  return for_each_channel(reflections_, unshot_.cols()) * (sum / mesh_.area.sum()).cast<float>();
}

BandEnergy ProgressiveRadiosity::energy_by_column() const {
  BandEnergy energy = energy_;
  for (int i = 0; i < mesh_.patch_count(); ++i) {
    energy.row(unshot_row) += mesh_.area[i] * unshot_.row(i).cast<double>();
  }
  return energy;
}

EnergyBalance ProgressiveRadiosity::energy() const {
  return total(energy_by_column(), free_energy_);
}

RadiositySolution ProgressiveRadiosity::solution() const {
  RadiositySolution solution;
  solution.solver = "progressive";
  const auto bands = static_cast<int>(mesh_.emission.cols());
  solution.patch_radiosity = channel_sum(radiosity_, bands);
  const BandEnergy energy = energy_by_column();
  solution.energy = total(energy, free_energy_);
  const double largest = solution.patch_radiosity.abs().maxCoeff();
  const double left = channel_sum(unshot_.abs(), bands).maxCoeff();
  solution.residual = largest > 0.0 ? left / largest : 0.0;
  solution.outcome = has_converged() ? Outcome::converged : Outcome::max_sweeps_reached;
  if (channels_.empty()) return solution;
  name_channels(scene_, mesh_, channels_, solution);
  split_columns(radiosity_, &LightChannel::patch_radiosity, solution.channels);
  for (std::size_t c = 0; c < solution.channels.size(); ++c) {
    const Eigen::Index first = static_cast<Eigen::Index>(c) * bands;
    solution.channels[c].energy = energy.middleCols(first, bands);
    if (free_energy_.size() == 0) continue;
    solution.channels[c].free_energy = free_energy_.middleCols(first, bands);
  }
  return solution;
}

bool ProgressiveRadiosity::step(int most) {
  if (shots_ >= options_.max_shots || has_converged()) return false;
  const std::vector<int> chosen = choose(std::max(most, 1));
  const auto foreseen = options_.overshooting == Overshooting::ambient
                            ? ambient()
                            : Eigen::ArrayXf::Zero(unshot_.cols());
  std::vector<RowRequest> requests;
  last_shots_.clear();
  for (const int i : chosen) {
    requests.push_back({i, rays_of(i)});
    const Eigen::ArrayXf more =
        for_each_channel(scattered_share(mesh_, i), unshot_.cols()) * foreseen.max(0.0f);
    last_shots_.push_back({i, unshot_.row(i).transpose() + more});
  }
  std::vector<EstimatedRow> rows(requests.size());
  rows_(requests, rows);
  for (const Shot& shot : last_shots_) unshot_.row(shot.patch) -= shot.radiosity.transpose();
  for (std::size_t k = 0; k < rows.size(); ++k) receive(last_shots_[k], rows[k]);
  shots_ += static_cast<int>(chosen.size());
  if (!unshot_.allFinite()) {
    throw std::runtime_error(
        "The radiosities are no longer finite numbers; please report the scene.");
  }
  return true;
}

// Patches of most unshot power first; equal ones in ascending order.
std::vector<int> ProgressiveRadiosity::choose(int most) const {
  std::vector<std::pair<double, int>> order;
  for (int i = 0; i < mesh_.patch_count(); ++i) {
    const double unshot = power(mesh_, unshot_, i);
    if (unshot > 0.0) order.emplace_back(-unshot, i);
  }
  const int round = std::max(least_round, mesh_.patch_count() / 128);
  const auto wanted =
      static_cast<std::size_t>(std::min({round, most, options_.max_shots - shots_}));
  const std::size_t count = std::min(wanted, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  std::vector<int> chosen;
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(order[k].second);
  return chosen;
}

int ProgressiveRadiosity::rays_of(int patch) const {
  const double wanted = options_.rays * power(mesh_, unshot_, patch) / emitted_;
  const int most = std::max(options_.most_rays, fewest_round_rays);
  const auto rays = static_cast<unsigned>(std::clamp<double>(wanted, fewest_round_rays, most));
  return static_cast<int>(std::bit_floor(rays));
}

// Shares that surfaces mirror of the light of a row.
MirroredShares ProgressiveRadiosity::mirrored_of(const EstimatedRow& row) const {
  MirroredShares mirrored(scene_, mesh_, mesh_.emission.cols());
  if (!mirrored.has_coats()) return mirrored;
  const Eigen::Index bands = mesh_.emission.cols();
  for (const auto& [j, share] : row.shares) {
    mirrored.arrive(Eigen::ArrayXd::Constant(bands, double{share}), j);
  }
  for (std::size_t s = 0; s < row.specular_patch.size(); ++s) {
    mirrored.arrive(row.specular_share.row(static_cast<Eigen::Index>(s)).transpose().cast<double>(),
                    row.specular_patch[s]);
  }
  mirrored.lose((row.specular_escaped + row.absorbed + row.cut).cast<double>() + row.escaped +
                row.specular - 1.0);
  mirrored.settle();
  return mirrored;
}

// Adds what patch j scatters of an irradiance to both of its sides. Returns the share.
float ProgressiveRadiosity::scatter(int j, Eigen::Index column, Eigen::Index band, float E) {
  const auto add = [&](int patch, float share) {
    const float sent_on = share * E;
    radiosity_(patch, column) += sent_on;
    unshot_(patch, column) += sent_on;
    return share;
  };
  const float reflected = add(j, mesh_.reflectance(j, band));
  const int behind = mesh_.patch_behind(j);
  return behind < 0 ? reflected : reflected + add(behind, mesh_.transmittance(behind, band));
}

void ProgressiveRadiosity::receive(const Shot& shot, const EstimatedRow& row) {
  const Eigen::ArrayXd watts = mesh_.area[shot.patch] * shot.radiosity.cast<double>();
  const Eigen::Index columns = unshot_.cols(), bands = mesh_.emission.cols();
  const MirroredShares mirrored = mirrored_of(row);
  // share_of(band): share of the shot light that arrives at patch j.
  const auto arrive = [&](int j, auto&& share_of) {
    for (Eigen::Index k = 0; k < columns; ++k) {
      const Eigen::Index band = k % bands;
      const double arriving = watts[k] * static_cast<double>(share_of(band));
      const float scattered = scatter(j, k, band, static_cast<float>(arriving / mesh_.area[j]));
      energy_(absorbed_row, k) += arriving * mirrored.kept(j, band, scattered);
    }
  };
  for (const auto& [j, share] : row.shares) {
    arrive(j, [&, s = share](Eigen::Index) { return s; });
  }
  for (std::size_t s = 0; s < row.specular_patch.size(); ++s) {
    const auto at = static_cast<Eigen::Index>(s);
    arrive(row.specular_patch[s], [&](Eigen::Index band) { return row.specular_share(at, band); });
  }
  for (Eigen::Index k = 0; k < columns; ++k) {
    const Eigen::Index band = k % bands;
    energy_(escaped_row, k) +=
        watts[k] * (static_cast<double>(row.specular_escaped[band]) + row.escaped);
    energy_(absorbed_row, k) += watts[k] * static_cast<double>(row.absorbed[band] + row.cut[band]);
  }
}

RadiositySolution shoot_to_the_end(ProgressiveRadiosity& progressive, const Progress& progress,
                                   JournalPhase* phase) {
  const auto start = std::chrono::steady_clock::now();
  double residual = 0.0;
  std::vector<StepRecord> history;
  JournalPhase none;
  JournalPhase& kept = phase ? *phase : none;
  kept.recall_state(progressive.state(), residual, history);
  const auto keep = [&] { kept.keep_state(progressive.state(), residual, history); };
  while (progressive.step()) {
    residual = progressive.unshot().abs().maxCoeff() / progressive.radiosity().abs().maxCoeff();
    history.push_back(
        {.residual = residual,
         .seconds =
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
    try {
      report(progress, "solve", progressive.done());
    } catch (const Interrupted&) {
      keep();
      throw;
    }
    if (kept.is_state_due()) keep();
  }
  if (kept.has_state()) keep();
  report(progress, "solve", 1.0);
  RadiositySolution solution = progressive.solution();
  solution.history = std::move(history);
  return solution;
}

}  // namespace lightwell
