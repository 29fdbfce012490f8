#include "daylight/dome_view.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "scene/degree.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Rounds of random numbers of one receiver.
constexpr std::uint64_t search_round = 1, cell_round = 2, sun_round = 3, path_round = 4;

std::uint64_t round_key(std::uint64_t key, std::uint64_t round) {
  return random_key(key, RandomPurpose::sky_point_rays, round);
}

double random_of(std::uint64_t key, std::uint64_t number) {
  return random_uniform(random_key(key, number));
}

// The point that a random number in [0,1) draws.
std::size_t point_of(double random, std::size_t count) {
  return std::min(static_cast<std::size_t>(random * static_cast<double>(count)), count - 1);
}

// Rays to be cast together, and the share of light that each lets pass.
class RayBatch {
 public:
  RayBatch(const Surroundings& around, ReceiverPoints points) : around_(around), points_(points) {}

  // Adds a ray of the receiver's point `number`.
  void add(std::size_t number, const Eigen::Vector3d& direction) {
    const SurfacePoint& from = points_[number];
    rays_.push_back({.origin = from.position, .direction = direction, .origin_group = from.facet});
    from_.push_back(&from);
  }
  std::size_t point_count() const { return points_.size(); }
  std::size_t size() const { return rays_.size(); }
  const Eigen::Vector3d& direction(std::size_t ray) const { return rays_[ray].direction; }
  // Cosine to the normal of the ray's point; 0 below the horizon.
  double cosine(std::size_t ray) const {
    return std::max(0.0, rays_[ray].direction.dot(from_[ray]->normal));
  }

  void cast() {
    blocked_.assign(rays_.size(), 0);
    around_.caster.occluded(rays_, blocked_);
  }
  // Direction in which the light of a ray leaves the scene by way of mirrors and glass, and its
  // share per band.
  struct Exit {
    Eigen::Vector3d direction;
    Spectrum share;
  };
  std::optional<Exit> exit(std::size_t ray, std::uint64_t key) const {
    if (!around_.paths || blocked_[ray] == 0) return std::nullopt;
    ElementHit hit;
    around_.caster.closest_hits({&rays_[ray], 1}, {&hit, 1});
    if (hit.facet < 0 || !around_.paths->is_specular(hit.facet)) return std::nullopt;
    const PathLosses losses =
        around_.paths->follow(rays_[ray], hit, random_key(key, static_cast<std::uint64_t>(ray)),
                              std::function<void(const LightArrival&)>([](const LightArrival&) {}),
                              PathQuantity::radiance);
    if (losses.exit.isZero()) return std::nullopt;
    return Exit{losses.exit, losses.escaped};
  }

  // The share of a ray that arrives through clear panes alone, per band.
  Spectrum passed(std::size_t ray) const {
    if (blocked_[ray] == 0) return Spectrum::Ones(around_.bands);
    if (around_.panes.empty()) return Spectrum::Zero(around_.bands);
    return around_.panes.passed(around_.caster, rays_[ray]);
  }

 private:
  const Surroundings& around_;
  ReceiverPoints points_;
  std::vector<Ray> rays_{};
  std::vector<const SurfacePoint*> from_{};
  std::vector<std::uint8_t> blocked_{};
};

// Adds `count` rays stratified over a cell to the batch.
void add_rays(const SkyPatches& sky, int cell, int count, std::uint64_t key, RayBatch& batch) {
  const int across = std::max(1, static_cast<int>(std::lround(std::sqrt(count))));
  const int rows = (count + across - 1) / across;
  for (int i = 0; i < count; ++i) {
    // Strata of the last row are wider where the row is not full.
    const int row = i / across, in_row = std::min(across, count - row * across);
    const auto number = static_cast<std::uint64_t>(cell) << 32 | static_cast<std::uint64_t>(i) * 3;
    const double u = (i % across + random_of(key, number)) / in_row,
                 v = (row + random_of(key, number + 1)) / rows;
    batch.add(point_of(random_of(key, number + 2), batch.point_count()), sky.direction(cell, u, v));
  }
}

// Cells of which one in `stride` of a row is drawn, each with the same probability. Rows are
// shifted against each other, so that an upright opening that is narrower than the stride is found.
class DrawnCells {
 public:
  DrawnCells(const SkyPatches& sky, int stride, std::uint64_t key)
      : sky_(sky),
        stride_(static_cast<std::size_t>(stride)),
        first_(point_of(random_of(key, ~0ULL), stride_)) {}

