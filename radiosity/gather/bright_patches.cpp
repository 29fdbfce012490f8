#include "radiosity/gather/bright_patches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/round_grid.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Mean radiosity of an element's corners, columns added.
double brightness(const PatchMesh& mesh, const BandArray& radiosity, int element) {
  double sum = 0.0;
  const int corners = mesh.corner_count(element);
  for (int c = 0; c < corners; ++c) {
    sum += static_cast<double>(radiosity.row(mesh.corners[element][c]).sum());
  }
  return std::max(sum / corners, 0.0);
}

std::array<double, 2> triangle_areas(const PatchMesh& mesh, int element) {
  const auto& corners = mesh.corners[element];
  const Eigen::Vector3d first = mesh.position(corners[0]);
  std::array<double, 2> area{};
  for (int i = 2; i < mesh.corner_count(element); ++i) {
    area[static_cast<std::size_t>(i) - 2] =
        0.5 *
        (mesh.position(corners[i - 1]) - first).cross(mesh.position(corners[i]) - first).norm();
  }
  return area;
}

// The least brightness of a bright patch, W/m^2. The median is that of the lit area, so that backs
// of walls and rooms behind closed doors do not lower it. The mean is a second bound: where half of
// the lit area is nearly dark, the other half is not what rays miss.
double least_brightness(const PatchMesh& mesh, const Eigen::ArrayXd& mean) {
  std::vector<int> lit;
  double area = 0.0, power = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (!(mean[p] > 0.0)) continue;
    lit.push_back(p);
    area += mesh.area[p];
    power += mesh.area[p] * mean[p];
  }
  std::sort(lit.begin(), lit.end(),
            [&](int a, int b) { return std::pair(mean[a], a) < std::pair(mean[b], b); });
  double up_to = 0.0;
  for (const int p : lit) {
    up_to += mesh.area[p];
    if (up_to < 0.5 * area) continue;
    return std::max(BrightPatches::times_median * mean[p],
                    BrightPatches::times_mean * power / area);
  }
  return 0.0;
}

// Finds by rays from a bright patch what they meet.
void look_around(const ElementCaster& caster, const std::vector<char>& is_bright,
                 BrightPatch& bright) {
  // A share is known to a tenth by 32 rays, as well as the view's approximate form factors.
  constexpr int rays = 32;
  const PatchSampler sampler(caster.mesh(), bright.patch);
  const SobolPoints sobol(rays);
  const std::uint64_t key =
      random_key(static_cast<std::uint64_t>(bright.patch), RandomPurpose::bright_openness);
  std::array<Ray, rays> ray;
  std::array<ElementHit, rays> hit;
  for (int i = 0; i < rays; ++i) {
    const Eigen::Array4f u = sobol.point(i, key);
    const PatchPoint at = sampler.point(double{u[0]}, double{u[1]});
    ray[static_cast<std::size_t>(i)] = cosine_ray(caster.mesh(), at, u[2], u[3]);
  }
  caster.closest_elements(ray, hit);
  int open = 0;
  for (const ElementHit& h : hit) {
    const int met = h.element < 0 ? -1 : caster.mesh().patch[h.element];
    if (met >= 0 && is_bright[static_cast<std::size_t>(met)] != 0) {
      bright.met.push_back(met);
    } else {
      ++open;
    }
  }
  std::ranges::sort(bright.met);
  bright.met.erase(std::unique(bright.met.begin(), bright.met.end()), bright.met.end());
  bright.openness = static_cast<double>(std::max(open, 1)) / rays;
}

