#include "radiosity/accuracy.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <optional>

#include "mesh/patches/translucency.h"
#include "radiosity/refine/effort.h"
#include "radiosity/refine/error_reference.h"

namespace lightwell {
namespace {

// Shares of the target error in the first attempt. The errors of interpolation and noise are
// independent, so their squares add up, here to 1.2. That is more than the target allows, because
// refinement ends between half of its tolerance and all of it; where the sum is too large, a later
// attempt adds to the first. Both shares were set with whole solves in view (docs/figures.md:
// "Rooms", "The error estimate").
constexpr double share_of_interpolation = 0.95, share_of_gather_noise = 0.55;
constexpr int most_attempts = 6;
// Share of the target that a later attempt aims at, so that an error which is a twentieth larger
// than foreseen takes no further one.
constexpr double share_of_target = 0.95;

// Rays to the dome for an error of 1 %, and the power of its inverse by which they grow: the noise
// of stratified rays falls with rays^(-3/4).
constexpr double sky_rays_for_one_percent = 2048.0, sky_rays_law = 4.0 / 3.0;

// Rays of a gather for an error of 1 %.
constexpr int rays_for_one_percent = 1024;

}  // namespace

double noise_share(double target) {
  return share_of_gather_noise * target;
}

namespace {

// Irradiance of a patch, W/m^2; a band that the patch absorbs whole takes the mean of its other
// bands. Sides of a sheet have the mean irradiance of both. Empty if nothing is scattered.
std::optional<Spectrum> patch_irradiance(const PatchMesh& mesh, const BandArray& patch_radiosity,
                                         int patch) {
  const Eigen::ArrayXf rho = scattered_share(mesh, patch);
  const double known = (rho > 0.0f).cast<double>().sum();
  if (!(known > 0.0)) return std::nullopt;
  const auto scattered = [&](int p) -> Eigen::ArrayXf {
    return (patch_radiosity.row(p) - mesh.emission.row(p)).transpose();
  };
  Eigen::ArrayXf reflected = scattered(patch);
  if (const int behind = mesh.patch_behind(patch); behind >= 0) {
    reflected = 0.5f * (reflected + scattered(behind));
  }
  const Spectrum E = (rho > 0.0f).select(reflected / rho.max(1e-30f), 0.0f);
  const auto mean = static_cast<float>(E.cast<double>().sum() / known);
  return (rho > 0.0f).select(E, mean);
}

}  // namespace

std::vector<double> mean_illuminances(const Bands& bands, const PatchMesh& mesh,
                                      const BandArray& patch_radiosity, const SceneParts& parts) {
  std::vector<double> sum(static_cast<std::size_t>(parts.judged_count()), 0.0), area(sum);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const auto E = patch_irradiance(mesh, patch_radiosity, p);
    if (!E) continue;
    const int part = parts.judged_with(p);
    sum[part] += mesh.area[p] * luminous(bands, *E);
    area[part] += mesh.area[p];
  }
  for (std::size_t q = 0; q < sum.size(); ++q) sum[q] = area[q] > 0.0 ? sum[q] / area[q] : 0.0;
  return sum;
}

std::vector<double> reference_irradiances(const PatchMesh& mesh, const BandArray& patch_radiosity,
                                          const SceneParts& parts) {
  PartMeans means(parts);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const auto E = patch_irradiance(mesh, patch_radiosity, p);
    if (E) means.add(p, mesh.area[p], E->cast<double>().mean());
  }
  means.finish();
  std::vector<double> references;
  for (int q = 0; q < parts.judged_count(); ++q) references.push_back(means.of_part(q));
  return references;
}

double mean_illuminance(const Bands& bands, const PatchMesh& mesh,
                        const BandArray& patch_radiosity) {
  return mean_illuminances(bands, mesh, patch_radiosity, {}).front();
}

ShadowOptions Effort::shadows(ManyLights many_lights) const {
  const int most = std::clamp(gather_rays / 4, 64, most_shadow_rays);
  // Clusters of 0.5 % leave noise of 0.35 % in a hall of 10 000 lamps, which beside 0.55 % of the
  // rays and 0.95 % of interpolation hardly counts. At the finest share, no more than DirectLight's
  // most parts are asked; at the coarsest, some 50 are.
  constexpr double for_one_percent = 0.005, finest = 1e-5, coarsest = 0.02;
  const double share =
      for_one_percent *
      std::pow(static_cast<double>(rays_for_one_percent) / gather_rays, noise_order);
  return {.min_rays = std::max(16, most / 8),
          .max_rays = most,
          .cluster_share = std::clamp(share, finest, coarsest),
          .many_lights = many_lights};
}

int sky_rays(double target) {
  constexpr double fewest = 128.0, most = 16384.0;
  const double rays = sky_rays_for_one_percent * std::pow(0.01 / target, sky_rays_law);
  return static_cast<int>(std::lround(std::clamp(rays, fewest, most)));
}

double target_of_sky_rays(int rays) {
  return 0.01 * std::pow(sky_rays_for_one_percent / rays, 1.0 / sky_rays_law);
}

