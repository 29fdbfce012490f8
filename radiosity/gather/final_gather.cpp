#include "radiosity/gather/final_gather.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "mesh/patches/patch_patterns.h"
#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/patch_textures.h"
#include "mesh/patches/pictured_emission.h"
#include "mesh/patches/round_grid.h"
#include "mesh/patches/translucency.h"
#include "radiosity/gather/bright_patches.h"
#include "radiosity/gather/gap_light.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/journal/journal_phase.h"
#include "radiosity/openings/portals.h"
#include "radiosity/paths/light_path.h"
#include "scene/hemisphere_sets.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr int gather_batch = 128;

LightQuery light_query(const GatherPoint& at, std::uint64_t key, const GatherOptions& options) {
  return {.at = {at.position, at.normal, at.facet},
          .key = random_key(key, RandomPurpose::gather_shadows),
          .shadows = options.shadows,
          .sky_noise = at.sky_noise};
}

int ray_count(const GatherPoint& at, const GatherOptions& options) {
  return at.rays > 0 ? at.rays : std::max(1, options.rays);
}

class HemisphereGather {
 public:
  HemisphereGather(const LitScene& lit, const BandArray& radiosity, const GatherOptions& options,
                   const GatherPoints& points)
      : mesh_(lit.mesh()),
        caster_(lit.caster),
        radiosity_(radiosity),
        paths_(lit.scene, lit.caster, options.max_specular_depth),
        options_(options),
        bands_(lit.scene.bands.count()),
        bright_(lit.scene, lit.caster, radiosity),
        gaps_(lit, radiosity, paths_) {
    if (const FreeSource* dome = lit.direct_light.dome()) {
      dome_ = dome->light;
      if (lit.direct_light.column_count() == radiosity.cols())
        dome_column_ = dome->channel * bands_;
    }
    for (int i = 0; i < points.size(); ++i) {
      const int rays = ray_count(points[i], options);
      if (!sets_.contains(rays)) sets_.emplace(rays, HemisphereSets(rays));
      if (!bright_.is_empty() && !aims_.contains(rays)) {
        aims_.emplace(rays, SobolPoints(bright_.aimed(rays)));
      }
      if (options.portals && !portal_aims_.contains(rays)) {
        portal_aims_.emplace(rays, SobolPoints(Portals::aimed(rays)));
      }
    }
  }

  // E = (1/N) sum B over N cosine-distributed rays and, if there are bright patches or portals,
  // rays aimed at them besides; B of all kinds is weighted by the balance heuristic. Writes the
  // columns of `irradiance`. The first and the second half of the rays are each stratified.
  void gather(const GatherPoint& at, std::uint64_t key, float* irradiance, float& variance) const {
    const Eigen::Index columns = radiosity_.cols();
    std::array<Eigen::ArrayXd, 2> sum{Eigen::ArrayXd::Zero(columns), Eigen::ArrayXd::Zero(columns)};
    const HemisphereSets& set = sets_.at(ray_count(at, options_));
    const HemisphereSets::Draw draw = set.draw(random_key(key, RandomPurpose::gather_rays));
    const Eigen::Matrix3d frame = draw.frame(at.normal);
    const int count = set.count();
    Place place{.at = at, .key = key, .rays = count};
    if (!bright_.is_empty()) place.bright = bright_.view(at.position, at.normal, count);
    if (options_.portals) place.portals = options_.portals->view(at.position, at.normal, count);
    std::array<Ray, gather_batch> ray;
    std::array<ElementHit, gather_batch> hit;
    for (int begin = 0; begin < set.count(); begin += gather_batch) {
      const auto points =
          draw.all().subspan(static_cast<std::size_t>(begin),
                             static_cast<std::size_t>(std::min(gather_batch, set.count() - begin)));
      const std::size_t n = points.size();
      for (std::size_t r = 0; r < n; ++r) {
        ray[r] = {.origin = at.position,
                  .direction = frame * Eigen::Vector3d(points[r].x, points[r].y, points[r].z),
                  .origin_group = at.facet};
      }
      caster_.closest_hits({ray.data(), n}, {hit.data(), n});
      for (std::size_t r = 0; r < n; ++r) {
        const std::uint64_t index = static_cast<std::uint64_t>(begin) + r;
        const int rank = begin / HemisphereSets::block * HemisphereSets::block + points[r].rank;
        add(place, ray[r], hit[r], index, aimed_density(place, ray[r], hit[r]),
            sum[rank < count / 2 ? 0 : 1]);
      }
    }
    if (!place.bright.is_empty()) aim_at_bright(place, sum);
    if (!place.portals.is_empty()) aim_at_portals(place, sum);
    Eigen::Map<Eigen::ArrayXf>(irradiance, columns) =
        ((sum[0] + sum[1]) / set.count()).cast<float>();
    variance = half_difference(sum, set.count());
  }

