#include "radiosity/paths/light_path.h"

#include <Eigen/Geometry>
#include <cmath>

#include "mesh/patches/patch_patterns.h"
#include "radiosity/visibility/absorbing_bodies.h"
#include "scene/facet_normals.h"
#include "scene/facet_textures.h"
#include "scene/optics.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"
#include "scene/specular.h"

namespace lightwell {

bool takes_diffuse_light(const Material& material) {
  return material.is_diffuse() || material.is_emitter() || !material.is_specular();
}

/// Light along a path.
struct LightPaths::PathLight {
  Media media{};
  Spectrum throughput{};
  Polarisation polarisation{};
  double radiance_scale = 1.0;  ///< product over the surfaces crossed
  bool through_panes_only = true;
  /// The throughput of a quantity.
  Spectrum of(PathQuantity quantity) const {
    return quantity == PathQuantity::power
               ? throughput
               : Spectrum(static_cast<float>(radiance_scale) * throughput);
  }
};

LightPaths::LightPaths(const Scene& scene, const ElementCaster& caster, int max_depth,
                       PathDetail detail, PathArrivals arrivals)
    : scene_(scene),
      caster_(caster),
      max_depth_(max_depth),
      detail_(detail),
      arrivals_(arrivals),
      patterns_(caster.mesh().patterns),
      bases_(scene.materials),
      round_(scene) {
  if (patterns_) textures_ = caster.mesh().textures;
  if (detail == PathDetail::points) smooth_ = std::make_shared<const FacetNormals>(scene);
  for (const FacetRef& ref : scene_facets(scene)) {
    const Surface& surface = scene.surfaces[ref.surface];
    const Material& material = scene.materials[surface.material];
    const auto* polygons = std::get_if<PolygonMesh>(&surface.shape);
    material_.push_back(surface.material);
    specular_.push_back(material.is_specular());
    diffuse_.push_back(takes_diffuse_light(material));
    normal_.push_back(polygons ? facet_normal(*polygons, polygons->facets[ref.facet])
                               : Eigen::Vector3d::Zero());
    has_specular_ = has_specular_ || material.is_specular();
    absorbs_ = absorbs_ || (material.dielectric && (material.dielectric->absorption > 0.0f).any());
  }
  if (absorbs_) bodies_ = AbsorbingBodies::find(scene, caster);
}

bool LightPaths::is_mostly_diffuse(int facet) const {
  return !is_specular(facet) || scene_.materials[material_[facet]].mirrors_by_coat();
}

const Material& LightPaths::material_at(const ElementCaster& caster, const ElementHit& hit,
                                        const Eigen::Vector3d& point,
                                        std::optional<Material>& own) const {
  const Material& even = scene_.materials[material_[hit.facet]];
  if (!textures_ || !textures_->has_pattern(hit.facet)) return even;
  const Eigen::Isometry3d* pose = caster.pose_of(hit.facet);
  const Eigen::Vector3d rest = pose ? Eigen::Vector3d(pose->inverse() * point) : point;
  if (detail_ == PathDetail::points || even.dielectric) {
    own = textures_->material(hit.facet, rest);
    return *own;
  }
  own = patterns_->mirror_of(even, caster.mesh().patch[hit.element]);
  own->specular_roughness = textures_->roughness(hit.facet, rest);
  return *own;
}

// The normal, unit, on the side that the light comes from.
Eigen::Vector3d LightPaths::normal_at(const ElementCaster& caster, const ElementHit& hit,
                                      const Eigen::Vector3d& point) const {
  const Eigen::Isometry3d* pose = caster.pose_of(hit.facet);
  Eigen::Vector3d normal = normal_[hit.facet];
  if (normal.isZero()) {
    if (const RoundShape* shape = round_.of(hit.facet)) {
      normal = front_normal(*shape, pose ? pose->inverse() * point : point);
    }
  }
  if (pose) normal = pose->linear() * normal;
  return hit.from_back ? Eigen::Vector3d(-normal) : normal;
}

double LightPaths::base_factor(const ElementCaster& caster, const Ray& ray,
                               const ElementHit& hit) const {
  if (bases_.empty()) return 1.0;
  const CoatedBase* base = bases_.of(material_[hit.facet]);
  if (!base) return 1.0;
  std::optional<CoatedBase> own;
  if (patterns_ && hit.element >= 0) {
    const int patch = caster.mesh().patch[hit.element];
    if (patterns_->is_given(patch)) own = patterns_->base_of(patch);
    if (own) base = &*own;
  }
  const Eigen::Vector3d normal = normal_at(caster, hit, ray.origin + hit.t * ray.direction);
  return base->factor(-normal.dot(ray.direction.normalized()));
}

Spectrum LightPaths::left_by_body(const Ray& ray, const ElementHit& hit) const {
  const Spectrum* absorption = bodies_ ? bodies_->before(caster_.mesh(), hit) : nullptr;
  return absorption ? left_after(*absorption, hit.t * ray.direction.norm()) : Spectrum();
}

bool LightPaths::dims_before(int patch) const {
  return bodies_ && bodies_->before_patch(patch) != nullptr;
}

bool LightPaths::continue_at(const ElementCaster& caster, Ray& ray, const ElementHit& hit,
                             std::uint64_t key, PathLight& light, PathLosses& losses) const {
  // The back of a one-sided mirror is black; glass is clear from both sides.
  if (!scene_.materials[material_[hit.facet]].dielectric && hit.element < 0) {
    losses.escaped += light.throughput;
    return false;
  }
  const Eigen::Vector3d point = ray.origin + hit.t * ray.direction;
  std::optional<Material> own;
  const Material& material = material_at(caster, hit, point, own);
  const Eigen::Isometry3d* pose = caster.pose_of(hit.facet);
  const Eigen::Vector3d normal = normal_at(caster, hit, point);
  const Eigen::Vector3d direction = ray.direction.normalized();
  const bool is_smooth = smooth_ && smooth_->is_given(hit.facet);
  Eigen::Vector3d bent = normal;
  if (is_smooth && !pose) {
    bent = smooth_->at(hit.facet, point, normal);
  } else if (is_smooth) {
    bent = pose->linear() *
           smooth_->at(hit.facet, pose->inverse() * point, pose->linear().transpose() * normal);
  }
  if (is_smooth) bent = visible_normal(direction, normal, bent);
  ScatteringRandom random{.component = random_uniform(key), .key = key};
  if (material.gloss_roughness() > 0.0f) {
    random.u = random_uniform(random_key(key, RandomPurpose::path_microfacets, 1));
    random.v = random_uniform(random_key(key, RandomPurpose::path_microfacets, 2));
  }
  const ScatteringSample sample = sample_scattering({.material = material,
                                                     .direction = direction,
                                                     .normal = bent,
                                                     .from_back = hit.from_back,
                                                     .polarisation = light.polarisation},
                                                    random);
  light.media.cross(material_[hit.facet], material, sample, hit.from_back);
  light.radiance_scale *= radiance_scale(material, sample.crosses, hit.from_back);
  light.polarisation = sample.polarisation;
  light.through_panes_only = light.through_panes_only && sample.crosses && is_clear_pane(material);
  // Light that a partly diffuse surface does not mirror arrives at its diffuse side, which the
  // caller counts.
  if (!diffuse_[hit.facet]) losses.absorbed += light.throughput * (1.0f - sample.weight);
  light.throughput *= sample.weight;
  ray = {.origin = point,
         .direction =
             is_smooth ? on_its_side(sample.direction, normal, sample.crosses) : sample.direction,
         .origin_group = hit.facet};
  return (light.throughput > 0.0f).any();
}

void LightPaths::absorb(const Ray& ray, const ElementHit& hit, PathLight& light,
                        PathLosses& losses) const {
  if (!absorbs_ || hit.facet < 0) return;
  Spectrum passed =
      light.media.passed(scene_, material_[hit.facet], hit.from_back, hit.t * ray.direction.norm());
  if (light.media.is_empty()) {
    const Spectrum left = left_by_body(ray, hit);
    if (left.size() > 0) passed *= left;
  }
  losses.absorbed += light.throughput * (1.0f - passed);
  light.throughput *= passed;
}

// Ends paths weaker than `weak` by chance (Arvo & Kirk 1990), and strengthens the others. What is
// lost and won counts as absorbed, so that the shares of each path still add up to 1.
bool LightPaths::survives(std::uint64_t key, float weak, PathLight& light,
                          PathLosses& losses) const {
  const float strongest = light.throughput.maxCoeff();
  if (!(strongest < weak)) return true;
  const float chance = strongest / weak;
  const bool is_over = random_uniform(random_key(key, RandomPurpose::path_microfacets, 3)) >=
                       static_cast<double>(chance);
  const Spectrum left = is_over ? Spectrum(Spectrum::Zero(light.throughput.size()))
                                : Spectrum(light.throughput / chance);
  losses.absorbed += light.throughput - left;
  light.throughput = left;
  return !is_over;
}

PathLosses LightPaths::follow(const Ray& ray, const ElementHit& hit, std::uint64_t key,
                              const std::function<void(const LightArrival&)>& arrive,
                              PathQuantity quantity) const {
  return follow(caster_, ray, hit, key, arrive, quantity);
}

PathLosses LightPaths::follow(const ElementCaster& caster, const Ray& first_ray,
                              const ElementHit& first_hit, std::uint64_t key,
                              const std::function<void(const LightArrival&)>& arrive,
                              PathQuantity quantity) const {
  const int bands = scene_.bands.count();
  PathLosses losses{Spectrum::Zero(bands), Spectrum::Zero(bands), Spectrum::Zero(bands), {}};
  PathLight light{.throughput = Spectrum::Ones(bands)};
  const Spectrum& throughput = light.throughput;
  Ray ray = first_ray;
  ElementHit hit = first_hit;
  absorb(ray, hit, light, losses);
  for (int depth = 0;; ++depth) {
    const Material& met = scene_.materials[material_[hit.facet]];
    if (depth >= deepest_path(max_depth_)) {
      losses.cut += throughput;
      return losses;
    }
    const std::uint64_t key_here = random_key(key, static_cast<std::uint64_t>(depth));
    if (!continue_at(caster, ray, hit, key_here, light, losses)) return losses;
    // A coat mirrors 4 % of steep light. Such paths go on, so that base and coat of a white surface
    // add up to all light for every ray; paths by way of two coats end by chance.
    constexpr float weak = 0.125f, weak_behind_coats = 0.03125f;
    const bool is_deep = depth >= max_depth_;
    if ((is_deep || met.mirrors_by_coat()) &&
        !survives(key_here, is_deep ? weak : weak_behind_coats, light, losses)) {
      return losses;
    }
    caster.closest_hits({&ray, 1}, {&hit, 1});
    absorb(ray, hit, light, losses);
    const bool leaves = hit.facet < 0 || (hit.element < 0 && !is_specular(hit.facet));
    if (leaves) {
      losses.escaped += light.of(quantity);
      if (hit.facet < 0 && !light.through_panes_only) {
        losses.exit = ray.direction.normalized();
        if (scene_.sky) losses.sky = light.of(quantity) * sky_radiance(*scene_.sky, losses.exit);
      }
      return losses;
    }
    const bool arrives = is_diffuse(hit.facet) || arrivals_ == PathArrivals::all;
    if (arrives && hit.element >= 0) {
      arrive({.hit = hit,
              .throughput = light.of(quantity),
              .base_factor = base_factor(caster, ray, hit),
              .position = ray.origin + hit.t * ray.direction,
              .through_panes_only = light.through_panes_only});
    }
    if (!is_specular(hit.facet)) return losses;
  }
}

PathLosses LightPaths::follow(const Ray& ray, const ElementHit& hit, std::uint64_t key,
                              const std::function<void(const ElementHit&, const Spectrum&)>& arrive,
                              PathQuantity quantity) const {
  const auto without_place = [&](const LightArrival& at) {
    if (at.base_factor == 1.0) return arrive(at.hit, at.throughput);
    arrive(at.hit, static_cast<float>(at.base_factor) * at.throughput);
  };
  return follow(ray, hit, key, std::function<void(const LightArrival&)>(without_place), quantity);
}

}  // namespace lightwell
