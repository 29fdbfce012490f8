#include "radiosity/emitters/sky_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "mesh/patches/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"

namespace lightwell {
namespace {

using std::numbers::pi;
constexpr int most_sites = 4096, points_per_octant = 3;

// A cube is no larger than this share of the scene's diagonal; more cubes cost more learning.
constexpr double cube_share = 1.0 / 32.0;

// Where a place of a square grid of 2^k places each way comes on Hilbert's curve (1891).
int on_hilbert_curve(int size, int x, int y) {
  int distance = 0;
  for (int s = size / 2; s > 0; s /= 2) {
    const int right = (x & s) != 0, up = (y & s) != 0;
    distance += s * s * ((3 * right) ^ up);
    if (up == 0) {
      if (right == 1) {
        x = size - 1 - x;
        y = size - 1 - y;
      }
      std::swap(x, y);
    }
  }
  return distance;
}

// Which eighth of its cube a point lies in.
int octant_of(const Eigen::Vector3d& position, double cube) {
  const Eigen::Array3d halves = (position.array() / (0.5 * cube)).floor();
  int octant = 0;
  for (int i = 0; i < 3; ++i) octant |= (static_cast<std::int64_t>(halves[i]) & 1) << i;
  return octant;
}

// Place (u, v) of a cell in axes of north, east and up, of a dome of `rings` times `around` cells.
// The rings have even height, so that all cells have the same solid angle and the horizon is
// between two.
Eigen::Vector3d dome_direction(int cell, int around, int rings, double u, double v) {
  const double z = -1.0 + 2.0 * (cell / around + v) / rings;
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double phi = 2.0 * std::numbers::pi * (cell % around + u) / around;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// The same of grids of n x n places over the cells, cell after cell: middles of the places, or the
// cells' corners for n = 2.
std::vector<Eigen::Vector3f> dome_grid(int around, int rings, int n) {
  std::vector<Eigen::Vector3f> grid;
  grid.reserve(static_cast<std::size_t>(around) * rings * n * n);
  const auto at = [n](int i) { return n == 2 ? static_cast<double>(i) : (i + 0.5) / n; };
  for (int c = 0; c < around * rings; ++c) {
    for (int i = 0; i < n * n; ++i) {
      grid.push_back(dome_direction(c, around, rings, at(i % n), at(i / n)).cast<float>());
    }
  }
  return grid;
}

}  // namespace

SkyLight::SkyLight(const Scene& scene, const PatchMesh& mesh)
    : bands_(scene.bands.count()), panes_(scene), sobol_(most_sky_rays) {
  tabulate(*scene.sky);
  cube_ = cube_share * std::max(scene_bounds(scene).diagonal(), 1e-9);
  learn(ElementCaster(mesh));
}

Eigen::Vector3d SkyLight::direction_at(int cell, double u, double v) const {
  return axes_ * dome_direction(cell, around, rings, u, v);
}

void SkyLight::tabulate(const Sky& sky) {
  axes_ << sky.north, sky.north.cross(sky.up), sky.up;
  // Equal steps along the curve are spread evenly over the dome, as those along rings are not.
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [](int a, int b) {
    return on_hilbert_curve(around, a % around, a / around) <
           on_hilbert_curve(around, b % around, b / around);
  });
  constexpr int in_cell = fine * fine;
  radiance_.resize(static_cast<std::size_t>(cells) * in_cell);
  row_cdf_.resize(static_cast<std::size_t>(cells) * fine);
  column_cdf_.resize(radiance_.size());
  colour_ = BandArray::Ones(cells, bands_);
  const int across = sky.kind == SkyKind::map ? 4 : 1;  // looks per place of the grid, each way
  constexpr double fine_angle = 4.0 * pi / (static_cast<double>(cells) * in_cell);
  parallel_for(cells, 16, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      Cell& cell = cell_[static_cast<std::size_t>(c)];
      Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(bands_);
      Eigen::Vector3d vector = Eigen::Vector3d::Zero();
      const std::size_t first = static_cast<std::size_t>(c) * in_cell;
      for (int i = 0; i < in_cell; ++i) {
        const int row = i / fine, column = i % fine;
        Eigen::ArrayXd L = Eigen::ArrayXd::Zero(bands_);
        for (int k = 0; k < across * across; ++k) {
          const double u = (column + (k % across + 0.5) / across) / fine;
          const double v = (row + (k / across + 0.5) / across) / fine;
          L += sky_radiance(sky, direction_at(c, u, v)).cast<double>() / (across * across);
        }
        radiance_[first + static_cast<std::size_t>(i)] = static_cast<float>(L.mean());
        vector +=
            L.mean() * fine_angle * direction_at(c, (column + 0.5) / fine, (row + 0.5) / fine);
        sum += L * fine_angle;
      }
      cell.middle = direction_at(c, 0.5, 0.5).cast<float>();
      cell.vector = vector.cast<float>();
      cell.power = sum.mean();
      if (cell.power > 0.0) colour_.row(c) = (sum / sum.mean()).cast<float>().transpose();
      double rows = 0.0;
      for (int row = 0; row < fine; ++row) {
        double columns = 0.0;
        for (int column = 0; column < fine; ++column) {
          const std::size_t at = first + static_cast<std::size_t>(row * fine + column);
          columns += static_cast<double>(radiance_[at]);
          column_cdf_[at] = static_cast<float>(columns);
        }
        rows += columns;
        row_cdf_[static_cast<std::size_t>(c * fine + row)] = static_cast<float>(rows);
      }
    }
  });
}

