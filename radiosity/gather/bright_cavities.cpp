#include "radiosity/gather/bright_cavities.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "mesh/patches/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr double pi = std::numbers::pi;

// Cell of a unit direction, in rings of equal height about z.
std::size_t cell_of(const Eigen::Vector3d& direction) {
  const auto step = [](double share, int count) {
    return std::clamp(static_cast<int>(share * count), 0, count - 1);
  };
  const int ring = step(0.5 * (direction.z() + 1.0), CavityMouth::rings);
  const double turn = std::atan2(direction.y(), direction.x()) / (2.0 * pi) + 0.5;
  return static_cast<std::size_t>(ring * CavityMouth::sectors + step(turn, CavityMouth::sectors));
}

int root_of(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    int& next = parent[static_cast<std::size_t>(i)];
    i = next = parent[static_cast<std::size_t>(next)];
  }
  return i;
}

// Groups of patches that see each other and little else.
std::vector<std::vector<int>> groups_of(const PatchMesh& mesh,
                                        const std::vector<BrightPatch>& bright) {
  // Aimed at one by one, more than half of the points of a more closed patch are hidden.
  constexpr double closed = 0.5;
  std::vector<int> parent(bright.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto place_of = [&](int patch) -> std::optional<int> {
    const auto found = std::ranges::lower_bound(bright, patch, {}, &BrightPatch::patch);
    if (found == bright.end() || found->patch != patch || !(found->openness < closed)) return {};
    return static_cast<int>(found - bright.begin());
  };
  std::vector<int> members;
  for (const BrightPatch& b : bright) {
    const auto i = place_of(b.patch);
    if (!i) continue;
    members.push_back(*i);
    for (const int met : b.met) {
      const auto other = place_of(met);
      if (other) parent[static_cast<std::size_t>(root_of(parent, *i))] = root_of(parent, *other);
    }
  }
  std::map<int, std::vector<int>> by_root;
  for (const int i : members) {
    by_root[root_of(parent, i)].push_back(bright[static_cast<std::size_t>(i)].patch);
  }
  std::vector<std::vector<int>> groups;
  for (auto& [root, group] : by_root) {
    // A single flat patch is closed in by others that are not.
    if (group.size() > 1 || !PatchSampler(mesh, group.front()).is_flat()) {
      groups.push_back(std::move(group));
    }
  }
  std::ranges::sort(groups);
  return groups;
}

// Rays from a cavity's patches, all of one power.
struct CavityRays {
  std::vector<Ray> out{};  // those that leave the cavity; directions of unit length
  double power = 0.0;      // of each ray, W
};

Sphere ball_around(const PatchMesh& mesh, const std::vector<int>& patches) {
  Eigen::AlignedBox3d box;
  const auto for_each_corner = [&](const auto& body) {
    for (const int p : patches) {
      for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
        for (int c = 0; c < mesh.corner_count(e); ++c) body(mesh.position(mesh.corners[e][c]));
      }
    }
  };
  for_each_corner([&](const Eigen::Vector3d& at) { box.extend(at); });
  Sphere ball{.center = box.center(), .radius = 0.0};
  for_each_corner([&](const Eigen::Vector3d& at) {
    ball.radius = std::max(ball.radius, (at - ball.center).norm());
  });
  return ball;
}

bool stays(const PatchMesh& mesh, const BrightCavity& cavity, const ElementHit& hit) {
  return hit.element >= 0 && std::ranges::binary_search(cavity.patches, mesh.patch[hit.element]);
}

