#include "raytrace/virtual_lights/virtual_light_paths.h"

#include <algorithm>
#include <cmath>

#include "mesh/patches/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Draws for each start of a path. The sum of the fluxes of sixteen times as many points has a
// quarter of the error, or less.
constexpr int draws_per_start = 16;

// A point of a surface that sends on light: its flux for each path that starts there, W.
struct Sender {
  PatchPoint point{};
  Spectrum flux{};
  int paths = 0;       // that start here
  int first_path = 0;  // the number of the first one among all paths
};

// The light that patches send on: a share of what arrives, and their own.
class Senders {
 public:
  explicit Senders(const LitScene& lit) : lit_(lit), mesh_(lit.mesh()) {
    for (int e = 0; e < mesh_.element_count(); ++e) {
      if (!sends(mesh_.patch[e])) continue;
      elements_.push_back(e);
      up_to_.push_back(area_ += mesh_.element_area[e]);
    }
  }

  double area() const { return area_; }
  /// The mean share of light that is sent on.
  double mean_reflectance() const {
    double sum = 0.0;
    for (const int e : elements_) {
      const int p = mesh_.patch[e];
      double share = mesh_.reflectance.row(p).mean();
      if (mesh_.patch_behind(p) >= 0) share += mesh_.transmittance.row(p).mean();
      sum += share * mesh_.element_area[e];
    }
    return area_ > 0.0 ? sum / area_ : 0.0;
  }

  PatchPoint draw(double which, double u, double v) const {
    const auto at = std::upper_bound(up_to_.begin(), up_to_.end() - 1, which * area_);
    const int e = elements_[static_cast<std::size_t>(at - up_to_.begin())];
    return PatchSampler(mesh_, mesh_.patch[e], e).point(u, v);
  }

  // B at a point without light that others reflect, W/m^2.
  Spectrum first_radiosity(const PatchPoint& point, const CausticMap* caustics,
                           std::uint64_t key) const {
    const int p = mesh_.patch[point.element], facet = mesh_.facet[point.element];
    Spectrum B = Spectrum::Zero(mesh_.emission.cols());
    if (!lit_.direct_light.owns(facet, mesh_.is_back[p] != 0))
      B = mesh_.emission.row(p).transpose();
    const Spectrum rho = mesh_.reflectance.row(p).transpose();
    if ((rho > 0.0f).any()) B += rho * irradiance(point, facet, caustics, key);
    const int behind = mesh_.patch_behind(p);
    if (behind < 0) return B;
    PatchPoint other = element_center(mesh_, mesh_.first_element[behind]);
    other.position = point.position;
    other.normal = -point.normal;
    const Spectrum tau = mesh_.transmittance.row(p).transpose();
    return B + tau * irradiance(other, facet, nullptr, random_key(key, 1));
  }

 private:
  bool sends(int patch) const {
    const auto emits = mesh_.emission.row(patch) > 0.0f;
    const int facet = mesh_.facet[mesh_.first_element[patch]];
    return (mesh_.reflectance.row(patch) > 0.0f).any() || mesh_.patch_behind(patch) >= 0 ||
           (emits.any() && !lit_.direct_light.owns(facet, mesh_.is_back[patch] != 0));
  }

  Spectrum irradiance(const PatchPoint& point, int facet, const CausticMap* caustics,
                      std::uint64_t key) const {
    const int material = mesh_.material[mesh_.patch[point.element]];
    Spectrum E = lit_.direct_light.irradiance(
        lit_.caster, {.at = {point.position, point.normal, facet},
                      .key = key,
                      .shadows = {.min_rays = 1, .max_rays = 1, .cluster_share = 0.05},
                      .base = lit_.direct_light.base_of(material)});
    if (caustics) E += caustics->irradiance(point.position, point.normal, point.element);
    return E;
  }

  const LitScene& lit_;
  const PatchMesh& mesh_;
  std::vector<int> elements_{};  // that send
  std::vector<double> up_to_{};  // running sum of their areas, m^2
  double area_ = 0.0;
};