  bool has(int cell) const {
    // Four rows in succession draw all columns of a stride of 4, two of a stride of 2.
    const auto row = static_cast<std::size_t>(sky_.row_of(cell));
    const std::size_t shift = row % 2 * (stride_ / 2) + row / 2 % 2 * (stride_ / 4);
    return (static_cast<std::size_t>(cell) + shift) % stride_ == first_;
  }

 private:
  const SkyPatches& sky_;
  std::size_t stride_, first_;
};

void open_with_neighbours(const SkyPatches& sky, int cell, std::vector<char>& open) {
  open[static_cast<std::size_t>(cell)] = 1;
  for (const int beside : sky.neighbours(cell)) open[static_cast<std::size_t>(beside)] = 1;
}

// Marks the cells that rays find open, and those around them, up to half way to the next cell of
// the row that is searched. `E` is the irradiance of each cell without obstacles.
std::vector<char> open_cells(const Surroundings& around, const SkyPatches& sky,
                             ReceiverPoints points, const Eigen::ArrayXd& E,
                             const DomeEffort& effort, std::uint64_t key) {
  RayBatch batch(around, points);
  const DrawnCells searched(sky, effort.stride, key);
  for (int c = 0; c < sky.cell_count(); ++c) {
    if (!(E[c] > 0.0) || !searched.has(c)) continue;
    add_rays(sky, c, effort.search, key, batch);
  }
  batch.cast();
  std::vector<char> found(static_cast<std::size_t>(sky.cell_count()), 0);
  const auto find = [&](const Eigen::Vector3d& direction) {
    found[static_cast<std::size_t>(sky.cell_of(direction))] = 1;
  };
  for (std::size_t r = 0; r < batch.size(); ++r) {
    // Cells of the rays, and of where they leave.
    if ((batch.passed(r) > 0.0f).any()) {
      find(batch.direction(r));
    } else if (const auto exit = batch.exit(r, key)) {
      find(batch.direction(r));
      find(exit->direction);
    }
  }
  for (int reach = 0; reach < std::max(1, effort.stride / 2); ++reach) {
    const std::vector<char> before = found;
    for (int c = 0; c < sky.cell_count(); ++c) {
      if (before[static_cast<std::size_t>(c)] != 0) open_with_neighbours(sky, c, found);
    }
  }
  return found;
}

// The mean over the points of the irradiance that each cell of radiance 1 gives without obstacles.
Eigen::ArrayXd unobstructed(const SkyPatches& sky, ReceiverPoints points) {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(sky.cell_count());
  std::size_t at = 0;
  while (at < points.size()) {
    std::size_t end = at + 1;
    while (end < points.size() && points[end].normal == points[at].normal) ++end;
    sum += static_cast<double>(end - at) * sky.irradiances(points[at].normal);
    at = end;
  }
  return sum / static_cast<double>(points.size());
}

// The rays through a cell, and the irradiance that they stand for.
struct Span {
  int cell = 0;
  double E = 0.0;
  std::size_t begin = 0, end = 0;
};

// Adds the light that rays through a cell find to the view.
void add_cell(const SkyPatches& sky, const RayBatch& batch, const Span& span, std::uint64_t key,
              DomeView& view) {
  double cosines = 0.0;
  for (std::size_t r = span.begin; r < span.end; ++r) cosines += batch.cosine(r);
  if (!(cosines > 0.0)) return;
  const auto add = [&](int cell, double share, const Spectrum& passed) {
    view.coefficient.row(sky.column_of(cell)) +=
        (share * passed.cast<double>()).cast<float>().transpose();
  };
  for (std::size_t r = span.begin; r < span.end; ++r) {
    const double share = span.E * batch.cosine(r) / cosines;
    if (!(share > 0.0)) continue;
    add(span.cell, share, batch.passed(r));
    if (const auto exit = batch.exit(r, key)) add(sky.cell_of(exit->direction), share, exit->share);
  }
}

}  // namespace