 private:
  // A gather point, and the bright patches and portals that are seen from there.
  struct Place {
    const GatherPoint& at;
    std::uint64_t key = 0;
    int rays = 0;  // cosine-distributed
    BrightPatches::View bright{};
    Portals::View portals{};
  };

  // Number times density, 1/sr, of rays aimed at the portals that the ray passes.
  double aimed_density(const Place& place, const Ray& ray, const ElementHit& hit) const {
    if (place.portals.is_empty()) return 0.0;
    return Portals::aimed(place.rays) *
           options_.portals->density(place.portals, ray.origin, ray.direction, hit.t);
  }

  // Adds rays towards bright patches; each counts only the light straight from its own element.
  void aim_at_bright(const Place& place, std::array<Eigen::ArrayXd, 2>& sum) const {
    const GatherPoint& at = place.at;
    const SobolPoints& aims = aims_.at(place.rays);
    std::array<Ray, gather_batch> ray;
    std::array<ElementHit, gather_batch> hit;
    std::array<int, gather_batch> element;
    for (int begin = 0; begin < aims.count(); begin += gather_batch) {
      const auto n = static_cast<std::size_t>(std::min(gather_batch, aims.count() - begin));
      for (std::size_t r = 0; r < n; ++r) {
        const Eigen::Array4d u = aims.point(begin + static_cast<int>(r),
                                            random_key(place.key, RandomPurpose::gather_aims))
                                     .cast<double>();
        const BrightPatches::Aim aim = bright_.draw(place.bright, u[0], u[1], u[2]);
        element[r] = aim.element;
        ray[r] = {.origin = at.position, .direction = aim.direction, .origin_group = at.facet};
      }
      caster_.closest_hits({ray.data(), n}, {hit.data(), n});
      for (std::size_t r = 0; r < n; ++r) {
        if (hit[r].element != element[r] || !paths_.is_diffuse(hit[r].facet)) continue;
        if (at.facet >= 0 && gaps_.is_gap(at.normal, ray[r], hit[r])) continue;
        if (is_near_portal(place, ray[r], hit[r])) continue;
        const bool is_first = begin + static_cast<int>(r) < aims.count() / 2;
        const double share =
            bright_.share(place.bright, at.normal.dot(ray[r].direction), place.rays, ray[r], hit[r],
                          aimed_density(place, ray[r], hit[r]));
        add_radiosity(hit[r], share * paths_.base_factor(ray[r], hit[r]), sum[is_first ? 0 : 1]);
      }
    }
  }

  // Adds rays towards portals. Each counts whatever it finds, if it passes a portal.
  void aim_at_portals(const Place& place, std::array<Eigen::ArrayXd, 2>& sum) const {
    const GatherPoint& at = place.at;
    const SobolPoints& aims = portal_aims_.at(place.rays);
    const std::uint64_t key = random_key(place.key, RandomPurpose::gather_portals);
    std::array<Ray, gather_batch> ray;
    std::array<ElementHit, gather_batch> hit;
    for (int begin = 0; begin < aims.count(); begin += gather_batch) {
      const auto n = static_cast<std::size_t>(std::min(gather_batch, aims.count() - begin));
      for (std::size_t r = 0; r < n; ++r) {
        const Eigen::Array4d u = aims.point(begin + static_cast<int>(r), key).cast<double>();
        ray[r] = {.origin = at.position,
                  .direction = options_.portals->draw(place.portals, at.position, u[0], u[1], u[2]),
                  .origin_group = at.facet};
      }
      caster_.closest_hits({ray.data(), n}, {hit.data(), n});
      for (std::size_t r = 0; r < n; ++r) {
        const double density = aimed_density(place, ray[r], hit[r]);
        if (!(density > 0.0) || !(at.normal.dot(ray[r].direction) > 0.0)) continue;
        const std::size_t index = static_cast<std::size_t>(begin) + r;
        const bool is_first = index < static_cast<std::size_t>(aims.count() / 2);
        add(place, ray[r], hit[r], static_cast<std::uint64_t>(place.rays) + index, density,
            sum[is_first ? 0 : 1]);
      }
    }
  }

