#include "radiosity/paths/free_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/area_shares.h"
#include "mesh/patches/patch_sampler.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/paths/mirrored_shares_of_patches.h"
#include "scene/coat.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr int fewest_free_rays = 1 << 12, most_free_rays = 1 << 24;

// The fate of some rays of one source, as sums of weights.
struct Arrival {
  int patch = 0;
  double weight = 0.0;
};
struct PassedOn {
  int patch = 0;
  Spectrum weight{};
};
struct CastPiece {
  CastPiece() = default;
  explicit CastPiece(Eigen::Index bands)
      : sent(Eigen::ArrayXd::Zero(bands)),
        missed(sent),
        met_black(sent),
        absorbed(sent),
        escaped(sent) {}

  Eigen::ArrayXd sent, missed, met_black;  // per band
  std::vector<Arrival> straight{};
  std::vector<PassedOn> in_bands{};  // by way of mirrors and glass, or of a lamp's colours
  Eigen::ArrayXd absorbed, escaped;  // by way of mirrors and glass
};

// One value per band, without memory of the heap.
using Factor = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_bands, 1>;

// A colour per band; 1 for an empty one.
Factor factor(const Spectrum& color, Eigen::Index bands) {
  if (color.size() > 0) return color.cast<double>();
  return Factor::Ones(bands);
}

CastPiece cast_piece(const FreeSource& source, const ElementCaster& caster, const LightPaths& paths,
                     const SobolPoints& sobol, std::uint64_t key, int begin, int end) {
  const PatchMesh& mesh = caster.mesh();
  const Eigen::Index bands = source.light.size();
  CastPiece piece(bands);
  constexpr int batch = 128;
  std::vector<Ray> rays(batch);
  std::vector<double> weight(batch);
  std::vector<Spectrum> color(batch);
  std::vector<ElementHit> hits(batch);
  for (int first = begin; first < end; first += batch) {
    const int n = std::min(batch, end - first);
    for (int r = 0; r < n; ++r) {
      const SourceRay sent = source_ray(source, sobol.point(first + r, key));
      rays[r] = sent.ray;
      weight[r] = sent.weight;
      color[r] = sent.color;
      piece.sent += sent.weight * factor(sent.color, bands);
    }
    const auto count = static_cast<std::size_t>(n);
    caster.closest_elements({rays.data(), count}, {hits.data(), count});
    for (int r = 0; r < n; ++r) {
      const ElementHit& hit = hits[r];
      const double w = weight[r];
      if (!(w > 0.0)) continue;
      if (hit.facet < 0) {
        piece.missed += w * factor(color[r], bands);
        continue;
      }
      const bool is_specular = paths.is_specular(hit.facet);
      if (hit.element < 0 && !is_specular) {
        piece.met_black += w * factor(color[r], bands);
        continue;
      }
      if (hit.element >= 0 && paths.is_diffuse(hit.facet) && !source.is_distant()) {
        const int patch = mesh.patch[hit.element];
        const Spectrum left = paths.left_by_body(rays[r], hit);
        if (left.size() > 0) {
          piece.in_bands.push_back({patch, with_color(left, color[r]) * static_cast<float>(w)});
          if (!is_specular) {
            piece.absorbed += w * factor(color[r], bands) * (1.0f - left).cast<double>();
          }
        } else if (color[r].size() > 0) {
          piece.in_bands.push_back({patch, color[r] * static_cast<float>(w)});
        } else {
          piece.straight.push_back({patch, w});
        }
      }
      if (!is_specular) continue;
      const auto branch =
          random_key(key, RandomPurpose::free_source_paths, static_cast<std::uint64_t>(first + r));
      const PathLosses losses = paths.follow(rays[r], hit, branch, [&](const LightArrival& at) {
        // Collector::receive() counts the light of the sun straight through panes.
        if (source.is_distant() && at.through_panes_only) return;
        piece.in_bands.push_back({mesh.patch[at.hit.element],
                                  with_color(at.throughput, color[r]) * static_cast<float>(w)});
      });
      const Factor lost = w * factor(color[r], bands);
      piece.absorbed += lost * (losses.absorbed + losses.cut).cast<double>();
      piece.escaped += lost * losses.escaped.cast<double>();
    }
  }
  return piece;
}

