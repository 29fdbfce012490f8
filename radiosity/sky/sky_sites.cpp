#include "radiosity/sky/sky_sites.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "mesh/patches/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"

namespace lightwell {
namespace {

constexpr int most_sites = 4096, points_per_octant = 3;

// The largest edge of a site, as a share of the scene's diagonal; smaller ones cost more rays.
constexpr double cube_share = 1.0 / 32.0;

// The eighth of its cube that a point lies in, 0 to 7.
int octant_of(const Eigen::Vector3d& position, double cube) {
  const Eigen::Array3d halves = (position.array() / (0.5 * cube)).floor();
  int octant = 0;
  for (int i = 0; i < 3; ++i) octant |= (static_cast<std::int64_t>(halves[i]) & 1) << i;
  return octant;
}

// The axis that a normal is nearest to, and its sign.
Eigen::Vector3d axis_of(const Eigen::Vector3d& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return (normal[axis] > 0 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(axis);
}

std::uint64_t site_key(const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                       double cube) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const auto at = [&](int i) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(position[i] / cube)));
  };
  return random_key(at(0), at(1), at(2), static_cast<std::uint64_t>(2 * axis + (normal[axis] > 0)));
}

}  // namespace

// Points of the surfaces in each cube, about half a cube apart; of surfaces behind one another, as
// a wall and the picture on it, points of each.
struct SkySites::Collector {
  explicit Collector(const PatchMesh& of) : mesh(of) {
    for (const RoundGrid& grid : mesh.round_grids) round[grid.facet] = &grid.shape;
  }

  // Returns false if there are too many sites.
  bool collect(double edge) {
    cube = edge;
    points.clear();
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (!add_element(e)) return false;
    }
    return true;
  }

  // Adds points of a grid over the fan of the element's triangles about its first corner.
  bool add_element(int e) {
    const Eigen::Vector3d normal = element_center(mesh, e).normal;
    const auto& corners = mesh.corners[static_cast<std::size_t>(e)];
    const int n = mesh.corner_count(e);
    double longest = 0.0;
    for (int k = 0; k < n; ++k) {
      longest = std::max(longest, (mesh.position(corners[static_cast<std::size_t>(k)]) -
                                   mesh.position(corners[static_cast<std::size_t>((k + 1) % n)]))
                                      .norm());
    }
    const int steps = std::clamp(static_cast<int>(std::ceil(2.0 * longest / cube)), 1, 128);
    for (int k = 2; k < n; ++k) {
      const Eigen::Vector3d a = mesh.position(corners[0]);
      const Eigen::Vector3d b = mesh.position(corners[static_cast<std::size_t>(k - 1)]) - a;
      const Eigen::Vector3d c = mesh.position(corners[static_cast<std::size_t>(k)]) - a;
      for (int i = 0; i < steps; ++i) {
        for (int j = 0; i + j < steps; ++j) {
          add_point(a + (i + 1.0 / 3.0) / steps * b + (j + 1.0 / 3.0) / steps * c, normal, e);
        }
      }
      if (points.size() > most_sites) return false;
    }
    return true;
  }

  void add_point(Eigen::Vector3d p, Eigen::Vector3d normal, int e) {
    const int facet = mesh.facet[static_cast<std::size_t>(e)];
    if (const auto of_facet = round.find(facet); of_facet != round.end()) {
      const RoundShape& shape = *of_facet->second;  // chords do not lie on it
      p = nearest_on(shape, p);
      normal = front_normal(shape, p);
      const int patch = mesh.patch[static_cast<std::size_t>(e)];
      if (mesh.is_back[static_cast<std::size_t>(patch)] != 0) normal = -normal;
    }
    Points& list = points[site_key(p, normal, cube)];
    const int octant = octant_of(p, cube);
    int in_octant = 0;
    bool is_known = false;  // a point of the same plane is
    for (const SurfacePoint& other : list) {
      if (octant_of(other.position, cube) != octant) continue;
      ++in_octant;
      constexpr double thin = 1e-6;
      is_known = is_known || std::abs(normal.dot(other.position - p)) < thin * cube;
    }
    if (!is_known && in_octant < points_per_octant) list.push_back({p, normal, facet});
  }

  const PatchMesh& mesh;
  std::map<int, const RoundShape*> round{};
  std::map<std::uint64_t, Points> points{};  // ordered by key
  double cube = 1.0;
};

