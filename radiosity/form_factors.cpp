#include "radiosity/form_factors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "radiosity/analytic_exchange.h"
#include "radiosity/emitter_exchange.h"
#include "radiosity/form_factor_assembly.h"
#include "radiosity/hemicube.h"
#include "radiosity/light_path.h"
#include "radiosity/near_exchange.h"
#include "radiosity/ray_cast_rows.h"

namespace lightwell {
namespace {

// What a method finds out before the rows are joined.
struct Estimate {
  std::vector<EstimatedRow> rows{};
  KnownExchange known{};
  std::vector<float> row_error{};
};

class Estimator {
 public:
  Estimator(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
            const FormFactorOptions& options)
      : mesh_(caster.mesh()),
        caster_(caster),
        direct_light_(direct_light),
        options_(options),
        paths_(scene, caster, options.max_specular_depth) {
    for (int i = 0; i < mesh_.patch_count(); ++i) {
      receives_.push_back(paths_.is_diffuse(mesh_.facet[i]));
    }
  }

  Estimate estimate() const {
    switch (options_.method) {
      case FormFactorMethod::ray_cast:
        return rays_alone();
      case FormFactorMethod::hemicube:
        return {.rows = hemicube_rows(caster_, paths_, {.resolution = options_.hemicube_resolution},
                                      options_.progress)};
      case FormFactorMethod::analytic:
        return closed_forms_alone();
      case FormFactorMethod::automatic:
        break;
    }
    return all_pairs_are_cheap() ? closed_forms_alone() : rays_and_closed_forms();
  }

 private:
  // Where an accuracy is asked for, closed forms of all pairs beat rays up to a few thousand
  // patches.
  bool all_pairs_are_cheap() const {
    constexpr double pair_in_rays = 16.0;  // what a pair costs
    return options_.target_error > 0.0 &&
           0.5 * pair_in_rays * mesh_.patch_count() < 4.0 * base_rays();
  }

  // As many as the target takes in rows where nothing is partly hidden.
  int base_rays() const {
    const int asked = std::max(1, options_.rays_per_patch);
    if (!(options_.target_error > 0.0)) return asked;
    const double needed = NearExchange::worst_count_error / options_.target_error;
    const double most = std::max(asked, options_.most_rays_per_patch);
    return std::max(
        asked,
        static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(std::min(needed, most))))));
  }
  int most_rays(int patch_rays) const {
    return options_.target_error > 0.0 ? std::max(patch_rays, options_.most_rays_per_patch)
                                       : patch_rays;
  }

  // Emitters cast more where mirrors and glass throw what they cast.
  std::vector<int> rays_of(const EmitterExchange& emitters, int base) const {
    std::vector<int> counts(static_cast<std::size_t>(mesh_.patch_count()), base);
    if (!paths_.has_specular()) return counts;
    for (int i = 0; i < mesh_.patch_count(); ++i) {
      const int e = emitters.emitter_of(i);
      if (e < 0) continue;
      const double share = mesh_.area[i] / direct_light_.emitters()[e].area;
      const auto wanted = static_cast<unsigned>(std::ceil(share * options_.rays_per_emitter));
      const auto even = static_cast<int>(std::bit_ceil(std::max(1u, wanted)));
      counts[i] = std::max(base, even);
    }
    return counts;
  }

  // Casts each row, with four times the rays while `error_of(i, row)` is above the target.
  template <class ErrorOf>
  Estimate cast(const std::vector<int>& rays_of, bool look_behind, ErrorOf error_of) const {
    const auto n = static_cast<std::size_t>(mesh_.patch_count());
    Estimate result{.rows = std::vector<EstimatedRow>(n), .row_error = std::vector<float>(n)};
    const int longest = *std::max_element(rays_of.begin(), rays_of.end());
    const RowCaster caster(caster_, paths_, most_rays(longest));
    for_each_row(mesh_, longest, options_.progress, [&](int i, RowCaster::Scratch& scratch) {
      for (int rays = rays_of[i];; rays *= 4) {
        result.rows[i] = caster.cast(i, rays, scratch, look_behind);
        const double error = error_of(i, result.rows[i]);
        result.row_error[i] = static_cast<float>(error);
        if (!(error > options_.target_error) || 4 * rays > most_rays(rays_of[i])) break;
      }
    });
    return result;
  }

  // Counts are binomial at worst; stratified points do better.
  Estimate rays_alone() const {
    const EmitterExchange emitters(caster_, direct_light_);
    return cast(rays_of(emitters, base_rays()), false, [](int, const EstimatedRow& row) {
      double worst = 0.0;
      for (const FormFactor& f : row.shares) {
        worst = std::max(worst, static_cast<double>(f.value * (1.0f - f.value)));
      }
      return row.rays > 0.0 ? std::sqrt(worst / row.rays) : 0.0;
    });
  }

  Estimate rays_and_closed_forms() const {
    const EmitterExchange emitters(caster_, direct_light_);
    const NearExchange near(mesh_);
    std::vector<std::vector<NearExchange::Pair>> pairs(
        static_cast<std::size_t>(mesh_.patch_count()));
    Estimate result =
        cast(rays_of(emitters, base_rays()), true, [&](int i, const EstimatedRow& row) {
          pairs[i].clear();
          return near.look(i, row, pairs[i]);
        });
    std::vector<NearExchange::Pair> all;
    for (auto& of_row : pairs) {
      for (const NearExchange::Pair& pair : of_row) {
        if (emitters.emitter_of(pair.i) < 0 && emitters.emitter_of(pair.j) < 0) all.push_back(pair);
      }
      of_row = {};
    }
    result.known = emitters.exchange(receives_, options_);
    const auto exchanged = near.exchange(std::move(all), options_.progress);
    result.known.S.insert(result.known.S.end(), exchanged.begin(), exchanged.end());
    return result;
  }

  // Rays still find what escapes, and what goes by way of mirrors and glass.
  Estimate closed_forms_alone() const {
    const EmitterExchange emitters(caster_, direct_light_);
    Estimate result = cast(rays_of(emitters, std::max(1, options_.rays_per_patch)), false,
                           [](int, const EstimatedRow&) { return 0.0; });
    const NearExchange near(mesh_);
    result.known = analytic_exchange(caster_, near.outlines(), receives_, options_.target_error,
                                     options_.progress, result.row_error);
    return result;
  }

  const PatchMesh& mesh_;
  const ElementCaster& caster_;
  const DirectLight& direct_light_;
  const FormFactorOptions& options_;
  LightPaths paths_;
  std::vector<char> receives_;
};

}  // namespace

FormFactorMethod form_factor_method(std::string_view name) {
  std::vector<std::string_view> names;
  for (const NamedFormFactorMethod& known : form_factor_methods) {
    if (known.name == name) return known.method;
    names.push_back(known.name);
  }
  throw std::invalid_argument(fmt::format("there is no form-factor method '{}'; there are {}", name,
                                          fmt::join(names, ", ")));
}

std::unique_ptr<FormFactors> compute_form_factors(const Scene& scene, const ElementCaster& caster,
                                                  const DirectLight& direct_light,
                                                  const FormFactorOptions& options,
                                                  FormFactorReport* report) {
  Estimate estimate = Estimator(scene, caster, direct_light, options).estimate();
  if (report) report->row_error = std::move(estimate.row_error);
  return assemble_form_factors(caster.mesh(), scene.bands.count(), std::move(estimate.rows),
                               estimate.known, options.enforce_closure, report);
}

}  // namespace lightwell
