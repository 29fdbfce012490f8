#include "radiosity/paths/caustic_photons.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "radiosity/emitters/emitter_point.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/paths/specular_targets.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// One side of an emitter, or a source that is no surface.
struct Source {
  const Emitter* emitter = nullptr;
  bool is_back = false;
  const FreeSource* free = nullptr;

  // The light that the weight of a ray of the source multiplies.
  Spectrum light(const SourceRay& sent) const {
    return free ? with_color(free->light, sent.color) : exitance_at(*emitter, sent.ray.origin);
  }
};

struct SourcePoint {
  Eigen::Vector3d position, normal;
};

SourcePoint source_point(const Source& source, double u, double v) {
  const Emitter& emitter = *source.emitter;
  if (!emitter.is_sphere) {
    const Eigen::Vector3d normal =
        source.is_back ? Eigen::Vector3d(-emitter.normal) : emitter.normal;
    return {emitter_point(emitter, u, v), normal};
  }
  const double z = 1.0 - 2.0 * u, phi = 2.0 * std::numbers::pi * v;
  const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
  const Eigen::Vector3d normal(across * std::cos(phi), across * std::sin(phi), z);
  return {emitter.sphere.center + emitter.sphere.radius * normal, normal};
}

// The cone of directions from a sample point towards a target.
struct Aim {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double height = 0.0;  // 1 - cos of the cone; 0: the whole hemisphere, by the cosine
};

Aim aim_at(const SpecularTarget& target, const Eigen::Vector3d& from) {
  const Eigen::Vector3d to = target.center - from;
  const double distance = to.norm();
  // A cone close to a hemisphere has little cosine for its solid angle.
  constexpr double widest_sine = 0.8;
  if (!(target.radius < widest_sine * distance)) return {};
  const double sine = target.radius / distance;
  return {.axis = to / distance, .height = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine))};
}

struct AimedRay {
  Eigen::Vector3d direction;
  double share;  // of a Lambertian emitter's light that the direction stands for
};

// Empty if the direction lies below the emitter's horizon.
std::optional<AimedRay> aimed_ray(const Aim& aim, const Eigen::Vector3d& normal, float u, float v) {
  Eigen::Vector3d a, b;
  if (!(aim.height > 0.0)) {
    tangent_frame(normal, a, b);
    const Eigen::Vector3d d = cosine_direction(u, v);
    return AimedRay{d.x() * a + d.y() * b + d.z() * normal, 1.0};
  }
  tangent_frame(aim.axis, a, b);
  // The concentric map of the disk keeps stratification; equal areas are equal solid angles.
  const Eigen::Vector3d disk = cosine_direction(u, v);
  const double radius2 = std::min(1.0, disk.x() * disk.x() + disk.y() * disk.y());
  const double cosine = 1.0 - radius2 * aim.height;
  const double stretch = std::sqrt(aim.height * (1.0 + cosine));  // sine over the disk's radius
  const Eigen::Vector3d direction = stretch * (disk.x() * a + disk.y() * b) + cosine * aim.axis;
  const double cos_out = direction.dot(normal);
  if (!(cos_out > 0.0)) return std::nullopt;
  return AimedRay{direction, 2.0 * aim.height * cos_out};  // (cos / pi) times 2 pi height
}

// An estimate of the power that a source sends to a target; never 0 if it may send some.
double estimated_power(const Source& source, const SpecularTarget& target) {
  constexpr int points = 8;
  const SobolPoints sobol(points);
  double sum = 0.0;
  bool sees = false;
  for (int i = 0; i < points; ++i) {
    const Eigen::Array4f u = sobol.point(i, 0);
    const SourcePoint from = source_point(source, u[0], u[1]);
    const Eigen::Vector3d to = target.center - from.position;
    const double distance = to.norm(), height = to.dot(from.normal);
    if (height + target.radius > 0.0) sees = true;
    if (!(distance > target.radius)) {
      sum += 1.0;
      continue;
    }
    const double sine = target.radius / distance;
    sum += sine * sine * std::max(height / distance, 0.0);
  }
  // An emitting sphere faces every side, whatever its eight sample points do.
  constexpr double least = 0.01;
  const double share = sees || source.emitter->is_sphere ? std::max(sum / points, least) : 0.0;
  return share * source.emitter->exitance.sum() * source.emitter->area;
}