  // Adds what a ray finds, by the balance heuristic. `aimed` is aimed_density(); `index` numbers
  // the rays of the place. Bright patches are not aimed at through mirrors and glass.
  void add(const Place& place, const Ray& ray, const ElementHit& hit, std::uint64_t index,
           double aimed, Eigen::ArrayXd& sum) const {
    if (hit.facet < 0) return;
    const GatherPoint& at = place.at;
    const double by_cosine =
        place.rays * std::max(at.normal.dot(ray.direction), 0.0) * std::numbers::inv_pi;
    const double share = aimed > 0.0 ? by_cosine / (by_cosine + aimed) : 1.0;
    const bool in_gap = (at.facet >= 0 && gaps_.is_gap(at.normal, ray, hit)) ||
                        (aimed > 0.0 && gaps_.is_narrow(caster_, ray, hit));
    if (in_gap) {
      add_of_gap(ray, hit, random_key(place.key, RandomPurpose::gap_rays, index), share, sum);
      return;
    }
    if (is_near_portal(place, ray, hit)) {
      Eigen::ArrayXd found = Eigen::ArrayXd::Zero(sum.size());
      gaps_.add_near_portal(caster_, *options_.portals, ray, hit,
                            random_key(place.key, RandomPurpose::gap_rays, index), found);
      sum += share * found;
      return;
    }
    if (hit.element >= 0 && paths_.is_diffuse(hit.facet)) {
      const double straight = place.bright.is_empty()
                                  ? share
                                  : bright_.share(place.bright, at.normal.dot(ray.direction),
                                                  place.rays, ray, hit, aimed);
      add_radiosity(hit, straight * paths_.base_factor(ray, hit), sum);
    }
    if (paths_.is_specular(hit.facet)) {
      add_path(ray, hit, random_key(place.key, RandomPurpose::gather_paths, index), share, sum);
    }
  }

  void add_of_gap(const Ray& ray, const ElementHit& hit, std::uint64_t key, double share,
                  Eigen::ArrayXd& sum) const {
    if (share == 1.0) {
      gaps_.add(caster_, ray, hit, key, sum);
      return;
    }
    Eigen::ArrayXd found = Eigen::ArrayXd::Zero(sum.size());
    gaps_.add(caster_, ray, hit, key, found);
    sum += share * found;
  }

  bool is_near_portal(const Place& place, const Ray& ray, const ElementHit& hit) const {
    return !place.portals.is_empty() && gaps_.is_near_portal(*options_.portals, ray, hit);
  }

  // Adds light that arrives through mirrors and glass.
  void add_path(const Ray& ray, const ElementHit& hit, std::uint64_t key, double share,
                Eigen::ArrayXd& sum) const {
    const auto weight = static_cast<float>(share);
    const PathLosses losses =
        paths_.follow(ray, hit, key, [&](const ElementHit& end, const Spectrum& throughput) {
          add_throughput(end, weight * throughput, sum);
        });
    if (losses.sky.size() == 0 || dome_.size() == 0) return;
    sum.segment(dome_column_, bands_) +=
        (std::numbers::pi_v<float> * weight * dome_ * losses.sky).cast<double>();
  }

  // `throughput` has bands, and the columns are those of one channel after the other.
  void add_throughput(const ElementHit& hit, const Spectrum& throughput,
                      Eigen::ArrayXd& sum) const {
    if (hit.element < 0) return;
    const Eigen::Index bands = throughput.size();
    const auto& corners = mesh_.corners[hit.element];
    for (Eigen::Index k = 0; k < sum.size(); k += bands) {
      Spectrum B = Spectrum::Zero(bands);
      for (int c = 0; c < mesh_.corner_count(hit.element); ++c) {
        B += hit.weights[c] * radiosity_.row(corners[c]).segment(k, bands).transpose();
      }
      sum.segment(k, bands) += (throughput * B).cast<double>();
    }
  }

