#include "radiosity/form_factors/form_factors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "mesh/patches/area_shares.h"
#include "mesh/patches/patch_sampler.h"
#include "radiosity/emitters/emitter.h"
#include "radiosity/form_factors/analytic_exchange.h"
#include "radiosity/form_factors/emitter_exchange.h"
#include "radiosity/form_factors/form_factor_assembly.h"
#include "radiosity/form_factors/hemicube.h"
#include "radiosity/form_factors/near_exchange.h"
#include "radiosity/form_factors/ray_cast_rows.h"
#include "radiosity/form_factors/row_estimates.h"
#include "radiosity/form_factors/transport.h"
#include "radiosity/journal/journal_phase.h"
#include "radiosity/openings/portals.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/paths/mirrored_shares_of_patches.h"
#include "radiosity/paths/squared_indices.h"
#include "radiosity/visibility/pair_shafts.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

// Estimate of one method, before the two ends of each pair are joined.
struct Estimate {
  RowEstimates rows;
  KnownExchange known;
  std::vector<float> row_error{}, row_bias{};
};

// Adds all inputs on which form factors depend. Of reflectance only the signs matter, and of
// emission, where no emitters are clustered by what they give.
void add_form_factor_inputs(Fingerprint& print, const Scene& scene, const DirectLight& direct_light,
                            const PatchMesh& mesh, const FormFactorOptions& options) {
  print.add_geometry(mesh);
  // Brightness determines which emitters have closed forms, and their order.
  for (const Emitter& emitter : direct_light.emitters()) {
    print.add(emitter.facet);
    if (emitter.picture) print.add(1);
    if (direct_light.has_emitter_clusters()) print.add(emitter.exitance);
  }
  for (const Material& material : scene.materials) {
    print.add(material.is_diffuse());
    print.add(material.regular_transmittance);
    print.add(material.is_emitter());
    print.add(material.one_sided);
    print.add(material.emits_both_sides);
    print.add(material.specular);
    print.add(material.specular_roughness);
    print.add(material.coat ? material.coat->index_of_refraction : 0.0f);
    if (material.pattern) print.add(material_hash(material));
    if (material.metal) print.add(material.metal->eta);
    if (material.metal) print.add(material.metal->k);
    print.add(material.dielectric.has_value());
    if (!material.dielectric) continue;
    const auto& [index_of_refraction, tint, absorption, roughness, thin, transmissivity] =
        *material.dielectric;
    print.add(index_of_refraction);
    print.add(tint);
    print.add(absorption);
    print.add(roughness);
    print.add(thin);
    print.add(transmissivity);
  }
  // Memory and the run decide no bit of a result.
  const auto& [method, rays_per_patch, has_rays_by_area, target_error, most_rays_per_patch,
               rays_per_emitter, max_specular_depth, emitter_points, shadows, portals,
               hemicube_resolution, enforce_closure, memory, run] = options;
  const auto& [min_shadow_rays, max_shadow_rays, sky_rays, cluster_share, many_lights] = shadows;
  print.add(method);
  print.add(rays_per_patch);
  print.add(has_rays_by_area);
  print.add(target_error);
  print.add(most_rays_per_patch);
  print.add(rays_per_emitter);
  print.add(max_specular_depth);
  print.add(emitter_points);
  print.add(min_shadow_rays);
  print.add(max_shadow_rays);
  print.add(sky_rays);
  print.add(cluster_share);
  print.add(many_lights);
  // Portals follow from the scene and its light.
  print.add(portals ? portals->size() : 0);
  print.add(hemicube_resolution);
  print.add(enforce_closure);
}