// The estimate for a source without surface, by rays towards the target.
double estimated_power(const FreeSource& source, const SpecularTarget& target) {
  constexpr int points = 64;
  const SobolPoints sobol(points);
  double sum = 0.0;
  for (int i = 0; i < points; ++i) {
    const auto sent = source_ray_towards(source, target.center, target.radius, sobol.point(i, 0));
    sum += sent ? sent->weight : 0.0;
  }
  // A beam may be narrower than the spacing of the sample points.
  constexpr double least = 0.001;
  const double share = std::max(sum / points, least * total_weight(source));
  return share * source.light.sum();
}

// The photons of one source that are aimed at one target.
struct Beam {
  Source source{};
  int target = 0;
  double power = 0.0;  // estimated
  int count = 0;
  double stands_for = 0.0;  // photons, where that is not the count: few are drawn by chance
};

std::vector<Beam> make_beams(const DirectLight& direct_light, const SpecularTargets& targets) {
  std::vector<Beam> beams;
  for (const Emitter& emitter : direct_light.emitters()) {
    if (!(emitter.exitance > 0.0f).any()) continue;  // switched off
    for (const bool is_back : {false, true}) {
      if (is_back && (emitter.is_sphere || !emitter.emits_both_sides)) continue;
      for (int t = 0; t < targets.count(); ++t) {
        Beam beam{.source = {.emitter = &emitter, .is_back = is_back}, .target = t};
        beam.power = estimated_power(beam.source, targets.target(t));
        if (beam.power > 0.0) beams.push_back(beam);
      }
    }
  }
  for (const FreeSource& source : direct_light.free_sources()) {
    if (!source.is_on()) continue;
    for (int t = 0; t < targets.count(); ++t) {
      Beam beam{.source = {.free = &source}, .target = t};
      beam.power = estimated_power(source, targets.target(t));
      if (beam.power > 0.0) beams.push_back(beam);
    }
  }
  return beams;
}

// Distributes `count` photons by power. A beam whose share is below a few photons gets a random
// whole number, and each of its photons carries the share's power, so that the mean is exact.
void share_out(std::vector<Beam>& beams, int count) {
  const double all = std::accumulate(beams.begin(), beams.end(), 0.0,
                                     [](double sum, const Beam& b) { return sum + b.power; });
  constexpr double few = 16.0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double due = count * (beams[i].power / all);
    if (due >= few) {
      beams[i].count = static_cast<int>(std::lround(due));
      beams[i].stands_for = beams[i].count;
      continue;
    }
    const double chance = random_uniform(random_key(i, RandomPurpose::photon_counts));
    beams[i].count = static_cast<int>(std::floor(due + chance));
    beams[i].stands_for = due;
  }
}

struct Deposit {
  Eigen::Vector3d position;
  int element;
  Spectrum power;
};

class PhotonGun {
 public:
  PhotonGun(const ElementCaster& caster, const LightPaths& paths, const SpecularTargets& targets,
            int most)
      : caster_(caster), paths_(paths), targets_(targets), sobol_(most) {}