// Casts rays from points of the patches by their light, and sets the cavity's brightness.
CavityRays cast_out(const ElementCaster& caster, const std::vector<double>& of_element, int rays,
                    BrightCavity& cavity) {
  const PatchMesh& mesh = caster.mesh();
  std::vector<int> elements;
  std::vector<double> power{0.0};
  for (const int p : cavity.patches) {
    for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
      const double B = of_element[static_cast<std::size_t>(e)], of_this = mesh.element_area[e] * B;
      elements.push_back(e);
      power.push_back(power.back() + of_this);
      cavity.brightness += of_this * B;
    }
  }
  if (!(power.back() > 0.0)) return {};
  cavity.brightness /= power.back();
  const SobolPoints sobol(rays);
  const std::uint64_t key = random_key(static_cast<std::uint64_t>(cavity.patches.front()),
                                       RandomPurpose::bright_openness, 1);
  std::vector<Ray> ray;
  ray.reserve(rays);
  for (int i = 0; i < rays; ++i) {
    const double wanted = SobolPoints::fifth(i, key) * power.back();
    const auto found = std::upper_bound(power.begin() + 1, power.end() - 1, wanted);
    const int e = elements[static_cast<std::size_t>(found - power.begin() - 1)];
    const Eigen::Array4f u = sobol.point(i, key);
    const PatchPoint at = PatchSampler(mesh, mesh.patch[e], e).point(double{u[0]}, double{u[1]});
    ray.push_back(cosine_ray(mesh, at, u[2], u[3]));
    ray.back().direction.normalize();
  }
  std::vector<ElementHit> hit(ray.size());
  caster.closest_elements(ray, hit);
  CavityRays found{.power = power.back() / rays};
  const Sphere ball = ball_around(mesh, cavity.patches);
  for (std::size_t i = 0; i < ray.size(); ++i) {
    // A ray may end on the bulb within.
    const Eigen::Vector3d end = ray[i].origin + hit[i].t * ray[i].direction;
    const bool is_out = hit[i].facet < 0 || (end - ball.center).norm() > ball.radius;
    if (is_out && !stays(mesh, cavity, hit[i])) found.out.push_back(ray[i]);
  }
  return found;
}

// The point at which a ray meets the plane of a mouth.
Eigen::Vector3d crossing(const Ray& ray, const CavityMouth& mouth) {
  const double t = mouth.normal.dot(mouth.center - ray.origin) / mouth.normal.dot(ray.direction);
  return ray.origin + t * ray.direction;
}

// The disc that rays are closest together in: at height h along their mean direction they cross the
// plane at a_i + h b_i, and sum |a_i + h b_i - mean|^2 is least at h = -cov(a, b) / var(b). None if
// the rays have no common direction.
std::optional<CavityMouth> waist_of(std::vector<Ray> rays) {
  // Rays all over a hemisphere, of even density, have a mean cosine of 1/2 about its axis.
  constexpr double least_mean = 0.5;
  // Rays that are nearly parallel to the plane would cross it far away.
  constexpr double steep = 0.1;
  if (rays.empty()) return {};
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Ray& ray : rays) mean += ray.direction / static_cast<double>(rays.size());
  if (!(mean.norm() >= least_mean)) return {};
  CavityMouth mouth{.normal = mean.normalized()};
  std::erase_if(rays, [&](const Ray& r) { return r.direction.dot(mouth.normal) < steep; });
  if (rays.empty()) return {};
  const auto count = static_cast<double>(rays.size());
  Eigen::Vector3d mean_a = Eigen::Vector3d::Zero(), mean_b = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> a, b;
  for (const Ray& ray : rays) {
    b.push_back(ray.direction / ray.direction.dot(mouth.normal) - mouth.normal);
    a.push_back(crossing(ray, mouth));
    mean_a += a.back() / count;
    mean_b += b.back() / count;
  }
  double covariance = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    covariance += (a[i] - mean_a).dot(b[i] - mean_b);
    variance += (b[i] - mean_b).squaredNorm();
  }
  const double h = variance > 0.0 ? -covariance / variance : 0.0;
  mouth.center = mean_a + h * (mean_b + mouth.normal);
  for (const Ray& ray : rays) {
    mouth.radius = std::max(mouth.radius, (crossing(ray, mouth) - mouth.center).norm());
  }
  return mouth;
}

// True if more than half of the directions through random points of the disc meet the cavity: aimed
// at points of the patches, fewer do.
bool leads_inside(const ElementCaster& caster, const BrightCavity& cavity,
                  const std::vector<Ray>& rays, const CavityMouth& mouth) {
  constexpr std::size_t most = 256;  // tell a half to 3 %
  std::vector<Ray> back;
  for (std::size_t i = 0; i < std::min(most, rays.size()); ++i) {
    const std::uint64_t key = random_key(i, RandomPurpose::bright_openness, 2);
    const Eigen::Vector3d at =
        mouth.point(random_uniform(random_key(key, 0)), random_uniform(random_key(key, 1)));
    // A start before the mouth, so that the ray passes a rim that stands out a little.
    constexpr double before = 0.1;
    back.push_back({.origin = at + before * mouth.radius * rays[i].direction,
                    .direction = -rays[i].direction});
  }
  std::vector<ElementHit> hit(back.size());
  caster.closest_elements(back, hit);
  const auto inside =
      std::ranges::count_if(hit, [&](const auto& h) { return stays(caster.mesh(), cavity, h); });
  return 2 * static_cast<std::size_t>(inside) > back.size();
}