// Patches whose RMS brightness is above `least`, in rising order; `square` is the mean square of
// each. If there are more than BrightPatches::most, those with the largest mean square times area
// of what points of the room see, which leave the most noise.
std::vector<BrightPatch> choose_bright(const Scene& scene, const ElementCaster& caster,
                                       const Eigen::ArrayXd& square, double least) {
  constexpr int most = BrightPatches::most;
  const PatchMesh& mesh = caster.mesh();
  std::vector<BrightPatch> bright;
  std::vector<char> is_bright(static_cast<std::size_t>(mesh.patch_count()), 0);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const Surface& surface = scene.surfaces[static_cast<std::size_t>(mesh.surface[p])];
    if (surface.motion >= 0) continue;
    if (!(std::sqrt(square[p]) > least)) continue;
    bright.push_back({p});
    is_bright[static_cast<std::size_t>(p)] = 1;
  }
  parallel_for(static_cast<int>(bright.size()), 16, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      look_around(caster, is_bright, bright[static_cast<std::size_t>(i)]);
    }
  });
  if (bright.size() > static_cast<std::size_t>(most)) {
    const auto noise = [&](const BrightPatch& b) {
      return std::pair(-square[b.patch] * mesh.area[b.patch] * b.openness, b.patch);
    };
    const auto noisier = [&](const BrightPatch& a, const BrightPatch& b) {
      return noise(a) < noise(b);
    };
    std::nth_element(bright.begin(), bright.begin() + most, bright.end(), noisier);
    bright.resize(static_cast<std::size_t>(most));
    std::ranges::sort(bright, {}, &BrightPatch::patch);
  }
  return bright;
}

}  // namespace

BrightPatches::BrightPatches(const Scene& scene, const ElementCaster& caster,
                             const BandArray& radiosity)
    : mesh_(&caster.mesh()) {
  const PatchMesh& mesh = *mesh_;
  const int count = mesh.patch_count();
  std::vector<double> of_element(static_cast<std::size_t>(mesh.element_count()));
  Eigen::ArrayXd mean(count), square(count);
  for (int p = 0; p < count; ++p) {
    double sum = 0.0, sum2 = 0.0, area = 0.0;
    for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
      const double B = brightness(mesh, radiosity, e);
      of_element[static_cast<std::size_t>(e)] = B;
      sum += mesh.element_area[e] * B;
      sum2 += mesh.element_area[e] * B * B;
      area += mesh.element_area[e];
    }
    mean[p] = area > 0.0 ? sum / area : 0.0;
    square[p] = area > 0.0 ? sum2 / area : 0.0;
  }
  const std::vector<BrightPatch> bright =
      choose_bright(scene, caster, square, least_brightness(mesh, mean));
  if (bright.empty()) return;
  of_element_.assign(of_element.size(), -1);
  cavities_ = find_cavities(caster, bright, of_element);
  for (const BrightPatch& b : bright) add_patch(b, of_element);
}

void BrightPatches::add_patch(const BrightPatch& bright, const std::vector<double>& of_element) {
  const PatchMesh& mesh = *mesh_;
  const int p = bright.patch;
  Patch patch{.openness = bright.openness, .first = static_cast<int>(elements_.size())};
  const auto& cavities = cavities_.cavities;
  const auto own = std::ranges::find_if(cavities, [&](const BrightCavity& cavity) {
    return std::ranges::binary_search(cavity.patches, p);
  });
  if (own != cavities.end()) patch.cavity = static_cast<int>(own - cavities.begin());
  const RoundGrid* const grid = round_grid_of(mesh, mesh.facet[mesh.first_element[p]]);
  if (PatchSampler(mesh, p).is_flat())
    patch.normal = element_center(mesh, mesh.first_element[p]).normal;
  for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
    const auto [first, second] = triangle_areas(mesh, e);
    const double area = grid ? mesh.element_area[e] : first + second;
    const double power = area * of_element[static_cast<std::size_t>(e)];
    patch.area += area;
    patch.center += area * element_center(mesh, e).position;
    if (!(power > 0.0)) continue;
    patch.power += power;
    of_element_[static_cast<std::size_t>(e)] = static_cast<int>(elements_.size());
    patch_of_.push_back(static_cast<int>(patches_.size()));
    elements_.push_back({.number = e,
                         .up_to = patch.power,
                         .share_per_area = of_element[static_cast<std::size_t>(e)],
                         .normal = element_center(mesh, e).normal,
                         .round = grid ? static_cast<int>(round_.size()) : -1});
    if (grid) round_.push_back({grid->shape, PatchSampler(mesh, p, e)});
  }
  patch.center /= patch.area;
  for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const Eigen::Vector3d to = mesh.position(mesh.corners[e][c]) - patch.center;
      patch.radius2 = std::max(patch.radius2, to.squaredNorm());
    }
  }
  patch.end = static_cast<int>(elements_.size());
  for (int i = patch.first; i < patch.end; ++i) {
    elements_[static_cast<std::size_t>(i)].up_to /= patch.power;
    elements_[static_cast<std::size_t>(i)].share_per_area /= patch.power;
  }
  patches_.push_back(patch);
}