// Draws points in the order of the elements. (Of points in the order of a Sobol sequence,
// systematic sampling in share_out() would take such as lie near each other.)
std::vector<Sender> draw_senders(const Senders& senders, const CausticMap* caustics, int count,
                                 std::uint64_t key) {
  std::vector<Sender> drawn(static_cast<std::size_t>(count));
  const auto share = static_cast<float>(senders.area() / count);
  constexpr int grain = 64;
  parallel_for(count, grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const auto own = random_key(key, static_cast<std::uint64_t>(i));
      const auto number = [&](std::uint64_t n) { return random_uniform(random_key(own, n)); };
      Sender& sender = drawn[static_cast<std::size_t>(i)];
      sender.point = senders.draw((i + number(1)) / count, number(2), number(3));
      sender.flux = share * senders.first_radiosity(sender.point, caustics, own);
    }
  });
  return drawn;
}

// Gives senders paths in proportion to the square root of their flux by systematic sampling, and
// shares out the flux among the paths. Paths of equal flux would leave too few lights in dim places
// for what lies near these.
void share_out(std::vector<Sender>& senders, int starts, std::uint64_t key) {
  const auto root = [](const Sender& s) { return std::sqrt(static_cast<double>(s.flux.mean())); };
  double all = 0.0;
  for (const Sender& sender : senders) all += root(sender);
  if (!(all > 0.0)) return;
  const double offset = random_uniform(random_key(key, 1));
  double before = 0.0;
  int paths = 0;
  for (Sender& sender : senders) {
    const double due = starts * root(sender) / all;
    const double after = before + due;
    sender.paths = static_cast<int>(std::floor(after + offset) - std::floor(before + offset));
    sender.first_path = paths;
    paths += sender.paths;
    if (due > 0.0) sender.flux /= static_cast<float>(due);
    before = after;
  }
}

// A way in which light that arrives somewhere is sent on.
struct Continuation {
  PatchPoint point{};
  Spectrum flux{};  // W
};

// Follows paths from one virtual light to the next.
class PathTracer {
 public:
  PathTracer(const LitScene& lit, const LightPaths& paths, double most)
      : lit_(lit), paths_(paths), most_(most) {}

  FreeSource light(const PatchPoint& point, const Spectrum& flux) const {
    return {.light = flux,
            .shape = VirtualLight{.position = point.position,
                                  .normal = point.normal,
                                  .facet = lit_.mesh().facet[point.element],
                                  .most = most_}};
  }

  // Adds the lights of path `path` of all behind its start.
  void follow(const Sender& start, int path, std::uint64_t key,
              std::vector<FreeSource>& lights) const {
    // Walls that reflect nearly all light end the path at last by chance.
    constexpr int most_bounces = 1000;
    Continuation at{start.point, start.flux};
    const float of_start = start.flux.mean();
    for (int bounce = 0; bounce < most_bounces; ++bounce) {
      const auto own =
          random_key(key, static_cast<std::uint64_t>(bounce), static_cast<std::uint64_t>(path));
      const auto number = [&](std::uint64_t i) { return random_uniform(random_key(own, i)); };
      const Ray ray = cosine_ray(lit_.mesh(), at.point, static_cast<float>(number(1)),
                                 static_cast<float>(number(2)));
      std::vector<Continuation> ways = ways_behind(ray, at.flux, own);
      float sum = 0.0f;
      for (const Continuation& way : ways) sum += way.flux.mean();
      if (!(sum > 0.0f)) return;
      // One of the ways goes on for all, and lights are about as strong as the start.
      float left = static_cast<float>(number(3)) * sum;
      std::size_t chosen = 0;
      while (chosen + 1 < ways.size() && left >= ways[chosen].flux.mean()) {
        left -= ways[chosen++].flux.mean();
      }
      at = ways[chosen];
      const float of_chosen = at.flux.mean(), survival = std::min(1.0f, sum / of_start);
      if (!(of_chosen > 0.0f) || number(4) >= static_cast<double>(survival)) return;
      at.flux *= sum / (of_chosen * survival);
      lights.push_back(light(at.point, at.flux));
    }
  }