SkySites::SkySites(const SkyCells& cells, const ClearPanes& panes, double scene_diagonal,
                   const ElementCaster& caster)
    : cells_(cells),
      panes_(panes),
      caster_(caster),
      cube_(cube_share * std::max(scene_diagonal, 1e-9)) {
  Collector collector(caster.mesh());
  while (!collector.collect(cube_)) cube_ *= 1.5;
  for (auto& [key, points] : collector.points) {
    place_of_[key] = static_cast<int>(places_.size());
    places_.emplace_back(key, std::move(points));
  }
  unknown_.weights.fill(1.0f);
  unknown_ = site_by(unknown_.weights, Eigen::Vector3d::Zero());
}

void SkySites::find_all() {
  const auto count = static_cast<int>(places_.size());
  const auto for_all = [&](auto&& find) {
    parallel_for(count, 4, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) find(places_[static_cast<std::size_t>(i)]);
    });
  };
  // Threads would wait for each other if sites asked for the same places beside them.
  for_all([&](Place& place) { visibility_of(place); });
  for_all([&](Place& place) { site_of(place); });
  for (Place& place : places_) {
    place.points = {};
    place.visibility.reset();
  }
  caster_.reset();
}

const SkySites::CellVisibility& SkySites::visibility_of(Place& place) const {
  std::call_once(place.is_sampled, [&] {
    place.visibility = std::make_unique<const CellVisibility>(
        sample_cells(*caster_, place.points, random_key(place.key, RandomPurpose::sky_site_rays)));
  });
  return *place.visibility;
}

const SkySites::Site& SkySites::site_of(Place& place) const {
  std::call_once(place.is_found, [&] {
    const SurfacePoint& point = place.points.front();
    std::vector<const CellVisibility*> beside;
    for (int side = 0; side < 6; ++side) {
      Eigen::Vector3d position = point.position;
      position[side / 2] += side % 2 == 0 ? cube_ : -cube_;
      const auto found = place_of_.find(site_key(position, point.normal, cube_));
      if (found == place_of_.end()) continue;
      beside.push_back(&visibility_of(places_[static_cast<std::size_t>(found->second)]));
    }
    place.site = std::make_unique<const Site>(
        site_by(weights_of(visibility_of(place), beside), axis_of(point.normal)));
  });
  return *place.site;
}

const SkySites::Site* SkySites::find(const SurfacePoint& at) const {
  const auto found = place_of_.find(site_key(at.position, at.normal, cube_));
  if (found == place_of_.end()) return nullptr;
  return &site_of(places_[static_cast<std::size_t>(found->second)]);
}

SkySites::Weights SkySites::sample(const ElementCaster& caster, const SurfacePoint& at,
                                   std::uint64_t key) const {
  return weights_of(sample_cells(caster, {&at, 1}, key), {});
}