namespace {

// Cosine-distributed rays that meet a patch or a cavity, from which number on they leave less noise
// than aimed ones would.
constexpr double few = 4.0;

}  // namespace

BrightPatches::View BrightPatches::view(const Eigen::Vector3d& from, const Eigen::Vector3d& normal,
                                        int rays) const {
  // Least height of the point above the patch's plane, as a share of the patch's radius. From lower
  // points the patch is seen edge-on.
  constexpr double least_height = 1e-4;
  // Draws towards the patches themselves of a cavity, as a share of what they would be without a
  // mouth: for what is seen beside the mouth. A ray that no draw stands for would be a blotch.
  constexpr double beside_mouth = 0.25;
  View view;
  view.from_ = from;
  view.up_to_.reserve(patches_.size() + cavities_.mouths.size());
  std::vector<char> sees_mouth(cavities_.cavities.size(), 0);
  for (std::size_t m = 0; m < cavities_.mouths.size(); ++m) {
    const CavityMouth& mouth = cavities_.mouths[m];
    if (!mouth.is_before(from)) continue;
    view.mouths_.push_back(static_cast<int>(m));
    sees_mouth[static_cast<std::size_t>(mouth.cavity)] = 1;
  }
  double sum = 0.0;
  for (const Patch& patch : patches_) {
    const Eigen::Vector3d to = patch.center - from;
    const double distance2 = to.squaredNorm(), distance = std::sqrt(distance2),
                 radius = std::sqrt(patch.radius2);
    const double height = patch.normal.isZero() ? distance : -patch.normal.dot(to);
    const double rise = to.dot(normal) + radius;  // bound for the patch's highest point
    const bool by_mouth =
        patch.cavity >= 0 && sees_mouth[static_cast<std::size_t>(patch.cavity)] != 0;
    if (height > least_height * radius && rise > 0.0) {
      // Approximate solid angle, sr, and form factor from the point to the patch.
      const double solid = std::min(height + 0.1 * radius, distance + radius) * patch.area /
                           ((distance2 + patch.radius2) * (distance + radius));
      const double form_factor =
          std::min(rise / (distance + radius), 1.0) * solid * std::numbers::inv_pi;
      sum += (by_mouth ? beside_mouth : 1.0) * patch.openness * patch.power / patch.area *
             form_factor / (1.0 + rays * form_factor / few);
    }
    view.up_to_.push_back(static_cast<float>(sum));
  }
  sum = add_mouths(normal, rays, sum, view);
  if (!(sum > 0.0)) return {};
  for (float& up_to : view.up_to_) up_to = static_cast<float>(up_to / sum);
  view.up_to_.back() = 1.0f;
  return view;
}

// Adds what the mouths give that the point lies before. Returns the sum of what all give.
double BrightPatches::add_mouths(const Eigen::Vector3d& normal, int rays, double sum,
                                 View& view) const {
  view.up_to_.resize(patches_.size() + cavities_.mouths.size());
  for (std::size_t m = 0; m < cavities_.mouths.size(); ++m) {
    const CavityMouth& mouth = cavities_.mouths[m];
    const Eigen::Vector3d to = mouth.center - view.from_;
    const double distance = to.norm(), rise = to.dot(normal) + mouth.radius;
    if (mouth.is_before(view.from_) && rise > 0.0) {
      const double slant = std::min(rise / (distance + mouth.radius), 1.0);
      const double E = mouth.intensity(-to / distance) * slant /
                       (distance * distance + mouth.radius * mouth.radius);
      // The form factor of the bright part alone, seen through the mouth.
      const double form_factor =
          E / cavities_.cavities[static_cast<std::size_t>(mouth.cavity)].brightness;
      sum += E / (1.0 + rays * form_factor / few);
    }
    view.up_to_[patches_.size() + m] = static_cast<float>(sum);
  }
  return sum;
}