SkyLight::Draw SkyLight::draw(int cell, double u, double v) const {
  const auto pick = [](std::span<const float> cdf, double& x) {
    const double wanted = x * static_cast<double>(cdf.back());
    const auto at = std::upper_bound(cdf.begin(), cdf.end() - 1, static_cast<float>(wanted));
    const double low = at == cdf.begin() ? 0.0 : static_cast<double>(*(at - 1));
    const double step = static_cast<double>(*at) - low;
    x = step > 0.0 ? std::clamp((wanted - low) / step, 0.0, 1.0) : 0.5;
    return static_cast<int>(at - cdf.begin());
  };
  const auto c = static_cast<std::size_t>(cell);
  const int row = pick(std::span(row_cdf_).subspan(c * fine, fine), v);
  const std::size_t first = c * fine * fine;
  const int column =
      pick(std::span(column_cdf_).subspan(first + static_cast<std::size_t>(row * fine), fine), u);
  const double L =
      static_cast<double>(radiance_[first + static_cast<std::size_t>(row * fine + column)]);
  return {.direction = direction_at(cell, (column + u) / fine, (row + v) / fine),
          .density = L / cell_[c].power};
}

// int L cos over the part of a cell above the horizon, mean of the bands.
double SkyLight::irradiance_of(int c, const Eigen::Vector3f& normal) const {
  const Cell& cell = cell_[static_cast<std::size_t>(c)];
  if (!(cell.power > 0.0)) return 0.0;
  // Cells are at most this wide across: half a diagonal is below it but at the poles, whose rings
  // reach 20 degrees down.
  constexpr float sine_of_reach = 0.087f, sine_at_pole = 0.36f;
  const bool is_at_pole = c < around || c >= cells - around;
  const float reach = is_at_pole ? sine_at_pole : 1.5f * sine_of_reach;
  const float height = cell.middle.dot(normal);
  if (height < -reach) return 0.0;
  const auto E = static_cast<double>(cell.vector.dot(normal));
  if (height > reach) return E;
  // Where the horizon is, every point asks for the same directions.
  static const std::vector<Eigen::Vector3f> corners = dome_grid(around, rings, 2);
  static const std::vector<Eigen::Vector3f> places = dome_grid(around, rings, fine);
  const Eigen::Vector3f n = axes_.transpose().cast<float>() * normal;
  constexpr float rounding = 1e-6f;
  const auto of_cell = corners.begin() + std::ptrdiff_t{4} * c;
  const bool is_cut = std::any_of(of_cell, of_cell + 4, [&](const Eigen::Vector3f& corner) {
    return corner.dot(n) < -rounding;
  });
  if (!is_cut) return E;
  constexpr double fine_angle = 4.0 * pi / (static_cast<double>(cells) * fine * fine);
  const std::size_t first = static_cast<std::size_t>(c) * fine * fine;
  double sum = 0.0;
  for (std::size_t i = first; i < first + fine * fine; ++i) {
    const float cosine = places[i].dot(n);
    if (cosine > 0.0f) sum += static_cast<double>(cosine * radiance_[i]);
  }
  return sum * fine_angle;
}