// The fate of all rays of a source.
struct Sums {
  Sums(const PatchMesh& mesh, Eigen::Index bands)
      : sent(Eigen::ArrayXd::Zero(bands)),
        missed(sent),
        met_black(sent),
        straight(Eigen::ArrayXd::Zero(mesh.patch_count())),
        in_bands(Eigen::ArrayXXd::Zero(bands, mesh.patch_count())),
        absorbed(sent),
        escaped(sent),
        is_met(static_cast<std::size_t>(mesh.patch_count()), 0) {}

  void add(const CastPiece& piece) {
    for (const Arrival& at : piece.straight) touch(at.patch);
    for (const PassedOn& at : piece.in_bands) touch(at.patch);
    sent += piece.sent;
    missed += piece.missed;
    met_black += piece.met_black;
    absorbed += piece.absorbed;
    escaped += piece.escaped;
    for (const Arrival& at : piece.straight) straight[at.patch] += at.weight;
    for (const PassedOn& at : piece.in_bands) {
      in_bands.col(at.patch) += at.weight.cast<double>();
    }
  }

  // Makes the sums zero. Only patches that were met have any.
  void clear() {
    for (const int patch : met) {
      straight[patch] = 0.0;
      in_bands.col(patch).setZero();
      is_met[static_cast<std::size_t>(patch)] = 0;
    }
    met.clear();
    for (Eigen::ArrayXd* sum : {&sent, &missed, &met_black, &absorbed, &escaped}) sum->setZero();
  }

  Eigen::ArrayXd sent, missed, met_black;
  Eigen::ArrayXd straight;
  Eigen::ArrayXXd in_bands;  // bands x patches
  Eigen::ArrayXd absorbed, escaped;
  std::vector<int> met{};  // patches

 private:
  void touch(int patch) {
    char& known = is_met[static_cast<std::size_t>(patch)];
    if (known == 0) met.push_back(patch);
    known = 1;
  }
  std::vector<char> is_met;
};

class Collector {
 public:
  Collector(const ElementCaster& caster, const LightPaths& paths, const DirectLight& direct_light)
      : caster_(caster), paths_(paths), bands_(caster.mesh().emission.cols()) {
    const Eigen::Index columns = direct_light.column_count();
    of_lamps_ = from_afar_ = Eigen::ArrayXXd::Zero(columns, caster.mesh().patch_count());
    light_.emitted = light_.absorbed = light_.escaped = light_.missed =
        Eigen::ArrayXd::Zero(columns);
  }

  /// A source and the number of its rays.
  struct Shot {
    const FreeSource* source = nullptr;
    int rays = 0;
  };

  // Casts the rays of many sources side by side, and adds what they find in order.
  void cast(std::span<const Shot> shots) {
    // Slices bound the memory of results that wait to be added.
    constexpr int piece_rays = 1 << 13, slice = 16;
    struct Piece {
      const Shot* shot = nullptr;
      int first = 0;
    };
    std::vector<Piece> pieces;
    int most = 1;
    for (const Shot& shot : shots) {
      most = std::max(most, shot.rays);
      for (int from = 0; from < shot.rays; from += piece_rays) pieces.push_back({&shot, from});
    }
    const SobolPoints sobol(most);
    Sums sums(caster_.mesh(), bands_);
    for (std::size_t first = 0; first < pieces.size(); first += slice) {
      const std::size_t count = std::min<std::size_t>(slice, pieces.size() - first);
      std::vector<CastPiece> found(count);
      parallel_for(static_cast<int>(count), 1, [&](int begin, int end) {
        for (int p = begin; p < end; ++p) {
          const auto& [shot, from] = pieces[first + static_cast<std::size_t>(p)];
          const auto key = random_key(static_cast<std::uint64_t>(shot->source->number),
                                      RandomPurpose::free_source_rays);
          found[static_cast<std::size_t>(p)] =
              cast_piece(*shot->source, caster_, paths_, sobol, key, from,
                         std::min(shot->rays, from + piece_rays));
        }
      });
      for (std::size_t p = 0; p < count; ++p) {
        const Shot* shot = pieces[first + p].shot;
        sums.add(found[p]);
        if (first + p + 1 < pieces.size() && pieces[first + p + 1].shot == shot) continue;
        if ((sums.sent > 0.0).any()) add(*shot->source, sums);
        sums.clear();
      }
    }
  }