SkySites::CellVisibility SkySites::sample_cells(const ElementCaster& caster,
                                                std::span<const SurfacePoint> points,
                                                std::uint64_t key) const {
  struct Sample {
    int cell = 0;
    std::size_t point = 0;
    bool is_open = false;
  };
  // A ray through each cell, each from one of the points `from`, drawn at random.
  const auto samples_from = [&](std::span<const std::size_t> from, std::uint64_t number) {
    std::vector<Ray> rays;
    std::vector<Sample> samples;
    for (int c = 0; c < SkyCells::count; ++c) {
      if (!(cells_.power(c) > 0.0)) continue;
      const std::uint64_t ray_key = random_key(key, number, static_cast<std::uint64_t>(c));
      const auto u = [&](std::uint64_t i) { return random_uniform(random_key(ray_key, i)); };
      const std::size_t p = from[static_cast<std::size_t>(u(0) * static_cast<double>(from.size()))];
      const SurfacePoint& point = points[p];
      const Eigen::Vector3d direction = cells_.direction(c, u(1), u(2));
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
  // A point without any sky, as on a wall behind a picture, says nothing about the others.
  std::vector<std::uint8_t> sees(points.size());
  for (const Sample& sample : first) sees[sample.point] |= sample.is_open ? 1 : 0;
  std::vector<std::size_t> seeing;
  std::ranges::copy_if(all, std::back_inserter(seeing),
                       [&](std::size_t p) { return sees[p] != 0; });
  for (const Sample& sample : first) {
    if (seeing.empty() || sees[sample.point] != 0) count_in(sample);
  }
  // Half of a room's places see no sky, and as many rays again would hardly find an opening there:
  // estimates send a share of their own rays to cells that are not known as open.
  if (seeing.empty()) return visibility;
  for (const Sample& sample : samples_from(seeing, 1)) count_in(sample);
  return visibility;
}

// A cell is likely to be open if the cells around it are, or the same cell from the cubes beside,
// whose points may see parts of the sky that the few points of this cube do not. The best weight of
// a ray is the root of the probability that its cell is open: the standard deviation of light that
// arrives or does not.
SkySites::Weights SkySites::weights_of(const CellVisibility& own,
                                       std::span<const CellVisibility* const> beside) {
  constexpr int around = SkyCells::around, rings = SkyCells::rings;
  constexpr float of_cube_beside = 0.25f, of_cell_beside = 0.125f;  // own rays count 1
  // A smaller weight would save few rays, and leave bright dots in a picture where they get out.
  constexpr float least = 0.3f;
  CellVisibility all = own;
  for (const CellVisibility* visibility : beside) {
    for (std::size_t i = 0; i < SkyCells::count; ++i) {
      all.tried[i] += of_cube_beside * visibility->tried[i];
      all.open[i] += of_cube_beside * visibility->open[i];
    }
  }
  Weights weights;
  for (int c = 0; c < SkyCells::count; ++c) {
    const int ring = c / around, column = c % around;
    float tried = 0.0f, open = 0.0f;
    for (int r = std::max(ring - 1, 0); r <= std::min(ring + 1, rings - 1); ++r) {
      for (int p = column - 1; p <= column + 1; ++p) {
        const auto i = static_cast<std::size_t>(r * around + (p + around) % around);
        const float weight = r == ring && p == column ? 1.0f : of_cell_beside;
        tried += weight * all.tried[i];
        open += weight * all.open[i];
      }
    }
    const float likely = tried > 0.0f ? open / tried : 1.0f;
    weights[static_cast<std::size_t>(c)] =
        likely > 0.0f ? std::max(least, std::sqrt(likely)) : 0.0f;
  }
  return weights;
}

double thinning_elsewhere(double open, double elsewhere) {
  constexpr double most_elsewhere = 1.0 / 3.0;
  return open > 0.0 ? std::min(1.0, most_elsewhere * open / std::max(elsewhere, 1e-300)) : 1.0;
}

SkySites::Site SkySites::site_by(const Weights& weights, const Eigen::Vector3d& axis) const {
  // Normals of a site lie up to 55 degrees from its axis, so cells at its horizon count, too. Cells
  // more than 145 degrees away are below the horizon of all normals.
  constexpr double least_cosine = 0.2, below_all = -0.82;
  Site site{.weights = weights};
  std::vector<double> facing(SkyCells::count);
  double open = 0.0, elsewhere = 0.0;
  for (int c = 0; c < SkyCells::count; ++c) {
    const auto i = static_cast<std::size_t>(c);
    const double cosine = cells_.direction(c, 0.5, 0.5).dot(axis);
    facing[i] = cosine < below_all ? 0.0 : cells_.power(c) * std::max(cosine, least_cosine);
    (weights[i] > 0.0f ? open : elsewhere) += facing[i] * (weights[i] > 0.0f ? weights[i] : 1.0f);
  }
  const double thinning = thinning_elsewhere(open, elsewhere);
  double sum = 0.0;
  for (std::size_t i = 0; i < SkyCells::count; ++i) {
    sum += facing[i] * (weights[i] > 0.0f ? double{weights[i]} : thinning);
    site.sum[i] = static_cast<float>(sum);
  }
  return site;
}

}  // namespace lightwell