  void add_radiosity(const ElementHit& hit, double share, Eigen::ArrayXd& sum) const {
    const auto& corners = mesh_.corners[hit.element];
    for (int c = 0; c < mesh_.corner_count(hit.element); ++c) {
      const float* B = radiosity_.data() + corners[c] * radiosity_.cols();
      for (Eigen::Index k = 0; k < sum.size(); ++k) {
        sum[k] += share * static_cast<double>(hit.weights[c] * B[k]);
      }
    }
  }

  // The square of half the difference between the halves' means.
  float half_difference(const std::array<Eigen::ArrayXd, 2>& sum, int count) const {
    const int first = count / 2, second = count - first;
    const Eigen::ArrayXd by_column =
        0.5 * (first > 0 ? Eigen::ArrayXd(sum[1] / second - sum[0] / first) : 2.0 * sum[1]);
    Eigen::ArrayXd difference = Eigen::ArrayXd::Zero(bands_);
    for (Eigen::Index k = 0; k < by_column.size(); k += bands_) {
      difference += by_column.segment(k, bands_);
    }
    return static_cast<float>(difference.square().mean());
  }

  const PatchMesh& mesh_;
  const ElementCaster& caster_;
  const BandArray& radiosity_;
  LightPaths paths_;
  const GatherOptions& options_;
  Eigen::Index bands_;
  Spectrum dome_{};  // scale of the sky's light per band; empty without a sky
  Eigen::Index dome_column_ = 0;
  std::map<int, HemisphereSets> sets_;  // by number of rays
  BrightPatches bright_;
  GapLight gaps_;
  // Of rays aimed at bright patches and at portals, by the number of rays in sets_.
  std::map<int, SobolPoints> aims_, portal_aims_;
};

// Adds all inputs of a gather, apart from the scene, to the journal's fingerprint.
void add_gather_inputs(Fingerprint& print, const PatchMesh& mesh, const GatherPoints& points,
                       const GatherOptions& options) {
  print.add(mesh);
  for (int i = 0; i < points.size(); ++i) {
    const auto [position, normal, facet, key, rays, sky_noise] = points[i];
    print.add(position);
    print.add(normal);
    print.add(facet);
    print.add(key.has_value());
    print.add(key.value_or(0));
    print.add(rays);
    print.add(sky_noise.irradiance);
    print.add(sky_noise.share);
    print.add(sky_noise.most_times);
  }
  // The run decides no bit of a result.
  const auto& [rays, max_specular_depth, shadows, replica, portals, run] = options;
  const auto& [min_shadow_rays, max_shadow_rays, sky_rays] = shadows;
  print.add(rays);
  print.add(max_specular_depth);
  print.add(min_shadow_rays);
  print.add(max_shadow_rays);
  print.add(sky_rays);
  print.add(replica);
  print.add(portals ? portals->size() : 0);  // portals follow from the scene and its light
}

// The values of rows begin to begin + size - 1.
std::span<float> rows_of(BandArray& values, int begin, int size) {
  return {values.data() + begin * values.cols(), static_cast<std::size_t>(size * values.cols())};
}

// Calls body(i, point, key) for every point, with the key of its random numbers. A slice of points
// whose `values(begin, size)` are in the journal's `phase` is skipped. Slices are a fraction of a
// second of rays, and between them this thread reports progress and may be interrupted.
template <class Values, class Body>
void for_each_point(const GatherPoints& points, const GatherOptions& options,
                    const JournalPhase& phase, Values values, Body&& body) {
  const int count = points.size();
  constexpr int rays_per_slice = 1 << 20;
  const int slice =
      std::clamp(rays_per_slice / std::max(options.rays, 1), 2, std::max(64, count / 100));
  const int grain = std::clamp(slice / 8, 1, 8);
  const auto report_progress = [&](int begin) {
    report(options.run.progress, "gather", static_cast<double>(begin) / count);
  };
  for_each_slice(phase, count, slice, grain, values, report_progress, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const GatherPoint at = points[i];
      body(i, at, random_key(at.key.value_or(static_cast<std::uint64_t>(i)), options.replica));
    }
  });
  report(options.run.progress, "gather", 1.0);
}

}  // namespace

