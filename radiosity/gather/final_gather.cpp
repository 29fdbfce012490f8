#include "radiosity/gather/final_gather.h"

#include <algorithm>
#include <span>
#include <stdexcept>
#include <tuple>

#include "radiosity/emitters/emitter.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/gather/hemisphere_gather.h"
#include "radiosity/journal/journal_phase.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

LightQuery light_query(const GatherPoint& at, std::uint64_t key, const GatherOptions& options) {
  return {.at = {at.position, at.normal, at.facet},
          .key = random_key(key, RandomPurpose::gather_shadows),
          .shadows = options.shadows,
          .sky_noise = at.sky_noise};
}

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
  const auto& [rays, max_specular_depth, shadows, replica, portals, aims_out_of_gaps, run] =
      options;
  const auto& [min_shadow_rays, max_shadow_rays, sky_rays, cluster_share, many_lights] = shadows;
  print.add(rays);
  print.add(max_specular_depth);
  print.add(min_shadow_rays);
  print.add(max_shadow_rays);
  print.add(sky_rays);
  print.add(cluster_share);
  print.add(many_lights);
  print.add(replica);
  print.add(portals ? portals->size() : 0);  // portals follow from the scene and its light
  print.add(aims_out_of_gaps);
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
  const JournalPhase phase(options.run, "gather", [&](Fingerprint& print) {
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
  const JournalPhase phase(options.run, visibilities ? "sights" : "direct",
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
  const JournalPhase phase(options.run, "indirect", [&](Fingerprint& print) {
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

BandArray gather_shares(const LitScene& lit, const GatherPoints& points,
                        const GatherOptions& options) {
  if (!lit.direct_light.emitters().empty() || !lit.direct_light.free_sources().empty()) {
    throw std::invalid_argument("shares of vertices are those of a scene without lights");
  }
  const HemisphereGather hemisphere(lit, options, points);
  BandArray shares(points.size(),
                   Eigen::Index{lit.mesh().vertex_count()} * lit.scene.bands.count());
  const JournalPhase phase(options.run, "shares", [&](Fingerprint& print) {
    add_gather_inputs(print, lit.mesh(), points, options);
  });
  const auto values = [&](int begin, int size) { return std::tuple(rows_of(shares, begin, size)); };
  for_each_point(points, options, phase, values,
                 [&](int i, const GatherPoint& at, std::uint64_t key) {
                   float variance = 0.0f;
                   hemisphere.gather(at, key, shares.row(i).data(), variance);
                 });
  return shares;
}

}  // namespace lightwell