Spectrum SkyLight::unobstructed(const Eigen::Vector3d& normal) const {
  const Eigen::Vector3f n = normal.cast<float>();
  Eigen::ArrayXd E = Eigen::ArrayXd::Zero(bands_);
  for (int c = 0; c < cells; ++c) {
    E += irradiance_of(c, n) * colour_.row(c).transpose().cast<double>();
  }
  return E.cast<float>();
}

std::uint64_t SkyLight::site_key(const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                                 double cube) const {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const auto at = [&](int i) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(position[i] / cube)));
  };
  return random_key(at(0), at(1), at(2), static_cast<std::uint64_t>(2 * axis + (normal[axis] > 0)));
}

// Sites are where surfaces are: cubes through which an element passes, known by points of it about
// half a cube apart; of surfaces behind one another, as a wall and the picture on it, by points of
// each.
void SkyLight::learn(const ElementCaster& caster) {
  const PatchMesh& mesh = caster.mesh();
  std::map<std::uint64_t, std::vector<SurfacePoint>> points;  // in an order of their own
  std::map<int, const Sphere*> spheres;
  for (const SphereGrid& grid : mesh.sphere_grids) spheres[grid.facet] = &grid.sphere;
  for (;; cube_ *= 1.5) {
    points.clear();
    bool is_too_many = false;
    for (int e = 0; e < mesh.element_count() && !is_too_many; ++e) {
      const PatchPoint middle = element_center(mesh, e);
      const auto of_facet = spheres.find(mesh.facet[static_cast<std::size_t>(e)]);
      const Sphere* sphere = of_facet == spheres.end() ? nullptr : of_facet->second;
      const int patch = mesh.patch[static_cast<std::size_t>(e)];
      const bool is_back = mesh.is_back[static_cast<std::size_t>(patch)] != 0;
      const auto& corners = mesh.corners[static_cast<std::size_t>(e)];
      double longest = 0.0;
      const int n = mesh.corner_count(e);
      for (int k = 0; k < n; ++k) {
        longest = std::max(longest, (mesh.position(corners[static_cast<std::size_t>(k)]) -
                                     mesh.position(corners[static_cast<std::size_t>((k + 1) % n)]))
                                        .norm());
      }
      const int steps = std::clamp(static_cast<int>(std::ceil(2.0 * longest / cube_)), 1, 128);
      // A grid over the fan of the element's triangles about its first corner.
      for (int k = 2; k < n; ++k) {
        const Eigen::Vector3d a = mesh.position(corners[0]);
        const Eigen::Vector3d b = mesh.position(corners[static_cast<std::size_t>(k - 1)]) - a;
        const Eigen::Vector3d c = mesh.position(corners[static_cast<std::size_t>(k)]) - a;
        for (int i = 0; i < steps; ++i) {
          for (int j = 0; i + j < steps; ++j) {
            Eigen::Vector3d p = a + (i + 1.0 / 3.0) / steps * b + (j + 1.0 / 3.0) / steps * c;
            Eigen::Vector3d normal = middle.normal;
            if (sphere) {  // chords lie within it
              normal = (p - sphere->center).normalized();
              p = sphere->center + sphere->radius * normal;
              if (is_back) normal = -normal;
            }
            auto& list = points[site_key(p, normal, cube_)];
            const int octant = octant_of(p, cube_);
            int there = 0;
            bool is_known = false;  // its plane is
            for (const SurfacePoint& other : list) {
              if (octant_of(other.position, cube_) != octant) continue;
              ++there;
              constexpr double thin = 1e-6;
              is_known = is_known || std::abs(normal.dot(other.position - p)) < thin * cube_;
            }
            if (!is_known && there < points_per_octant) {
              list.push_back({p, normal, mesh.facet[static_cast<std::size_t>(e)]});
            }
          }
        }
        if (points.size() > most_sites) is_too_many = true;
      }
    }
    if (!is_too_many) break;
  }
  std::vector<const std::vector<SurfacePoint>*> lists;
  std::vector<std::uint64_t> keys;
  for (const auto& [key, list] : points) {
    site_of_[key] = static_cast<int>(lists.size());
    lists.push_back(&list);
    keys.push_back(key);
  }
  const auto count = static_cast<int>(lists.size());
  std::vector<CellVisibility> visibilities(lists.size());
  parallel_for(count, 4, [&](int begin, int end) {
    for (int s = begin; s < end; ++s) {
      const auto i = static_cast<std::size_t>(s);
      visibilities[i] =
          sample_cells(caster, *lists[i], random_key(keys[i], RandomPurpose::sky_site_rays));
    }
  });
  sites_.resize(lists.size());
  parallel_for(count, 16, [&](int begin, int end) {
    for (int s = begin; s < end; ++s) {
      const auto i = static_cast<std::size_t>(s);
      const SurfacePoint& point = lists[i]->front();
      std::vector<const CellVisibility*> beside;
      for (int side = 0; side < 6; ++side) {
        Eigen::Vector3d position = point.position;
        position[side / 2] += side % 2 == 0 ? cube_ : -cube_;
        const auto found = site_of_.find(site_key(position, point.normal, cube_));
        if (found != site_of_.end()) {
          beside.push_back(&visibilities[static_cast<std::size_t>(found->second)]);
        }
      }
      sites_[i] = site_of(visibilities[i], beside);
    }
  });
}