  // Light of sky and sun at points all over each patch, straight or through clear panes; at fewer
  // points of small patches, whose light counts for less. The emitted power includes all of it but
  // mirrored light, which counts where it arrives.
  void receive(const Scene& scene, const DirectLight& direct_light, const Progress& progress) {
    const PatchMesh& mesh = caster_.mesh();
    const FreeSource* dome = direct_light.dome();
    const bool has_specular = paths_.has_specular() && dome && dome->is_on();
    constexpr int slice = 256, most_points = 16, fewest_points = 2, rays = 128;
    const SobolPoints at_points(most_points), at_rays(rays);
    const std::vector<int> points_of =
        samples_by_area(scene, mesh, most_points, most_points / fewest_points);
    BandArray E = BandArray::Zero(mesh.patch_count(), from_afar_.rows());
    for (int first = 0; first < mesh.patch_count(); first += slice) {
      report(progress, "daylight", static_cast<double>(first) / mesh.patch_count());
      const int count = std::min(slice, mesh.patch_count() - first);
      parallel_for(count, 4, [&](int begin, int end) {
        for (int i = first + begin; i < first + end; ++i) {
          const int facet = mesh.facet[mesh.first_element[i]];
          if (!paths_.is_diffuse(facet)) continue;
          const PatchSampler sampler(mesh, i);
          const auto key =
              random_key(static_cast<std::uint64_t>(i), RandomPurpose::free_source_points);
          const int points = points_of[static_cast<std::size_t>(i)];
          for (int p = 0; p < points; ++p) {
            const Eigen::Array4f u = at_points.point(p, key);
            const PatchPoint at = sampler.point(u[0], u[1]);
            direct_light.add_irradiance(caster_,
                                        {.at = {at.position, at.normal, mesh.facet[at.element]},
                                         .key = random_key(key, static_cast<std::uint64_t>(p)),
                                         .shadows = {.min_rays = 16, .max_rays = 64},
                                         .lights = Lights::distant},
                                        E.row(i).data());
          }
          E.row(i) /= static_cast<float>(points);
          if (!has_specular) continue;
          const Spectrum seen =
              sky_by_specular(sampler, at_rays, random_key(key, RandomPurpose::free_source_rays));
          E.row(i).segment(dome->channel * bands_, bands_) += (dome->light * seen).transpose();
        }
      });
    }
    const BandArray sent_on = mirrored_shares(scene, mesh);
    for (int i = 0; i < mesh.patch_count(); ++i) {
      from_afar_.col(i) += mesh.area[i] * E.row(i).transpose().cast<double>();
      const Eigen::ArrayXd kept = 1.0 - sent_on.row(i).transpose().cast<double>();
      for (Eigen::Index k = 0; k < from_afar_.rows(); k += bands_) {
        light_.emitted.segment(k, bands_) += kept * from_afar_.col(i).segment(k, bands_);
      }
    }
  }

  FreeLight result() {
    const PatchMesh& mesh = caster_.mesh();
    light_.irradiance.resize(mesh.patch_count(), of_lamps_.rows());
    for (int i = 0; i < mesh.patch_count(); ++i) {
      light_.irradiance.row(i) =
          ((of_lamps_.col(i) + from_afar_.col(i)) / mesh.area[i]).cast<float>().transpose();
    }
    return std::move(light_);
  }

 private:
  // The power of the rays is scaled to exactly the flux of the source in each band.
  void add(const FreeSource& source, const Sums& sums) {
    const Eigen::Index column = source.channel * bands_;
    const Eigen::ArrayXd mean = mean_light(source).cast<double>();
    const Eigen::ArrayXd watts =
        (sums.sent > 0.0).select(total_weight(source) / sums.sent * mean, 0.0);
    const auto of = [&](Eigen::ArrayXd& sum) { return sum.segment(column, bands_); };
    Eigen::ArrayXXd& power = source.is_distant() ? from_afar_ : of_lamps_;
    for (const int i : sums.met) {
      power.col(i).segment(column, bands_) += watts * (sums.straight[i] + sums.in_bands.col(i));
    }
    if (source.is_distant()) return;  // see receive()
    of(light_.emitted) += watts * sums.sent;
    of(light_.missed) += watts * sums.missed;
    of(light_.escaped) += watts * (sums.missed + sums.met_black + sums.escaped);
    of(light_.absorbed) += watts * sums.absorbed;
  }