void set_intensity(const std::vector<Ray>& rays, double power, CavityMouth& mouth) {
  // A cell that no ray met may still get light; with a tenth of the mean it keeps a few draws.
  constexpr double least = 0.1;
  constexpr double solid_angle = 4.0 * pi / (CavityMouth::rings * CavityMouth::sectors);
  for (const Ray& ray : rays) {
    mouth.cells[cell_of(ray.direction)] += static_cast<float>(power / solid_angle);
  }
  const double mean = power * static_cast<double>(rays.size()) / (4.0 * pi);
  for (float& cell : mouth.cells) cell = std::max(cell, static_cast<float>(least * mean));
}

// Rays that leave by either end of the axis along which most of them run, as from a shade that is
// open above and below.
std::array<std::vector<Ray>, 2> by_end(const std::vector<Ray>& rays) {
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (const Ray& ray : rays) moment += ray.direction * ray.direction.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment);
  const Eigen::Vector3d axis = solver.eigenvectors().col(2);
  std::array<std::vector<Ray>, 2> ends;
  for (const Ray& ray : rays) ends[ray.direction.dot(axis) < 0.0 ? 1 : 0].push_back(ray);
  return ends;
}

std::vector<CavityMouth> mouths_of(const ElementCaster& caster, const BrightCavity& cavity,
                                   const CavityRays& rays) {
  std::vector<CavityMouth> mouths;
  const auto add = [&](const std::vector<Ray>& out) {
    auto mouth = waist_of(out);
    if (!mouth || !(mouth->radius > 0.0) || !leads_inside(caster, cavity, out, *mouth)) return;
    set_intensity(out, rays.power, *mouth);
    mouths.push_back(*mouth);
  };
  add(rays.out);
  if (!mouths.empty()) return mouths;
  for (const std::vector<Ray>& end : by_end(rays.out)) add(end);
  return mouths;
}

}  // namespace

double CavityMouth::area() const {
  return pi * radius * radius;
}

Eigen::Vector3d CavityMouth::point(double u, double v) const {
  Eigen::Vector3d a, b;
  tangent_frame(normal, a, b);
  const double r = radius * std::sqrt(u), turn = 2.0 * pi * v;
  return center + r * (std::cos(turn) * a + std::sin(turn) * b);
}

double CavityMouth::intensity(const Eigen::Vector3d& direction) const {
  return double{cells[cell_of(direction)]};
}

BrightCavities find_cavities(const ElementCaster& caster, const std::vector<BrightPatch>& bright,
                             const std::vector<double>& of_element) {
  const std::vector<std::vector<int>> groups = groups_of(caster.mesh(), bright);
  const int count = static_cast<int>(groups.size());
  // One in eight leaves the shade of a spotlight, into a fifth of all cells: 20 rays a cell with
  // the most rays. All together cost no more than some hundred gathers.
  constexpr int most = 4096, fewest = 512, of_all = 1 << 17;
  const int rays = std::clamp(
      static_cast<int>(std::bit_floor(static_cast<unsigned>(of_all / std::max(1, count)))), fewest,
      most);
  std::vector<BrightCavity> cavities(groups.size());
  std::vector<std::vector<CavityMouth>> mouths(groups.size());
  parallel_for(count, 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const auto g = static_cast<std::size_t>(i);
      cavities[g].patches = groups[g];
      const CavityRays found = cast_out(caster, of_element, rays, cavities[g]);
      mouths[g] = mouths_of(caster, cavities[g], found);
    }
  });
  BrightCavities found;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (mouths[g].empty()) continue;
    for (CavityMouth& mouth : mouths[g]) {
      mouth.cavity = static_cast<int>(found.cavities.size());
      found.mouths.push_back(mouth);
    }
    found.cavities.push_back(std::move(cavities[g]));
  }
  return found;
}

}  // namespace lightwell