SkyLight::CellVisibility SkyLight::sample_cells(const ElementCaster& caster,
                                                std::span<const SurfacePoint> points,
                                                std::uint64_t key) const {
  struct Sample {
    int cell = 0;
    std::size_t point = 0;
    bool is_open = false;
  };
  // A ray through each cell, from points that are drawn among those `from`.
  const auto samples_from = [&](std::span<const std::size_t> from, std::uint64_t number) {
    std::vector<Ray> rays;
    std::vector<Sample> samples;
    for (int c = 0; c < cells; ++c) {
      if (!(cell_[static_cast<std::size_t>(c)].power > 0.0)) continue;
      const std::uint64_t ray_key = random_key(key, number, static_cast<std::uint64_t>(c));
      const auto u = [&](std::uint64_t i) { return random_uniform(random_key(ray_key, i)); };
      const std::size_t p = from[static_cast<std::size_t>(u(0) * static_cast<double>(from.size()))];
      const SurfacePoint& point = points[p];
      const Eigen::Vector3d direction = direction_at(c, u(1), u(2));
      if (!(direction.dot(point.normal) > 0.0)) continue;
      rays.push_back(
          {.origin = point.position, .direction = direction, .origin_group = point.facet});
      samples.push_back({.cell = c, .point = p});
    }
    std::vector<std::uint8_t> blocked(rays.size());
    caster.occluded(rays, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      samples[i].is_open =
          blocked[i] == 0 || (!panes_.empty() && (panes_.passed(caster, rays[i]) > 0.0f).any());
    }
    return samples;
  };
  CellVisibility visibility;
  const auto count_in = [&](const Sample& sample) {
    visibility.tried[static_cast<std::size_t>(sample.cell)] += 1.0f;
    visibility.open[static_cast<std::size_t>(sample.cell)] += sample.is_open ? 1.0f : 0.0f;
  };
  std::vector<std::size_t> all(points.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<Sample> first = samples_from(all, 0);
  // A point that sees nothing, as on a wall behind a picture, tells nothing of the others.
  std::vector<std::uint8_t> sees(points.size());
  for (const Sample& sample : first) sees[sample.point] |= sample.is_open ? 1 : 0;
  std::vector<std::size_t> seeing;
  std::ranges::copy_if(all, std::back_inserter(seeing),
                       [&](std::size_t p) { return sees[p] != 0; });
  for (const Sample& sample : first) {
    if (seeing.empty() || sees[sample.point] != 0) count_in(sample);
  }
  for (const Sample& sample : samples_from(seeing.empty() ? all : seeing, 1)) count_in(sample);
  return visibility;
}

// What gets out of a cell is likely to get out of those around it, and from the cubes beside, whose
// points may see what those of this one, being few, do not. Rays are best given in proportion to
// the root of how likely that is, since of light that is there or not that is the deviation.
SkyLight::Site SkyLight::site_of(const CellVisibility& own,
                                 std::span<const CellVisibility* const> beside) {
  constexpr float of_cube_beside = 0.25f, of_cell_beside = 0.125f;  // own rays count 1
  // Less would save few rays, and make what they find too bright a dot.
  constexpr float least = 0.3f;
  CellVisibility all = own;
  for (const CellVisibility* visibility : beside) {
    for (std::size_t i = 0; i < cells; ++i) {
      all.tried[i] += of_cube_beside * visibility->tried[i];
      all.open[i] += of_cube_beside * visibility->open[i];
    }
  }
  Site site;
  for (int c = 0; c < cells; ++c) {
    const int ring = c / around, place = c % around;
    float tried = 0.0f, open = 0.0f;
    for (int r = std::max(ring - 1, 0); r <= std::min(ring + 1, rings - 1); ++r) {
      for (int p = place - 1; p <= place + 1; ++p) {
        const auto i = static_cast<std::size_t>(r * around + (p + around) % around);
        const float weight = r == ring && p == place ? 1.0f : of_cell_beside;
        tried += weight * all.tried[i];
        open += weight * all.open[i];
      }
    }
    const float likely = tried > 0.0f ? open / tried : 1.0f;
    site[static_cast<std::size_t>(c)] = likely > 0.0f ? std::max(least, std::sqrt(likely)) : 0.0f;
  }
  return site;
}

// One ray in each of `rays` equal steps through the running sum of the shares.
void SkyLight::cast(const ElementCaster& caster, const SurfacePoint& at,
                    std::span<const Share> shares, int rays, std::uint64_t key,
                    Tally& tally) const {
  struct Sample {
    double weight = 0.0;
    int cell = 0;
    bool is_open = false;
  };
  std::vector<Ray> ray;
  std::vector<Sample> samples;
  ray.reserve(static_cast<std::size_t>(rays));
  samples.reserve(static_cast<std::size_t>(rays));
  const double all = shares.back().cdf;
  std::size_t s = 0;
  for (int i = 0; i < rays; ++i) {
    const double within =
        random_uniform(random_key(key, RandomPurpose::sky_rays, static_cast<std::uint64_t>(i)));
    const double wanted = (i + within) / rays * all;
    while (s + 1 < shares.size() && !(shares[s].cdf > wanted)) ++s;
    const Share& share = shares[s];
    const Eigen::Array4f u = sobol_.point(i, key);
    const Draw drawn = draw(share.cell, static_cast<double>(u[0]), static_cast<double>(u[1]));
    const double cosine = drawn.direction.dot(at.normal);
    if (!(cosine > 0.0) || !(drawn.density > 0.0)) continue;
    // L cos over its density, which is that within the cell times weight / all.
    const double power = cell_[static_cast<std::size_t>(share.cell)].power;
    samples.push_back({.weight = cosine * power * all / (share.weight * rays),
                       .cell = share.cell,
                       .is_open = share.is_open()});
    ray.push_back({.origin = at.position, .direction = drawn.direction, .origin_group = at.facet});
  }
  std::vector<std::uint8_t> blocked(ray.size());
  caster.occluded(ray, blocked);
  for (std::size_t i = 0; i < ray.size(); ++i) {
    const Sample& sample = samples[i];
    const Eigen::ArrayXd weight =
        sample.weight * colour_.row(sample.cell).transpose().cast<double>();
    if (sample.is_open) tally.all_open += weight;
    ++tally.rays;
    if (blocked[i] == 0) {
      (sample.is_open ? tally.seen_open : tally.seen_elsewhere) += weight;
      ++tally.clear;
      continue;
    }
    if (panes_.empty()) continue;
    const Spectrum passed = panes_.passed(caster, ray[i]);
    if (!(passed > 0.0f).any()) continue;
    (sample.is_open ? tally.seen_open : tally.seen_elsewhere) += weight * passed.cast<double>();
    ++tally.clear;
  }
}

SkyGlow SkyLight::irradiance(const ElementCaster& caster, const SurfacePoint& at, std::uint64_t key,
                             const SkyEffort& effort) const {
  const auto& [point, normal, facet] = at;
  Site learnt;
  const Site* site = nullptr;
  if (const auto found = site_of_.find(site_key(point, normal, cube_)); found != site_of_.end()) {
    site = &sites_[static_cast<std::size_t>(found->second)];
  } else {
    learnt =
        site_of(sample_cells(caster, {&at, 1}, random_key(key, RandomPurpose::sky_point_rays)), {});
    site = &learnt;
  }
  const Eigen::Vector3f n = normal.cast<float>();
  std::vector<Share> shares;
  shares.reserve(cells / 2 + 2 * around);
  for (const int c : order_) {
    const double E = irradiance_of(c, n);
    if (!(E > 0.0)) continue;
    const auto likely = static_cast<double>((*site)[static_cast<std::size_t>(c)]);
    shares.push_back({.cell = c, .E = E, .likely = likely});
  }
  if (shares.empty()) return {Spectrum::Zero(bands_)};
  const bool sees_nothing =
      std::ranges::none_of(shares, [](const Share& share) { return share.is_open(); });
  // Besides rays to what the site saw open, a third as many at most go where it saw nothing; if it
  // saw nothing at all, all go there. Fewer would be as exact in the mean; but what they find would
  // weigh as much more, and leave a bright dot in a picture here and there.
  double all_to_open = 1.0;  // rays
  const auto share_out = [&] {
    constexpr double most_elsewhere = 1.0 / 3.0;
    double open = 0.0, elsewhere = 0.0, sum = 0.0;
    for (const Share& share : shares) {
      (share.is_open() ? open : elsewhere) += share.E * (share.is_open() ? share.likely : 1.0);
    }
    const double thinning =
        open > 0.0 ? std::min(1.0, most_elsewhere * open / std::max(elsewhere, 1e-300)) : 1.0;
    for (Share& share : shares) {
      share.weight = share.E * (share.is_open() ? share.likely : thinning);
      share.cdf = sum += share.weight;
    }
    all_to_open = open > 0.0 ? sum / open : 1.0;
  };
  const auto open_irradiance = [&] {
    Eigen::ArrayXd E = Eigen::ArrayXd::Zero(bands_);
    for (const Share& share : shares) {
      if (share.is_open()) E += share.E * colour_.row(share.cell).transpose().cast<double>();
    }
    return E;
  };
  Eigen::ArrayXd E_open = open_irradiance();

  const auto tally_of = [&](int rays, std::uint64_t round) {
    Tally tally{.seen_open = Eigen::ArrayXd::Zero(bands_),
                .all_open = Eigen::ArrayXd::Zero(bands_),
                .seen_elsewhere = Eigen::ArrayXd::Zero(bands_)};
    const auto count = static_cast<int>(std::lround(all_to_open * rays));
    cast(caster, at, shares, std::clamp(count, 1, most_sky_rays), random_key(key, round), tally);
    return tally;
  };
  const auto seen_share = [](const Tally& tally) -> Eigen::ArrayXd {
    return (tally.all_open > 0.0).select(tally.seen_open / tally.all_open.max(1e-300), 0.0);
  };
  const auto result = [&](const Tally& tally) -> Eigen::ArrayXd {
    return E_open * seen_share(tally) + tally.seen_elsewhere;
  };
  const int first = sees_nothing ? std::max(8, effort.first / 4) : effort.first;
  share_out();
  const Tally pilot = tally_of(first, 1);
  if (sees_nothing && pilot.clear == 0) return {result(pilot).cast<float>()};
  // Where the site tells little of the point, as beside a wall that parts light from dark, rays
  // that follow it are few for what they find.
  constexpr double much = 0.2;
  if (pilot.seen_elsewhere.sum() > much * result(pilot).sum()) {
    for (Share& share : shares) share.likely = 1.0;
    E_open = open_irradiance();
    share_out();
    const Tally all = tally_of(effort.most, 2);
    return {result(all).cast<float>(), all.clear < all.rays};
  }
  // A small opening is often missed by the first rays: that they see nothing settles nothing.
  // That they all get out does where nothing of the site said otherwise.
  const bool is_clear =
      std::ranges::all_of(shares, [](const Share& share) { return share.likely >= 1.0; });
  if (is_clear && pilot.clear == pilot.rays) return {result(pilot).cast<float>()};
  const Tally more = tally_of(effort.most, 2);
  // What rays make of all that is open is off by as much as they are not even over it, and what
  // they see of it about in proportion. The proportion is that of the other rays: one's own would
  // be a ratio of two guesses, whose mean is not that of what is seen.
  const auto corrected = [&](const Tally& tally, const Tally& other) -> Eigen::ArrayXd {
    return tally.seen_open + seen_share(other) * (E_open - tally.all_open) + tally.seen_elsewhere;
  };
  const double share = static_cast<double>(first) / (first + effort.most);
  const Eigen::ArrayXd E = share * corrected(pilot, more) + (1.0 - share) * corrected(more, pilot);
  return {E.max(0.0).cast<float>(), pilot.clear < pilot.rays || more.clear < more.rays};
}

}  // namespace lightwell