GatheredIrradiance gather_irradiance(const LitScene& lit, const BandArray& radiosity,
                                     const GatherPoints& points, const GatherOptions& options) {
  const int count = points.size();
  const HemisphereGather hemisphere(lit, radiosity, options, points);
  GatheredIrradiance result{.direct = BandArray::Zero(count, lit.direct_light.column_count()),
                            .indirect = BandArray::Zero(count, radiosity.cols()),
                            .variance = Eigen::ArrayXf::Zero(count)};
  const JournalPhase phase(options.run.journal, "gather", [&](Fingerprint& print) {
    add_gather_inputs(print, lit.mesh(), points, options);
    print.add(lit.direct_light.column_count());
    print.add(radiosity);
  });
  const auto values = [&](int begin, int size) {
    return std::tuple(rows_of(result.direct, begin, size), rows_of(result.indirect, begin, size),
                      std::span(result.variance.data() + begin, static_cast<std::size_t>(size)));
  };
  for_each_point(points, options, phase, values,
                 [&](int i, const GatherPoint& at, std::uint64_t key) {
                   lit.direct_light.add_irradiance(lit.caster, light_query(at, key, options),
                                                   result.direct.row(i).data());
                   hemisphere.gather(at, key, result.indirect.row(i).data(), result.variance[i]);
                 });
  return result;
}

BandArray gather_direct(const LitScene& lit, const GatherPoints& points,
                        const GatherOptions& options,
                        std::vector<EmitterVisibility>* visibilities) {
  BandArray direct =
      BandArray::Zero(points.size(), lit.direct_light.channel_count() * lit.scene.bands.count());
  if (visibilities) visibilities->assign(static_cast<std::size_t>(points.size()), {});
  const JournalPhase phase(options.run.journal, visibilities ? "sights" : "direct",
                           [&](Fingerprint& print) {
                             add_gather_inputs(print, lit.mesh(), points, options);
                             print.add(lit.direct_light.column_count());
                           });
  const auto values = [&](int begin, int size) {
    std::span<EmitterVisibility> seen;
    if (visibilities) seen = std::span(*visibilities).subspan(begin, size);
    return std::tuple(rows_of(direct, begin, size), seen);
  };
  for_each_point(points, options, phase, values,
                 [&](int i, const GatherPoint& at, std::uint64_t key) {
                   lit.direct_light.add_irradiance(lit.caster, light_query(at, key, options),
                                                   direct.row(i).data(),
                                                   visibilities ? &(*visibilities)[i] : nullptr);
                 });
  return direct;
}

GatheredIrradiance gather_indirect(const LitScene& lit, const BandArray& radiosity,
                                   const GatherPoints& points, const GatherOptions& options) {
  const HemisphereGather hemisphere(lit, radiosity, options, points);
  const int count = points.size();
  GatheredIrradiance result{.indirect = BandArray(count, radiosity.cols()),
                            .variance = Eigen::ArrayXf(count)};
  const JournalPhase phase(options.run.journal, "indirect", [&](Fingerprint& print) {
    add_gather_inputs(print, lit.mesh(), points, options);
    print.add(lit.direct_light.column_count());
    print.add(radiosity);
  });
  const auto values = [&](int begin, int size) {
    return std::tuple(rows_of(result.indirect, begin, size),
                      std::span(result.variance.data() + begin, static_cast<std::size_t>(size)));
  };
  for_each_point(points, options, phase, values,
                 [&](int i, const GatherPoint& at, std::uint64_t key) {
                   hemisphere.gather(at, key, result.indirect.row(i).data(), result.variance[i]);
                 });
  return result;
}