DomeView view_of_dome(const Surroundings& around, const SkyPatches& sky, ReceiverPoints points,
                      const DomeEffort& effort, std::uint64_t key) {
  const Eigen::ArrayXd E = unobstructed(sky, points);
  DomeView view{.coefficient = Eigen::ArrayXXf::Zero(sky.column_count(), around.bands),
                .open = open_cells(around, sky, points, E, effort, round_key(key, search_round))};
  double open_sum = 0.0;
  for (int c = 0; c < sky.cell_count(); ++c) {
    if (view.open[static_cast<std::size_t>(c)] != 0) open_sum += E[c];
  }
  const std::uint64_t rays_key = round_key(key, cell_round);
  std::vector<Span> spans;
  RayBatch batch(around, points);
  constexpr int fewest_of_open = 4;
  const DrawnCells drawn(sky, effort.stride, rays_key);
  for (int c = 0; c < sky.cell_count(); ++c) {
    if (!(E[c] > 0.0)) continue;
    const bool is_open = view.open[static_cast<std::size_t>(c)] != 0;
    if (!is_open && !drawn.has(c)) continue;
    const int count =
        is_open ? std::max(fewest_of_open, static_cast<int>(effort.rays * E[c] / open_sum)) : 1;
    const std::size_t begin = batch.size();
    add_rays(sky, c, count, rays_key, batch);
    spans.push_back({c, is_open ? E[c] : effort.stride * E[c], begin, batch.size()});
  }
  batch.cast();
  for (const Span& span : spans) add_cell(sky, batch, span, rays_key, view);
  return view;
}

namespace {

// Rays of a receiver to suns, with the sun and the weight of each.
struct SunRays {
  RayBatch batch;
  std::vector<std::size_t> sun{};
  std::vector<float> weight{};

  // Adds a ray of a point to the place (r, phi) of a disc that (u, v) in [0,1)^2 give.
  void add(std::size_t point, std::size_t number, const SunDisc& disc, float share, double u,
           double v) {
    const double r = std::sqrt(u) * disc.radius, phi = 2.0 * std::numbers::pi * v;
    batch.add(
        point,
        (disc.direction + r * (std::cos(phi) * disc.a + std::sin(phi) * disc.b)).normalized());
    sun.push_back(number);
    weight.push_back(share);
  }
};

}  // namespace

SunDisc::SunDisc(const SkyPatches& sky, const Eigen::Vector3d& towards, double angle_degrees)
    : direction(towards),
      radius(std::tan(0.5 * angle_degrees * degree)),
      cell(sky.cell_of(towards)) {
  tangent_frame(direction, a, b);
}

Eigen::ArrayXXf sunlight(const Surroundings& around, ReceiverPoints points, const DomeView& view,
                         std::span<const SunDisc> suns, int rays, std::uint64_t key) {
  SunRays cast{.batch = RayBatch(around, points)};
  const std::uint64_t sun_key = round_key(key, sun_round);
  const std::size_t lit = std::min(points.size(), static_cast<std::size_t>(rays)),
                    of_point = static_cast<std::size_t>(rays) / lit;
  const float share = 1.0f / static_cast<float>(lit * of_point);
  for (std::size_t s = 0; s < suns.size(); ++s) {
    const SunDisc& sun = suns[s];
    const std::uint64_t of_sun = random_key(sun_key, s);
    const auto random = [&](std::uint64_t number) { return random_of(of_sun, number); };
    const auto is_above = [&](std::size_t p) { return points[p].normal.dot(sun.direction) > 0.0; };
    if (view.open[static_cast<std::size_t>(sun.cell)] == 0) {
      const std::size_t p = point_of(random(0), points.size());
      if (is_above(p)) cast.add(p, s, sun, 1.0f, random(1), random(2));
      continue;
    }
    // A block of so many points of a Sobol sequence is as even as the first ones are.
    const std::size_t begin = point_of(random(0), points.size() / lit) * lit;
    for (std::size_t p = begin; p < begin + lit; ++p) {
      if (!is_above(p)) continue;
      for (std::size_t i = 0; i < of_point; ++i) {
        const std::uint64_t number = 3 + 2 * ((p - begin) * of_point + i);
        cast.add(p, s, sun, share,
                 (static_cast<double>(i) + random(number)) / static_cast<double>(of_point),
                 random(number + 1));
      }
    }
  }
  cast.batch.cast();
  Eigen::ArrayXXf E = Eigen::ArrayXXf::Zero(static_cast<Eigen::Index>(suns.size()), around.bands);
  for (std::size_t r = 0; r < cast.batch.size(); ++r) {
    const SunDisc& sun = suns[cast.sun[r]];
    Spectrum passed = cast.batch.passed(r);
    if (const auto exit = cast.batch.exit(r, sun_key)) {
      const double edge = 1.0 / std::hypot(1.0, sun.radius);  // the cosine of the disc's edge
      if (exit->direction.dot(sun.direction) >= edge) passed += exit->share;
    }
    E.row(static_cast<Eigen::Index>(cast.sun[r])) +=
        cast.weight[r] * static_cast<float>(cast.batch.cosine(r)) * passed.transpose();
  }
  return E;
}

}  // namespace lightwell