 private:
  std::vector<Continuation> ways_behind(const Ray& ray, const Spectrum& flux,
                                        std::uint64_t key) const {
    std::vector<Continuation> ways;
    ElementHit hit;
    lit_.caster.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.facet < 0) return ways;
    if (hit.element >= 0 && paths_.is_diffuse(hit.facet)) {
      Spectrum arriving = static_cast<float>(paths_.base_factor(ray, hit)) * flux;
      const Spectrum left = paths_.left_by_body(ray, hit);
      if (left.size() > 0) arriving *= left;
      add(hit.element, ray.origin + hit.t * ray.direction, arriving, ways);
    }
    if (!paths_.is_specular(hit.facet)) return ways;
    paths_.follow(ray, hit, key, [&](const LightArrival& end) {
      if (end.hit.element < 0) return;
      add(end.hit.element, end.position,
          static_cast<float>(end.base_factor) * flux * end.throughput, ways);
    });
    return ways;
  }

  // Adds what the patch reflects, and what it lets through to the other side.
  void add(int element, const Eigen::Vector3d& position, const Spectrum& flux,
           std::vector<Continuation>& ways) const {
    const PatchMesh& mesh = lit_.mesh();
    const int p = mesh.patch[element], other = mesh.patch_behind(p);
    PatchPoint point = element_center(mesh, element);
    point.position = position;
    ways.push_back({point, flux * mesh.reflectance.row(p).transpose()});
    if (other < 0) return;
    PatchPoint behind = element_center(mesh, mesh.first_element[other]);
    behind.position = position;
    behind.normal = -point.normal;
    ways.push_back({behind, flux * mesh.transmittance.row(other).transpose()});
  }

  const LitScene& lit_;
  const LightPaths& paths_;
  double most_ = 0.0;
};

}  // namespace

double area_of_virtual_lights(const LitScene& lit) {
  return Senders(lit).area();
}

std::vector<FreeSource> find_virtual_lights(const LitScene& lit, const LightPaths& paths,
                                            const CausticMap* caustics, int count, double most,
                                            std::uint64_t key, const Progress& progress) {
  report(progress, "virtual lights", 0.0);
  const Senders sources(lit);
  if (!(sources.area() > 0.0)) return {};
  // A path has 1 / (1 - rho) lights in the mean.
  constexpr double fewest = 1.0 / 16.0;
  const double starts_share = std::max(fewest, 1.0 - sources.mean_reflectance());
  const int starts = std::max(1, static_cast<int>(std::lround(count * starts_share)));
  std::vector<Sender> senders = draw_senders(sources, caustics, draws_per_start * starts,
                                             random_key(key, RandomPurpose::virtual_light_points));
  report(progress, "virtual lights", 0.5);
  share_out(senders, starts, random_key(key, RandomPurpose::virtual_light_points, 1));
  const PathTracer tracer(lit, paths, most);
  std::vector<std::vector<FreeSource>> found(senders.size());
  constexpr int grain = 64;
  parallel_for(static_cast<int>(senders.size()), grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const auto s = static_cast<std::size_t>(i);
      const Sender& sender = senders[s];
      if (sender.paths == 0) continue;
      found[s].push_back(
          tracer.light(sender.point, static_cast<float>(sender.paths) * sender.flux));
      for (int path = 0; path < sender.paths; ++path) {
        tracer.follow(sender, sender.first_path + path,
                      random_key(key, RandomPurpose::virtual_light_paths), found[s]);
      }
    }
  });
  std::vector<FreeSource> lights;
  for (const auto& of_one : found) lights.insert(lights.end(), of_one.begin(), of_one.end());
  for (std::size_t i = 0; i < lights.size(); ++i) lights[i].number = static_cast<int>(i);
  report(progress, "virtual lights", 1.0);
  return lights;
}

}  // namespace lightwell
