#include "radiosity/sky/sky_sites.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
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

// Coordinates of a point in edges of cubes. No cube begins at the origin: planes of many scenes lie
// there, and rounding would put their points into either of two cubes, one of which may lie within
// a wall. The golden section is far from all simple fractions of the scene's size.
Eigen::Array3d in_cubes(const Eigen::Vector3d& position, double cube) {
  constexpr double golden = 0.3819660112501051;
  return position.array() / cube + golden;
}

// The eighth of its cube that a point lies in, 0 to 7.
int octant_of(const Eigen::Vector3d& position, double cube) {
  const Eigen::Array3d halves = (2.0 * in_cubes(position, cube)).floor();
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
  const Eigen::Array3d whole = in_cubes(position, cube).floor();
  const auto at = [&](int i) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(whole[i]));
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
  const PatchMesh& mesh = caster.mesh();
  for (int v = 0; v < mesh.vertex_count(); ++v) bounds_.extend(mesh.position(v));
  Collector collector(mesh);
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
  ways_out();
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
    const CellVisibility own =
        visibility_by_ways(*caster_, place.points, place.key, visibility_of(place));
    Site site = site_by(weights_of(own, beside), axis_of(point.normal));
    for (std::size_t i = 0; i < SkyCells::count; ++i) {
      if (own.tried[i] > 0.0f) site.open[i] = own.open[i] / own.tried[i];
    }
    place.site = std::make_unique<const Site>(site);
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
  const CellVisibility by_rays = sample_cells(caster, {&at, 1}, key);
  return weights_of(visibility_by_ways(caster, {&at, 1}, key, by_rays), {});
}

// The ways out of all places, those that are hard to find first.
const std::vector<SkySites::WayOut>& SkySites::ways_out() const {
  // Enough for the rooms of a house, and little work to look through for each place.
  constexpr std::size_t most = 2048;
  std::call_once(are_ways_found_, [&] {
    for (Place& place : places_) {
      const std::vector<WayOut>& ways = visibility_of(place).ways;
      ways_out_.insert(ways_out_.end(), ways.begin(), ways.end());
    }
    std::ranges::stable_sort(ways_out_, {}, &WayOut::alike);
    ways_out_.resize(std::min(ways_out_.size(), most));
  });
  return ways_out_;
}

bool SkySites::gets_out(const ElementCaster& caster, const Ray& ray) const {
  std::uint8_t blocked = 0;
  caster.occluded({&ray, 1}, {&blocked, 1});
  return blocked == 0 || (!panes_.empty() && (panes_.passed(caster, ray) > 0.0f).any());
}

// A direction in which the point sees the sky through the hole that a way out passes; empty if none
// is found.
std::optional<Eigen::Vector3d> SkySites::direction_out(const ElementCaster& caster,
                                                       const SurfacePoint& point,
                                                       const WayOut& way) const {
  const auto towards = [&](double t) -> Eigen::Vector3d {
    return way.from + t * way.direction - point.position;
  };
  const auto sees = [&](double t) {
    const Eigen::Vector3d to = towards(t);
    return to.dot(point.normal) > 0.0 && gets_out(caster, {.origin = point.position,
                                                           .direction = to,
                                                           .t_max = 1.0,
                                                           .origin_group = point.facet});
  };
  double leaves = std::numeric_limits<double>::infinity();  // metres along the way, at the bounds
  for (int i = 0; i < 3; ++i) {
    const double speed = way.direction[i];
    if (speed == 0.0) continue;
    const double end = speed > 0.0 ? bounds_.max()[i] : bounds_.min()[i];
    leaves = std::min(leaves, std::max(0.0, (end - way.from[i]) / speed));
  }
  // The way starts in view of few places, and its middle, in a room, in view of most.
  constexpr int halvings = 7, bisections = 14;
  double seen = leaves, hidden = leaves;
  for (int i = 0; !sees(seen); ++i) {
    if (i == halvings) return {};
    hidden = seen;
    seen *= 0.5;
  }
  for (int i = 0; i < bisections && seen < hidden; ++i) {
    const double middle = 0.5 * (seen + hidden);
    (sees(middle) ? seen : hidden) = middle;
  }
  const Eigen::Vector3d direction = towards(seen).normalized();
  const Ray ray{.origin = point.position, .direction = direction, .origin_group = point.facet};
  return gets_out(caster, ray) ? std::optional(direction) : std::nullopt;
}

// Joins what rays through all cells found, if few got out, with what ways out show: a hole is in
// other cells for other points of the site.
SkySites::CellVisibility SkySites::visibility_by_ways(const ElementCaster& caster,
                                                      std::span<const SurfacePoint> points,
                                                      std::uint64_t key,
                                                      const CellVisibility& by_rays) const {
  CellVisibility visibility = by_rays;
  constexpr int enough = 12;
  const int known = by_rays.ways.empty() ? 0 : by_rays.ways.front().alike;
  if (known >= enough || ways_out().empty()) return visibility;
  // Ways near by are likely to be in view, and those that few rays find are likely to leave through
  // small holes.
  std::vector<std::pair<double, const WayOut*>> order;
  order.reserve(ways_out().size());
  for (const WayOut& way : ways_out()) {
    const double distance = (way.from - points.front().position).norm();
    order.emplace_back(distance * std::sqrt(static_cast<double>(way.alike)), &way);
  }
  constexpr std::size_t most_ways = 128;
  const auto few = static_cast<std::ptrdiff_t>(std::min(most_ways, order.size()));
  std::partial_sort(order.begin(), order.begin() + few, order.end(),
                    [](const auto& a, const auto& b) { return a.first < b.first; });
  int found = 0;
  for (std::ptrdiff_t i = 0; i < few && found < enough; ++i) {
    const double u = random_uniform(random_key(key, static_cast<std::uint64_t>(i)));
    const auto p = static_cast<std::size_t>(u * static_cast<double>(points.size()));
    const auto& [nearness, way] = order[static_cast<std::size_t>(i)];
    const std::optional<Eigen::Vector3d> direction = direction_out(caster, points[p], *way);
    if (!direction) continue;
    const auto cell = static_cast<std::size_t>(cells_.cell_of(*direction));
    visibility.tried[cell] += 1.0f;
    visibility.open[cell] += 1.0f;
    ++found;
  }
  return visibility;
}

SkySites::CellVisibility SkySites::sample_cells(const ElementCaster& caster,
                                                std::span<const SurfacePoint> points,
                                                std::uint64_t key) const {
  struct Sample {
    int cell = 0;
    std::size_t point = 0;
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
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
      samples.push_back({.cell = c, .point = p, .direction = direction});
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
  std::vector<WayOut> out;
  for (const Sample& sample : first) {
    if (sample.is_open) out.push_back({points[sample.point].position, sample.direction});
  }
  const auto alike = static_cast<int>(out.size());
  if (out.size() > 2) out = {out.front(), out.back()};
  for (WayOut& way : out) way.alike = alike;
  visibility.ways = std::move(out);
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
    site.open[i] = weights[i] * weights[i];  // see weights_of()
  }
  return site;
}

}  // namespace lightwell