namespace {

// Gains of coated bases, vertices x channels: the direct light that a base gets beyond its
// irradiance, as a share of the irradiance. Empty without coats.
BandArray direct_gains(const PatchMesh& mesh, const DirectLight& direct_light,
                       const std::vector<int>& patch, Eigen::Index channels) {
  if (!direct_light.has_coats()) return {};
  BandArray gains = BandArray::Zero(mesh.vertex_count(), channels);
  const VertexGatherPoints points(mesh);
  constexpr int grain = 256;
  parallel_for(mesh.vertex_count(), grain, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const CoatedBase* base = direct_light.base_of(mesh.material[patch[v]]);
      if (!base) continue;
      const bool has_pattern = mesh.patterns && mesh.patterns->is_given(patch[v]);
      std::optional<CoatedBase> own;
      if (has_pattern) own = mesh.patterns->base_of(patch[v]);
      if (own) base = &*own;
      const GatherPoint point = points[v];
      const SurfacePoint at{point.position, point.normal, point.facet};
      if (channels == direct_light.channel_count()) {
        gains.row(v) = (direct_light.base_gains(at, *base) - 1.0).cast<float>().transpose();
      } else {
        gains.row(v).setConstant(static_cast<float>(direct_light.base_gain(at, *base) - 1.0));
      }
    }
  });
  return gains;
}

}  // namespace

BandArray gatherable_radiosity(const PatchMesh& mesh, const DirectLight& direct_light,
                               const BandArray& irradiance,
                               const Eigen::Ref<const BandArray>& direct) {
  const std::vector<int> patch = vertex_patches(mesh);
  const BandArray rho = vertex_reflectance(mesh), emission = vertex_emission(mesh);
  const Eigen::Index bands = mesh.reflectance.cols();
  BandArray gains;
  if (direct.rows() > 0) gains = direct_gains(mesh, direct_light, patch, direct.cols() / bands);
  BandArray B(irradiance.rows(), irradiance.cols()), at_base = irradiance;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int p = patch[v], facet = mesh.facet[mesh.first_element[p]];
    for (Eigen::Index k = 0; k < B.cols(); k += bands) {
      B.row(v).segment(k, bands) = rho.row(v) * irradiance.row(v).segment(k, bands);
      if (gains.size() > 0 && gains(v, k / bands) != 0.0f) {
        B.row(v).segment(k, bands) +=
            gains(v, k / bands) * rho.row(v) * direct.row(v).segment(k, bands);
        at_base.row(v).segment(k, bands) += gains(v, k / bands) * direct.row(v).segment(k, bands);
      }
    }
    if (direct_light.owns(facet, mesh.is_back[p] != 0)) continue;
    B.row(v).segment(direct_light.first_column(facet), bands) += emission.row(v);
  }
  add_transmitted(mesh, at_base, B);
  return B;
}

BandArray gatherable_radiosity(const PatchMesh& mesh, const DirectLight& direct_light,
                               const RadiositySolution& solution) {
  return gatherable_radiosity(mesh, direct_light, solution.irradiance(),
                              solution.direct_irradiance);
}

namespace {

// Power that lights leave on elements by way of mirrors and glass, W, elements x columns of every
// channel.
class CausticPower {
 public:
  // `paths` is kept a reference to.
  CausticPower(const LitScene& lit, const LightPaths& paths, int rays)
      : lit_(lit),
        paths_(paths),
        rays_(rays),
        bands_(lit.scene.bands.count()),
        sobol_(rays),
        power_(BandArray::Zero(lit.mesh().element_count(), lit.direct_light.column_count())) {
    for (int e = 0; e < static_cast<int>(lit.direct_light.emitters().size()); ++e) {
      const int facet = lit.direct_light.emitters()[e].facet;
      emitter_of_facet_.resize(std::max<std::size_t>(emitter_of_facet_.size(), facet + 1), -1);
      emitter_of_facet_[facet] = e;
    }
    find_rays();
  }

  BandArray& power() { return power_; }