class Estimator {
 public:
  Estimator(const LitScene& lit, const FormFactorOptions& options,
            std::shared_ptr<MemoryBudget> budget)
      : scene_(lit.scene),
        mesh_(lit.mesh()),
        budget_(std::move(budget)),
        caster_(lit.caster),
        direct_light_(lit.direct_light),
        options_(options),
        paths_(lit.scene, lit.caster, options.max_specular_depth) {
    for (int i = 0; i < mesh_.patch_count(); ++i) {
      // Closed forms know nothing of absorption: rays find the light within absorbing bodies.
      receives_.push_back(paths_.is_diffuse(mesh_.facet[mesh_.first_element[i]]) &&
                          !paths_.dims_before(i));
    }
  }

  // Shares that receiving patches mirror or pass straight on; empty: none does.
  BandArray mirrored() const {
    BandArray shares = mirrored_shares(scene_, mesh_);
    for (int i = 0; i < mesh_.patch_count(); ++i) {
      if (!paths_.is_diffuse(mesh_.facet[mesh_.first_element[i]])) shares.row(i).setZero();
    }
    return (shares > 0.0f).any() ? shares : BandArray();
  }

  Estimate estimate() const {
    switch (options_.method) {
      case FormFactorMethod::ray_cast:
        return rays_alone();
      case FormFactorMethod::hemicube:
        return hemicubes_alone();
      case FormFactorMethod::analytic:
        return closed_forms_alone();
      case FormFactorMethod::automatic:
        break;
    }
    return all_pairs_are_cheap() ? closed_forms_alone() : rays_and_closed_forms();
  }

 private:
  // With a target error, closed forms of all pairs are faster than rays up to a few thousand
  // patches.
  bool all_pairs_are_cheap() const {
    constexpr double pair_in_rays = 16.0;  // cost of a pair, in rays
    return options_.target_error > 0.0 &&
           0.5 * pair_in_rays * mesh_.patch_count() < 4.0 * base_rays();
  }

  // Initial rays per patch: with a target error, as many as rows without partly hidden patches
  // need.
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

  // Rays per patch: `base`, or fewer by area, and more for emitters in scenes with mirrors or
  // glass.
  std::vector<int> rays_of(const EmitterExchange& emitters, int base) const {
    constexpr int most_times = 16;  // fewer
    std::vector<int> counts(static_cast<std::size_t>(mesh_.patch_count()), base);
    if (options_.has_rays_by_area && !(options_.target_error > 0.0)) {
      counts = samples_by_area(scene_, mesh_, base, most_times);
    }
    if (!paths_.has_specular()) return counts;
    for (int i = 0; i < mesh_.patch_count(); ++i) {
      const int e = emitters.emitter_of(i);
      if (e < 0) continue;
      const double share = mesh_.area[i] / direct_light_.emitters()[e].area;
      const auto wanted = static_cast<unsigned>(std::ceil(share * options_.rays_per_emitter));
      const auto even = static_cast<int>(std::bit_ceil(std::max(1u, wanted)));
      counts[i] = std::max(counts[i], even);
    }
    return counts;
  }

  Estimate nothing_yet() const {
    const int n = mesh_.patch_count();
    return {.rows = RowEstimates(budget_, n, static_cast<int>(mesh_.reflectance.cols())),
            .known = KnownExchange(budget_, n)};
  }