BrightPatches::Aim BrightPatches::draw(const View& view, double which, double u, double v) const {
  const auto& up_to = view.up_to_;
  const auto place =
      std::min<std::ptrdiff_t>(std::upper_bound(up_to.begin(), up_to.end(), which) - up_to.begin(),
                               static_cast<std::ptrdiff_t>(up_to.size()) - 1);
  const auto p = static_cast<std::size_t>(place);
  if (p >= patches_.size()) {
    const CavityMouth& mouth = cavities_.mouths[p - patches_.size()];
    return {.direction = (mouth.point(u, v) - view.from_).normalized()};
  }
  const double before = p > 0 ? up_to[p - 1] : 0.0;
  const double within = std::clamp((which - before) / (up_to[p] - before), 0.0, 1.0);
  const Patch& patch = patches_[p];
  const auto begin = elements_.begin() + patch.first, last = elements_.begin() + patch.end - 1;
  const auto found = std::upper_bound(
      begin, last, within, [](double x, const Element& element) { return x < element.up_to; });
  const Eigen::Vector3d to = point_on(*found, u, v) - view.from_;
  const double distance = to.norm();
  return {.direction = to / distance,
          .element = found->number,
          .distance = found->round >= 0 ? distance : 0.0};
}

bool BrightPatches::counts(const Aim& aim, const ElementHit& hit) const {
  if (hit.element < 0) return false;
  if (aim.element < 0) return is_bright(hit.element);
  // A hundred times the rounding of a hit's distance.
  constexpr double rounding = 1e-5;
  return hit.element == aim.element &&
         (aim.distance == 0.0 || std::abs(hit.t - aim.distance) <= rounding * aim.distance);
}

// A point uniform over the element's area.
Eigen::Vector3d BrightPatches::point_on(const Element& element, double u, double v) const {
  if (element.round >= 0) {
    return round_[static_cast<std::size_t>(element.round)].points.position(u, v);
  }
  const auto [first, second] = triangle_areas(*mesh_, element.number);
  double along = v * (first + second);
  const bool is_second = along >= first;
  along = is_second ? (along - first) / second : along / first;
  const auto& corners = mesh_->corners[element.number];
  const std::size_t i = is_second ? 2 : 1;
  const Eigen::Vector3d a = mesh_->position(corners[0]), b = mesh_->position(corners[i]),
                        c = mesh_->position(corners[i + 1]);
  const double s = std::sqrt(along);  // uniform over the triangle
  return a + s * ((1.0 - u) * (b - a) + u * (c - a));
}

Eigen::Vector3d BrightPatches::normal_at(const Element& element,
                                         const Eigen::Vector3d& point) const {
  if (element.round < 0) return element.normal;
  return front_normal(round_[static_cast<std::size_t>(element.round)].shape, point);
}

double BrightPatches::density(const View& view, int element, const Eigen::Vector3d& direction,
                              double distance) const {
  const int number = of_element_[static_cast<std::size_t>(element)];
  if (number < 0) return 0.0;
  const Element& at = elements_[static_cast<std::size_t>(number)];
  const auto p = static_cast<std::size_t>(patch_of_[static_cast<std::size_t>(number)]);
  const double cosine = std::abs(direction.dot(normal_at(at, view.from_ + distance * direction)));
  // Bounds the density where the element is seen edge-on and has no solid angle.
  constexpr double grazing = 1e-9;
  double density =
      view.chance(p) * at.share_per_area * distance * distance / std::max(cosine, grazing);
  for (const int m : view.mouths_) {
    const CavityMouth& mouth = cavities_.mouths[static_cast<std::size_t>(m)];
    const double falling = -direction.dot(mouth.normal);
    if (!(falling > grazing)) continue;
    const double to_mouth = mouth.normal.dot(view.from_ - mouth.center) / falling;
    const Eigen::Vector3d through = view.from_ + to_mouth * direction;
    if ((through - mouth.center).squaredNorm() > mouth.radius * mouth.radius) continue;
    density += view.chance(patches_.size() + static_cast<std::size_t>(m)) * to_mouth * to_mouth /
               (falling * mouth.area());
  }
  return density;
}

double BrightPatches::share(const View& view, double cosine, int rays, const Ray& ray,
                            const ElementHit& hit, double others) const {
  const bool counts = !view.is_empty() && hit.element >= 0 && is_bright(hit.element);
  if (!counts && !(others > 0.0)) return 1.0;
  const double by_cosine = rays * std::max(cosine, 0.0) * std::numbers::inv_pi;
  double all = by_cosine + others;
  if (counts) all += aimed(rays) * density(view, hit.element, ray.direction, hit.t);
  return all > 0.0 ? by_cosine / all : 0.0;
}

}  // namespace lightwell