  // Each patch of an emitter sends rays in proportion to its area.
  void add_patch(int p) {
    const PatchMesh& mesh = lit_.mesh();
    const int facet = mesh.facet[mesh.first_element[p]];  // emitters' patches lie on one facet each
    if (!lit_.direct_light.owns(facet, mesh.is_back[p] != 0) ||
        !(mesh.emission.row(p) > 0.0f).any())
      return;
    const int light = emitter_of_facet_[facet], of_light = rays_of_light_[light];
    const double share = mesh.area[p] / lit_.direct_light.emitters()[light].area;
    const int count = std::clamp(static_cast<int>(std::lround(of_light * share)), 1, of_light);
    const Spectrum power_per_ray =
        mesh.emission.row(p).transpose() * static_cast<float>(mesh.area[p] / count);
    const std::uint64_t key =
        random_key(static_cast<std::uint64_t>(p), RandomPurpose::caustic_rays);
    const PatchSampler sampler(mesh, p);
    send(count, key, lit_.direct_light.first_column(facet), [&](int r) {
      const Eigen::Array4f u = sobol_.point(r, key);
      const Ray ray = cosine_ray(mesh, sampler.point(u[0], u[1]), u[2], u[3]);
      return std::pair(ray, power_per_ray);
    });
  }

  void add_source(const FreeSource& source) {
    if (!source.is_on() || source.is_dome()) return;
    const std::uint64_t key =
        random_key(static_cast<std::uint64_t>(source.number), RandomPurpose::caustic_source_rays);
    const int count = rays_of_light_[lit_.direct_light.emitters().size() + source.number];
    send(count, key, source.channel * bands_, [&](int r) {
      const SourceRay sent = source_ray(source, sobol_.point(r, key));
      return std::pair(sent.ray, Spectrum(source.light * static_cast<float>(sent.weight / count)));
    });
  }

 private:
  // Rays of each light: `rays_` times the root of the light's share of its channel's power. In
  // proportion to the power, all light together would have the least noise, but caustics of single
  // lamps, which lie apart, would be left with a few rays each.
  void find_rays() {
    const DirectLight& direct = lit_.direct_light;
    std::vector<double> power;
    std::vector<int> channel;
    for (const Emitter& emitter : direct.emitters()) {
      power.push_back(double{emitter.exitance.mean()} * emitter.area);
      channel.push_back(direct.first_column(emitter.facet) / static_cast<int>(bands_));
    }
    for (const FreeSource& source : direct.free_sources()) {
      power.push_back(double{source.light.mean()} * total_weight(source));
      channel.push_back(source.channel);
    }
    std::vector<double> of_channel(static_cast<std::size_t>(direct.channel_count()), 0.0);
    for (std::size_t i = 0; i < power.size(); ++i) of_channel[channel[i]] += power[i];
    const int fewest = std::min(rays_, 1 << 12);
    for (std::size_t i = 0; i < power.size(); ++i) {
      const double all = of_channel[channel[i]];
      const double share = all > 0.0 ? power[i] / all : 1.0;
      rays_of_light_.push_back(
          std::clamp(static_cast<int>(std::lround(rays_ * std::sqrt(share))), fewest, rays_));
    }
  }

  struct Deposit {
    int element;
    Spectrum power;
  };

  // Sends rays r = 0 ... count - 1; first(r) returns a ray and its power, W. The rays deposit in
  // the columns from `column` on. Each piece of rays has a list of its own, and the lists are added
  // in order, so that the sum does not depend on the number of threads.
  template <class First>
  void send(int count, std::uint64_t key, int column, First&& first) {
    constexpr int piece = 2048;
    std::vector<std::vector<Deposit>> deposits((count + piece - 1) / piece);
    parallel_for(count, piece, [&](int begin, int end) {
      auto& list = deposits[begin / piece];
      for (int r = begin; r < end; ++r) {
        const auto [ray, watts] = first(r);
        ElementHit hit;
        lit_.caster.closest_hits({&ray, 1}, {&hit, 1});
        if (hit.facet < 0 || !paths_.is_specular(hit.facet)) continue;
        paths_.follow(ray, hit,
                      random_key(key, RandomPurpose::caustic_paths, static_cast<std::uint64_t>(r)),
                      [&](const LightArrival& at) {
                        if (at.through_panes_only) return;  // direct light has that
                        list.push_back({at.hit.element, at.throughput * watts});
                      });
      }
    });
    for (const auto& list : deposits) {
      for (const Deposit& deposit : list) {
        power_.row(deposit.element).segment(column, bands_) += deposit.power.transpose();
      }
    }
  }