  // Casts each row, with four times the rays while `error_of(i, row, pairs)` is above the target.
  // `error_of` may fill `pairs`, which `done(i, pairs)` gets with the final number of rays.
  template <class ErrorOf, class Done>
  void cast(Estimate& estimate, const std::vector<int>& rays_of, bool count_hidden,
            ErrorOf error_of, Done done) const {
    estimate.row_error.assign(static_cast<std::size_t>(mesh_.patch_count()), 0.0f);
    const int longest = *std::max_element(rays_of.begin(), rays_of.end());
    const RowCaster caster(caster_, paths_, most_rays(longest), options_.portals.get());
    const JournalPhase phase = phase_of("rays", &rays_of);
    const RowLoop loop{longest, options_.run.progress, phase};
    for_each_row(mesh_, loop, [&](int i, RowCaster::Scratch& scratch) {
      std::vector<NearExchange::Pair> pairs;
      EstimatedRow row;
      double error = 0.0;
      if (!phase.recall(i, kept_parts(row), pairs, error)) {
        for (int rays = rays_of[i];; rays *= 4) {
          row = caster.cast(i, rays, scratch, count_hidden);
          pairs.clear();
          error = error_of(i, row, pairs);
          if (!(error > options_.target_error) || 4 * rays > most_rays(rays_of[i])) break;
        }
        phase.keep(i, kept_parts(row), pairs, error);
      }
      estimate.row_error[i] = static_cast<float>(error);
      estimate.rows.add(i, row);
      done(i, pairs);
    });
    estimate.rows.close();
  }
  // `is_count(i, j)`: true if F_ij remains the rays' count. The error is that of a binomial count,
  // an upper bound for stratified points.
  template <class IsCount>
  void cast_counts(Estimate& estimate, const std::vector<int>& rays_of, IsCount is_count) const {
    const auto error_of = [&](int i, const EstimatedRow& row, auto&) {
      double worst = 0.0;
      for (const FormFactor& f : row.shares) {
        if (!is_count(i, f.patch)) continue;
        worst = std::max(worst, static_cast<double>(f.value * (1.0f - f.value)));
        // Rays that all agree have the standard error of Laplace's rule of succession.
        worst = std::max(worst, row.rays / ((row.rays + 2.0) * (row.rays + 2.0)));
      }
      return row.rays > 0.0 ? std::sqrt(worst / row.rays) : 0.0;
    };
    cast(estimate, rays_of, false, error_of, [](int, auto&) {});
  }

  Estimate rays_alone() const {
    const EmitterExchange emitters(caster_, direct_light_);
    Estimate estimate = nothing_yet();
    cast_counts(estimate, rays_of(emitters, base_rays()), [](int, int) { return true; });
    estimate.known.S.close();
    return estimate;
  }

  Estimate hemicubes_alone() const {
    Estimate estimate = nothing_yet();
    for_each_hemicube_row(
        caster_, paths_, {.resolution = options_.hemicube_resolution}, options_.run.progress,
        [&](int i, const EstimatedRow& row) { estimate.rows.add(i, row); }, phase_of("hemicubes"));
    estimate.rows.close();
    estimate.known.S.close();
    return estimate;
  }

  Estimate rays_and_closed_forms() const {
    EmitterExchange emitters(caster_, direct_light_);
    const NearExchange near(caster_, options_.target_error, options_.portals.get());
    Estimate estimate = nothing_yet();
    const int n = mesh_.patch_count();
    RecordStore pairs(budget_, n, sizeof(NearExchange::Pair), RecordStore::Count::below_diagonal);
    cast(
        estimate, rays_of(emitters, base_rays()), true,
        [&](int i, const EstimatedRow& row, std::vector<NearExchange::Pair>& found) {
          return near.find_pairs(i, row, found);
        },
        [&](int i, std::vector<NearExchange::Pair>& found) {
          std::erase_if(found, [&](const NearExchange::Pair& pair) {
            return is_closed_emitter(emitters, i) || is_closed_emitter(emitters, pair.patch);
          });
          pairs.append(i, found.data(), found.size());
        });
    pairs.close();
    KnownExchange& known = estimate.known;
    for (int i = 0; i < n; ++i) known.is_whole[i] = is_closed_emitter(emitters, i) ? 1 : 0;
    emitters.compute(receives_, options_, phase_of("emitters"));
    near.exchange(
        std::move(pairs), options_.run.progress,
        [&](int i, std::vector<FormFactor>& row) {
          const auto near_count = static_cast<std::ptrdiff_t>(row.size());
          emitters.add_row(i, row);
          std::inplace_merge(row.begin(), row.begin() + near_count, row.end(), by_patch);
          known.S.append(i, row);
        },
        phase_of("closed forms"));
    known.S.close();
    return estimate;
  }
  // True for patches of emitters whose rows consist of closed forms.
  bool is_closed_emitter(const EmitterExchange& emitters, int i) const {
    return emitters.emitter_of(i) >= 0 && !paths_.dims_before(i);
  }
  static bool by_patch(const FormFactor& a, const FormFactor& b) { return a.patch < b.patch; }

