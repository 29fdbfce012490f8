#include "radiosity/gather/gap_light.h"

#include <cmath>

#include "mesh/patches/patch_sampler.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Greatest width of a gap as a share of the size of a patch. (Elements that were refined in a gap
// are small, and still larger than the width over which light falls off.)
constexpr double widest = 0.15;
// Greatest cosine between the normals of surfaces that face each other.
constexpr double facing = -0.5;
// A path that is still in the gap after so many bounces reads the mesh.
constexpr int most_bounces = 16;
// Narrower gaps are contacts: which of two surfaces in one plane a ray meets is a matter of
// rounding.
constexpr double narrowest = 1e-4;
// Many rays end in a gap, so each needs one shadow ray to a light, whatever share of the light of
// its channel that is.
constexpr ShadowOptions shadows{.min_rays = 1, .max_rays = 1};

}  // namespace

GatherPoint moved_into_gap(const ElementCaster& caster, const Eigen::Vector3d& vertex, double inset,
                           const GatherPoint& point) {
  if (point.facet < 0) return point;
  const Eigen::Vector3d way = point.position - vertex;
  const double to_center = way.norm() / inset;
  constexpr double narrow = 0.3, nearest = 1e-4;  // shares of the way to the element's centre
  if (!(to_center > 0.0)) return point;
  const Ray ray{.origin = point.position,
                .direction = point.normal,
                .t_max = narrow * to_center,
                .origin_group = point.facet};
  ElementHit hit;
  caster.closest_elements({&ray, 1}, {&hit, 1});
  if (hit.element < 0 || !(hit.t > nearest * to_center)) return point;
  const Eigen::Vector3d normal = element_center(caster.mesh(), hit.element).normal;
  if (std::abs(normal.dot(point.normal)) < -facing) return point;
  GatherPoint moved = point;
  moved.position = vertex + std::max(1.0, hit.t / way.norm()) * way;
  return moved;
}

Eigen::Vector3d GapLight::normal_towards(const Ray& ray, const ElementHit& hit) const {
  const Eigen::Vector3d normal = element_center(lit_.mesh(), hit.element).normal;
  return normal.dot(ray.direction) > 0.0 ? Eigen::Vector3d(-normal) : normal;
}

bool GapLight::is_gap(const Eigen::Vector3d& normal, const Ray& ray, const ElementHit& hit) const {
  if (hit.element < 0) return false;
  const PatchMesh& mesh = lit_.mesh();
  const int patch = mesh.patch[hit.element];
  const double size = std::sqrt(mesh.area[patch]);
  // Surfaces that face each other are at most twice as far apart along one normal as along the
  // other. Most rays end here, before the other normal is needed.
  const double height = hit.t * std::abs(ray.direction.dot(normal));
  if (!(height < 2.0 * widest * size) || !may_be_followed(hit)) return false;
  const Eigen::Vector3d other = normal_towards(ray, hit);
  const double width = hit.t * std::abs(ray.direction.dot(other));
  return other.dot(normal) < facing && width < widest * size && width > narrowest * size;
}

// True if the surface reflects diffusely, and neither mirrors nor emits.
bool GapLight::may_be_followed(const ElementHit& hit) const {
  const PatchMesh& mesh = lit_.mesh();
  const int patch = mesh.patch[hit.element];
  return !paths_.is_specular(hit.facet) && !(mesh.emission.row(patch) > 0.0f).any() &&
         (mesh.reflectance.row(patch) > 0.0f).any();
}

bool GapLight::is_narrow(const ElementCaster& caster, const Ray& ray, const ElementHit& hit) const {
  if (hit.element < 0 || !may_be_followed(hit)) return false;
  const double size = std::sqrt(lit_.mesh().element_area[hit.element]);
  const Ray across{.origin = ray.origin + hit.t * ray.direction,
                   .direction = normal_towards(ray, hit),
                   .t_max = widest * size,
                   .origin_group = hit.facet};
  ElementHit opposite;
  caster.closest_hits({&across, 1}, {&opposite, 1});
  return opposite.element >= 0 && opposite.t > narrowest * size &&
         normal_towards(across, opposite).dot(across.direction) < facing;
}

void GapLight::add(const ElementCaster& caster, const Ray& first_ray, const ElementHit& first_hit,
                   std::uint64_t key, Eigen::ArrayXd& sum) const {
  const PatchMesh& mesh = lit_.mesh();
  const Eigen::Index bands = lit_.scene.bands.count(), columns = sum.size();
  const bool by_channel = lit_.direct_light.column_count() == columns;
  Spectrum share = Spectrum::Ones(bands);
  Ray ray = first_ray;
  ElementHit hit = first_hit;
  Eigen::ArrayXf E(columns);
  const auto add_columns = [&](const auto& value) {
    for (Eigen::Index k = 0; k < columns; k += bands) {
      sum.segment(k, bands) += (share * value(k)).template cast<double>();
    }
  };
  for (int bounce = 0; bounce < most_bounces; ++bounce) {
    const auto bounce_key =
        random_key(key, RandomPurpose::gap_rays, static_cast<std::uint64_t>(bounce));
    const Eigen::Vector3d normal = normal_towards(ray, hit);
    const SurfacePoint at{
        .position = ray.origin + hit.t * ray.direction, .normal = normal, .facet = hit.facet};
    // Paths end by chance (Arvo & Kirk 1990), at once or after as many bounces as light makes.
    const auto rho = mesh.reflectance.row(mesh.patch[hit.element]);
    const float survival = rho.maxCoeff();
    if (random_uniform(random_key(bounce_key, 3)) >= static_cast<double>(survival)) return;
    share *= rho.transpose() / survival;
    const LightQuery query{.at = at, .key = bounce_key, .shadows = shadows};
    if (by_channel) {
      E.setZero();
      lit_.direct_light.add_irradiance(caster, query, E.data());
    } else {
      E = lit_.direct_light.irradiance(caster, query);
    }
    add_columns([&](Eigen::Index k) { return E.segment(k, bands); });
    Eigen::Vector3d a, b;
    tangent_frame(normal, a, b);
    const Eigen::Vector3d d =
        cosine_direction(static_cast<float>(random_uniform(random_key(bounce_key, 1))),
                         static_cast<float>(random_uniform(random_key(bounce_key, 2))));
    ray = {.origin = at.position,
           .direction = d.x() * a + d.y() * b + d.z() * normal,
           .origin_group = at.facet};
    caster.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.facet < 0) return;
    if (bounce + 1 < most_bounces && is_gap(normal, ray, hit)) continue;
    const auto read = [&](const ElementHit& end) {
      for (int c = 0; c < mesh.corner_count(end.element); ++c) {
        const auto row = radiosity_.row(mesh.corners[end.element][c]);
        add_columns([&](Eigen::Index k) {
          return Spectrum(end.weights[c] * row.segment(k, bands).transpose());
        });
      }
    };
    if (hit.element >= 0 && paths_.is_diffuse(hit.facet)) read(hit);
    if (!paths_.is_specular(hit.facet)) return;
    paths_.follow(caster, ray, hit, bounce_key, [&](const LightArrival& arrival) {
      if (arrival.hit.element < 0) return;
      const Spectrum before = share;
      share *= arrival.throughput;
      read(arrival.hit);
      share = before;
    });
    return;
  }
}

}  // namespace lightwell