  LitScene lit_;
  const LightPaths& paths_;
  int rays_, bands_;
  SobolPoints sobol_;
  std::vector<int> emitter_of_facet_{};  // -1: none
  std::vector<int> rays_of_light_{};     // emitters, then free sources
  BandArray power_;
};

// The power of the elements around each vertex over their area: W/m^2, vertices x columns.
BandArray vertex_irradiance(const PatchMesh& mesh, const BandArray& power) {
  BandArray vertex_power = BandArray::Zero(mesh.vertex_count(), power.cols());
  Eigen::ArrayXf vertex_area = Eigen::ArrayXf::Zero(mesh.vertex_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      vertex_power.row(mesh.corners[e][c]) += power.row(e);
      vertex_area[mesh.corners[e][c]] += static_cast<float>(mesh.element_area[e]);
    }
  }
  return vertex_power.colwise() / vertex_area.max(1e-30f);
}

}  // namespace

BandArray caustic_irradiance(const LitScene& lit, int rays, int max_specular_depth,
                             const RunControl& run) {
  const PatchMesh& mesh = lit.mesh();
  const LightPaths paths(lit.scene, lit.caster, max_specular_depth);
  if (!paths.has_specular() || lit.direct_light.light_count() == 0) return {};
  JournalPhase phase(run.journal, "caustics", [&](Fingerprint& print) {
    print.add(mesh);
    print.add(lit.direct_light.column_count());
    print.add(rays);
    print.add(max_specular_depth);
  });
  CausticPower found(lit, paths, rays);
  const auto& sources = lit.direct_light.free_sources();
  const int patches = mesh.patch_count(), count = patches + static_cast<int>(sources.size());
  int first = 0;
  phase.recall_state(first, found.power());
  for (int i = first; i < count; ++i) {
    if (i < patches) {
      found.add_patch(i);
    } else {
      found.add_source(sources[static_cast<std::size_t>(i - patches)]);
    }
    report(run.progress, "caustics", static_cast<double>(i) / count);
    if (phase.is_state_due()) phase.keep_state(i + 1, found.power());
  }
  phase.keep_state(count, found.power());
  return vertex_irradiance(mesh, found.power());
}

VertexGatherPoints::VertexGatherPoints(const PatchMesh& mesh)
    : mesh_(mesh), element_(mesh.vertex_count(), -1) {
  for (int e = mesh.element_count() - 1; e >= 0; --e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) element_[mesh.corners[e][c]] = e;
  }
}

GatherPoint VertexGatherPoints::operator[](int vertex) const {
  // Share of the way to the element's centre: far enough for the float rounding of a room-sized
  // scene, and near enough to stand for the vertex.
  constexpr double inset = 0.02;
  const int e = element_[vertex];
  if (e < 0) return {};
  const PatchPoint center = element_center(mesh_, e);
  const Eigen::Vector3d p = mesh_.position(vertex), inwards = inset * (center.position - p);
  // The element of a round shape is a chord of it, so the point is moved to the surface.
  if (const RoundGrid* grid = round_grid_of(mesh_, mesh_.facet[e])) {
    const Eigen::Vector3d at = nearest_on(grid->shape, p + inwards);
    return {.position = at,
            .normal = round_normal(mesh_, *grid, mesh_.patch[e], at),
            .facet = mesh_.facet[e]};
  }
  // Facets that meet smoothly have a common normal. The point lies so far above them that no facet
  // hides light from above its horizon. Lamps are left out: a point before one would receive the
  // lamp's own light.
  constexpr double flat = 1.0 - 4e-6;  // cosine of 0.16 degrees
  const Eigen::Vector3d& of_all = mesh_.vertex_normal[vertex];
  if (!(of_all.dot(center.normal) >= flat) && !(mesh_.emission.row(mesh_.patch[e]) > 0.0f).any()) {
    return {.position = p + inwards + inwards.norm() * of_all, .normal = of_all};
  }
  return {.position = p + inwards, .normal = center.normal, .facet = mesh_.facet[e]};
}

std::vector<GatherPoint> vertex_gather_points(const PatchMesh& mesh) {
  const VertexGatherPoints at(mesh);
  std::vector<GatherPoint> points;
  points.reserve(static_cast<std::size_t>(mesh.vertex_count()));
  for (int v = 0; v < mesh.vertex_count(); ++v) points.push_back(at[v]);
  return points;
}

}  // namespace lightwell