int rays_worth(double left) {
  constexpr double of_the_error = 1.0 / 6.0;
  constexpr unsigned fewest = 256;
  const int enough = rays_for_noise(rays_for_one_percent, 0.01, of_the_error * left);
  return std::min(rays_by_default,
                  static_cast<int>(std::max(fewest, std::bit_ceil(static_cast<unsigned>(enough)))));
}

Effort first_effort(double target, bool refines) {
  return {.refine_tolerance = refines ? share_of_interpolation * target : 0.0,
          .gather_rays = rays_for_noise(rays_for_one_percent, 0.01, target)};
}

namespace {

// A step between two attempts.
struct Step {
  double rays = 1.0;      // times those of the attempt before
  double elements = 1.0;  // error of interpolation over that before; 1: no element is split
};

// The error of interpolation after a split, over that before. An attempt repeats the gather and the
// estimate whole, so that a smaller step than to 80 %, which takes up to twice the elements, would
// cost nearly as much. A larger one than to 60 %, with up to five times the elements, trusts the
// estimates of the attempt before too far.
constexpr double largest_split = 0.6, smallest_split = 0.8;

// The cheapest step after which the squared errors of noise and of elements add up to no more than
// `allowed`, with no more than `most_times` the rays. Empty if there is none. Costs are in units of
// the attempt's final gather:
// - Pilot gathers and shadow rays of split elements take 2. Measured: 0.8 in the Cornell box, and 3
//   in a hall of 4634 patches.
// - The elements grow with error^(-3). Measured for 4.6 and 3.6 % in that hall: 124 and 245
//   thousand, which is error^(-2.8). In smooth light they grow with error^(-1), and at the edges of
//   shadows with error^(-2).
std::optional<Step> cheapest_step(double allowed, double noise, double of_elements,
                                  double most_times) {
  constexpr double of_refinement = 2.0, growth = 3.0;
  std::optional<Step> best;
  double least = 0.0;
  for (const double rays : {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0}) {
    const double left = allowed - std::pow(noise * std::pow(rays, -noise_order), 2);
    const double share = std::sqrt(std::max(left, 0.0)) / of_elements;
    if (share < largest_split || rays > most_times) continue;
    const double elements = share < 1.0 ? std::min(share, smallest_split) : 1.0;
    const double cost =
        elements < 1.0 ? std::pow(elements, -growth) * (of_refinement + rays) : rays;
    if (best && cost >= least) continue;
    best = {rays, elements};
    least = cost;
  }
  return best;
}

}  // namespace

std::optional<Effort> next_effort(const Effort& spent, double target, double error,
                                  double noise_estimate, const RefineReport& refinement,
                                  int attempt) {
  // A few vertices that hardly any ray leaves may claim many times the noise that there is.
  const double noise = std::min(noise_estimate, error);
  const bool can_split = refinement.outcome == RefineOutcome::tolerance_reached;
  if (attempt + 1 >= most_attempts || (!can_split && refinement.estimate >= target)) {
    return std::nullopt;
  }
  const double without = std::sqrt(std::max(error * error - noise * noise, 0.0));
  if (!can_split && without >= target) return std::nullopt;
  // The error left beside an independent `other` if both together are share_of_target.
  const auto beside = [target](double other) {
    constexpr double least = 0.1;
    return std::sqrt(
        std::max(std::pow(share_of_target * target, 2) - other * other, least * target * target));
  };
  Effort next = spent;
  const double noise_goal = can_split ? share_of_gather_noise * target : beside(without);
  // Half more rays leave 1.5^(-2/3) = 76 % of the noise.
  constexpr double least_times = 1.5;
  constexpr int most_times = 16;  // the estimate of the noise may be far too high by chance
  if (noise > noise_goal) {
    const int wanted = rays_for_noise(spent.gather_rays, noise, noise_goal);
    if (wanted > spent.gather_rays) {
      next.gather_rays = std::clamp(wanted, static_cast<int>(least_times * spent.gather_rays),
                                    most_times * spent.gather_rays);
    }
  }
  const double goal = beside(std::min(noise, noise_goal));
  if (can_split && without > goal) {
    // The error of interpolation that refinement estimates, which may be below its tolerance.
    const double reached =
        std::clamp(refinement.estimate, 0.5 * spent.refine_tolerance, spent.refine_tolerance);
    // The rest of the error is one that no splitting reduces, such as at points between two sheets.
    // Elements and rays get what it leaves of the error that is allowed.
    const double of_elements = std::min(reached, without);
    const double besides = without * without - of_elements * of_elements;
    const double allowed = std::pow(share_of_target * target, 2) - besides;
    const double most = std::max(1.0, static_cast<double>(most_gather_rays) / spent.gather_rays);
    const auto step = cheapest_step(allowed, noise, of_elements, most);
    if (step) next.gather_rays = static_cast<int>(std::lround(step->rays * spent.gather_rays));
    const double elements = step ? step->elements : largest_split;
    if (elements < 1.0) next.refine_tolerance = elements * reached;
  }
  const bool is_more =
      next.gather_rays > spent.gather_rays || next.refine_tolerance < spent.refine_tolerance;
  return is_more ? std::optional(next) : std::nullopt;
}

}  // namespace lightwell