  // Irradiance from the dome through mirrors and glass.
  Spectrum sky_by_specular(const PatchSampler& sampler, const SobolPoints& sobol,
                           std::uint64_t key) const {
    Spectrum sum = Spectrum::Zero(bands_);
    for (int r = 0; r < sobol.count(); ++r) {
      const Eigen::Array4f u = sobol.point(r, key);
      const PatchPoint at = sampler.point(u[0], u[1]);
      const Ray ray = cosine_ray(caster_.mesh(), at, u[2], u[3]);
      ElementHit hit;
      caster_.closest_hits({&ray, 1}, {&hit, 1});
      if (hit.facet < 0 || !paths_.is_specular(hit.facet)) continue;
      const PathLosses losses = paths_.follow(
          ray, hit,
          random_key(key, RandomPurpose::free_source_paths, static_cast<std::uint64_t>(r)),
          [](const LightArrival&) {}, PathQuantity::radiance);
      if (losses.sky.size() > 0) sum += losses.sky;
    }
    return std::numbers::pi_v<float> / static_cast<float>(sobol.count()) * sum;
  }

  const ElementCaster& caster_;
  const LightPaths& paths_;
  Eigen::Index bands_;
  Eigen::ArrayXXd of_lamps_, from_afar_;  // power that patches get: columns x patches, W
  FreeLight light_{};
};

}  // namespace

FreeLight all_channels(const FreeLight& light, int bands) {
  if (light.empty()) return {};
  const auto sum = [&](const Eigen::ArrayXd& columns) {
    Eigen::ArrayXd all = Eigen::ArrayXd::Zero(bands);
    for (Eigen::Index k = 0; k < columns.size(); k += bands) all += columns.segment(k, bands);
    return all;
  };
  return {.irradiance = channel_sum(light.irradiance, bands),
          .emitted = sum(light.emitted),
          .absorbed = sum(light.absorbed),
          .escaped = sum(light.escaped),
          .missed = sum(light.missed)};
}

FreeLight of_channel(const FreeLight& light, int channel, int bands) {
  if (light.empty()) return {};
  const Eigen::Index first = Eigen::Index{channel} * bands;
  return {.irradiance = light.irradiance.middleCols(first, bands),
          .emitted = light.emitted.segment(first, bands),
          .absorbed = light.absorbed.segment(first, bands),
          .escaped = light.escaped.segment(first, bands),
          .missed = light.missed.segment(first, bands)};
}

FreeLight cast_free_light(const Scene& scene, const ElementCaster& caster, const LightPaths& paths,
                          const DirectLight& direct_light, int rays, const Progress& progress) {
  if (rays < 1 || rays > most_free_rays) {
    throw std::invalid_argument(fmt::format(
        "{} rays of free sources; there must be between 1 and {}", rays, most_free_rays));
  }
  const std::vector<FreeSource>& sources = direct_light.free_sources();
  if (sources.empty()) return {};
  const auto power = [](const FreeSource& source) {
    return total_weight(source) * static_cast<double>(mean_light(source).sum());
  };
  double all = 0.0;
  for (const FreeSource& source : sources) all += source.is_distant() ? 0.0 : power(source);
  Collector collector(caster, paths, direct_light);
  // Many lamps make up for each other's noise: no lamp needs the fewest rays of one alone where
  // these would make more than four times the rays that are asked for. 64 still tell where a lamp's
  // light goes.
  constexpr double fewest_of_many = 64.0, times = 4.0;
  const double fewest = std::clamp<double>(times * rays / static_cast<double>(sources.size()),
                                           fewest_of_many, fewest_free_rays);
  std::vector<Collector::Shot> shots;
  for (const FreeSource& source : sources) {
    if (!source.is_on() || source.is_distant()) continue;
    const double due = rays * (power(source) / all);
    const auto count = static_cast<unsigned>(std::clamp<double>(due, fewest, most_free_rays));
    shots.push_back({.source = &source, .rays = static_cast<int>(std::bit_ceil(count))});
  }
  // A tenth of a second of rays, or a single lamp, between two reports.
  constexpr int between_reports = 1 << 18;
  for (std::size_t first = 0, end = 0; first < shots.size(); first = end) {
    report(progress, "lamps", static_cast<double>(first) / static_cast<double>(shots.size()));
    std::int64_t together = 0;
    do {
      together += shots[end++].rays;
    } while (end < shots.size() && together + shots[end].rays <= between_reports);
    collector.cast(std::span(shots).subspan(first, end - first));
  }
  report(progress, "lamps", 1.0);
  if (!sources.back().is_distant()) return collector.result();
  const FreeSource& last = sources.back();
  if (paths.has_specular() && last.is_on() && !last.is_dome()) {
    const Collector::Shot shot{
        .source = &last, .rays = static_cast<int>(std::bit_ceil(static_cast<unsigned>(rays)))};
    collector.cast({&shot, 1});
  }
  collector.receive(scene, direct_light, progress);
  return collector.result();
}

}  // namespace lightwell