  void shoot(const Beam& beam, int number, int i, std::vector<Deposit>& deposits) const {
    const std::uint64_t key =
        random_key(static_cast<std::uint64_t>(number), RandomPurpose::photons);
    const auto sent = aimed(beam, sobol_.point(i, key));
    if (!sent) return;
    const Ray& ray = sent->ray;
    ElementHit hit;
    caster_.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.facet < 0 || targets_.of_facet(hit.facet) != beam.target) return;
    const Spectrum power =
        beam.source.light(*sent) * static_cast<float>(sent->weight / beam.stands_for);
    const auto branch_key =
        random_key(key, RandomPurpose::photon_paths, static_cast<std::uint64_t>(i));
    paths_.follow(ray, hit, branch_key, [&](const LightArrival& at) {
      if (at.through_panes_only) return;
      deposits.push_back({at.position, at.hit.element, at.throughput * power});
    });
  }

 private:
  std::optional<SourceRay> aimed(const Beam& beam, const Eigen::Array4f& u) const {
    const SpecularTarget& target = targets_.target(beam.target);
    if (beam.source.free) {
      return source_ray_towards(*beam.source.free, target.center, target.radius, u);
    }
    const SourcePoint from = source_point(beam.source, u[0], u[1]);
    const auto aimed = aimed_ray(aim_at(target, from.position), from.normal, u[2], u[3]);
    if (!aimed) return std::nullopt;
    const Emitter& emitter = *beam.source.emitter;
    return SourceRay{.ray = {.origin = from.position,
                             .direction = aimed->direction,
                             .origin_group = emitter.facet},
                     .weight = emitter.area * aimed->share};
  }

  const ElementCaster& caster_;
  const LightPaths& paths_;
  const SpecularTargets& targets_;
  SobolPoints sobol_;
};

// A range of a beam's photons.
struct BeamPiece {
  int beam = 0, begin = 0, end = 0;
};

std::vector<BeamPiece> cut_into_pieces(const std::vector<Beam>& beams) {
  constexpr int most = 1024;
  std::vector<BeamPiece> pieces;
  for (int b = 0; b < static_cast<int>(beams.size()); ++b) {
    const int count = beams[static_cast<std::size_t>(b)].count;
    for (int i = 0; i < count; i += most) pieces.push_back({b, i, std::min(i + most, count)});
  }
  return pieces;
}

CausticPhotons join(const std::vector<std::vector<Deposit>>& lists, int bands) {
  std::size_t count = 0;
  for (const auto& list : lists) count += list.size();
  CausticPhotons photons;
  photons.position.reserve(count);
  photons.element.reserve(count);
  photons.power.resize(static_cast<Eigen::Index>(count), bands);
  for (const auto& list : lists) {
    for (const Deposit& deposit : list) {
      photons.power.row(static_cast<Eigen::Index>(photons.count())) = deposit.power.transpose();
      photons.position.push_back(deposit.position);
      photons.element.push_back(deposit.element);
    }
  }
  return photons;
}

}  // namespace

CausticPhotons shoot_photons(const LitScene& lit, int count, int max_specular_depth,
                             const Progress& progress) {
  if (count < 1 || count > most_photons) {
    throw std::invalid_argument(
        fmt::format("{} photons; there must be between 1 and {}", count, most_photons));
  }
  const int bands = lit.scene.bands.count();
  const LightPaths paths(lit.scene, lit.caster, max_specular_depth, PathDetail::points);
  const SpecularTargets targets(lit.scene);
  std::vector<Beam> beams = make_beams(lit.direct_light, targets);
  if (beams.empty()) return {.power = BandArray(0, bands)};
  share_out(beams, count);
  const auto more = [](const Beam& a, const Beam& b) { return a.count < b.count; };
  const PhotonGun gun(lit.caster, paths, targets,
                      std::max(1, std::max_element(beams.begin(), beams.end(), more)->count));
  const std::vector<BeamPiece> pieces = cut_into_pieces(beams);
  std::vector<std::vector<Deposit>> lists(pieces.size());
  const int all = static_cast<int>(pieces.size());
  constexpr int slice = 64;  // a fraction of a second
  for (int first = 0; first < all; first += slice) {
    report(progress, "photons", static_cast<double>(first) / all);
    parallel_for(std::min(slice, all - first), 1, [&](int begin, int end) {
      for (int p = first + begin; p < first + end; ++p) {
        const BeamPiece& piece = pieces[static_cast<std::size_t>(p)];
        for (int i = piece.begin; i < piece.end; ++i) {
          gun.shoot(beams[static_cast<std::size_t>(piece.beam)], piece.beam, i,
                    lists[static_cast<std::size_t>(p)]);
        }
      }
    });
  }
  report(progress, "photons", 1.0);
  CausticPhotons photons = join(lists, bands);
  for (const Beam& beam : beams) photons.sent += beam.count;
  return photons;
}

}  // namespace lightwell