  // Rays still find the light that escapes, the light through mirrors and glass, and the exchange
  // of curved patches.
  Estimate closed_forms_alone() const {
    const EmitterExchange emitters(caster_, direct_light_);
    const std::vector<PatchOutline> outlines = patch_outlines(mesh_);
    const auto is_count = [&](int i, int j) {
      return !outlines[static_cast<std::size_t>(i)].is_polygon() ||
             !outlines[static_cast<std::size_t>(j)].is_polygon() || paths_.dims_before(j);
    };
    Estimate estimate = nothing_yet();
    cast_counts(estimate, rays_of(emitters, std::max(1, options_.rays_per_patch)), is_count);
    std::vector<float>& sum = estimate.known.error;
    sum.assign(estimate.row_error.size(), 0.0f);
    estimate.row_bias = sum;
    analytic_exchange(
        {caster_, outlines, receives_, options_.target_error}, options_.run.progress,
        {.worst = estimate.row_error, .sum = sum, .bias = estimate.row_bias},
        [&](int i, std::vector<FormFactor>& row) { estimate.known.S.append(i, row); },
        phase_of("all pairs"));
    estimate.known.S.close();
    return estimate;
  }

  JournalPhase phase_of(std::string_view name, const std::vector<int>* rays_of = nullptr) const {
    return {options_.run, name, [&](Fingerprint& print) {
              add_form_factor_inputs(print, scene_, direct_light_, mesh_, options_);
              if (rays_of) print.add(*rays_of);
            }};
  }

  const Scene& scene_;
  const PatchMesh& mesh_;
  std::shared_ptr<MemoryBudget> budget_;
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

std::unique_ptr<FormFactors> compute_form_factors(const LitScene& lit,
                                                  const FormFactorOptions& options,
                                                  FormFactorReport* report) {
  const auto budget = options.memory ? options.memory : std::make_shared<MemoryBudget>();
  const PatchMesh& mesh = lit.mesh();
  budget->plan(bytes_beside_rows(
      mesh, static_cast<std::int64_t>(lit.direct_light.emitters().size()), options));
  const Estimator estimator(lit, options, budget);
  Estimate estimate = estimator.estimate();
  const auto phase_of = [&](std::string_view name) -> JournalPhase {
    return {options.run, name, [&](Fingerprint& print) {
              add_form_factor_inputs(print, lit.scene, lit.direct_light, mesh, options);
            }};
  };
  std::vector<float> count_error;
  if (options.method == FormFactorMethod::ray_cast) {
    for (int i = 0; i < mesh.patch_count(); ++i) {
      const auto rays = static_cast<float>(estimate.rows.rays(i));
      count_error.push_back(rays > 0.0f ? 0.5f / std::sqrt(rays) : 0.0f);
    }
  }
  auto result = assemble_form_factors(mesh, std::move(estimate.rows), std::move(estimate.known),
                                      {.enforce_closure = options.enforce_closure,
                                       .budget = budget,
                                       .progress = options.run.progress,
                                       .phase_of = phase_of,
                                       .mirrored = estimator.mirrored(),
                                       .squared_index = squared_indices(lit.scene, lit.caster)},
                                      report);
  if (report) {
    report->row_error = std::move(estimate.row_error);
    report->row_bias = std::move(estimate.row_bias);
    report->count_error = std::move(count_error);
    for (std::size_t i = 0; i < report->row_error.size(); ++i) {
      report->row_error[i] = std::max(report->row_error[i], report->closure_shift[i]);
    }
  }
  return result;
}

}  // namespace lightwell
