#include "radiosity/openings/portals.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <ranges>
#include <span>

#include "radiosity/journal/journal_phase.h"
#include "radiosity/openings/sights.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// True if an opening is less wide than `share` of the mean distance to what it shows.
bool is_narrower(const Opening& opening, const Sight& sight, double share) {
  return 2.0 * opening.across.norm() * sight.paths < share * sight.distance;
}

// True if both sides are wider than the opening. Behind the mouth of a crevice, such as that
// between a lamp and the ceiling, they are not.
bool joins_parts(const std::array<Sight, 2>& sight) {
  constexpr double wider = 2.0;
  return sight[0].spread > wider && sight[1].spread > wider;
}

bool has_contrast(const std::array<Sight, 2>& sight, double least) {
  const double front = sight[0].mean(), back = sight[1].mean();
  return std::max(front, back) > least * std::min(front, back);
}

}  // namespace

Portals::Portals(const ElementCaster& caster, const std::vector<float>& brightness,
                 const std::vector<Opening>& openings) {
  constexpr int few = 8, many = Sights::most_paths;
  const Sights sights(caster, brightness);
  std::vector<std::array<Sight, 2>> seen(openings.size());
  parallel_for(static_cast<int>(openings.size()), 4, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      auto& sight = seen[static_cast<std::size_t>(i)];
      const auto key = static_cast<std::uint64_t>(i);
      const Opening& opening = openings[static_cast<std::size_t>(i)];
      for (const int side : {0, 1}) sights.look(opening, key, side, 0, few, sight[side]);
      const bool is_dark = !(sight[0].brightness + sight[1].brightness > 0.0);
      if (!is_dark && !has_contrast(sight, 0.25 * least_contrast)) continue;
      for (const int side : {0, 1}) sights.look(opening, key, side, few, many, sight[side]);
    }
  });
  for (std::size_t i = 0; i < openings.size(); ++i) {
    if (!joins_parts(seen[i]) || !has_contrast(seen[i], least_contrast)) continue;
    const Opening& shape = openings[i];
    Portal& portal = portals_.emplace_back();
    portal.shape = shape;
    portal.along = shape.along / shape.along.squaredNorm();
    portal.across = shape.across / shape.across.squaredNorm();
    portal.area = shape.area();
    portal.is_narrow = is_narrower(shape, seen[i][0], narrow_for_rows) &&
                       is_narrower(shape, seen[i][1], narrow_for_rows);
    for (const int side : {0, 1}) {
      portal.brightness[side] = seen[i][side].mean();
      portal.is_dim[side] = seen[i][side].mean() < seen[i][1 - side].mean();
      Eigen::AlignedBox3d& region = portal.region[side] = seen[i][side].region;
      for (const double s : {-1.0, 1.0}) {
        region.extend(shape.center + s * shape.along);
        region.extend(shape.center + s * shape.across);
      }
      constexpr double margin = 0.1;  // what a few paths leave out
      const Vector3d more = Vector3d::Constant(margin * region.sizes().maxCoeff());
      region = Eigen::AlignedBox3d(region.min() - more, region.max() + more);
    }
  }
  if (portals_.size() > static_cast<std::size_t>(most)) {
    const auto power = [](const Portal& portal) {
      return portal.area * std::max(portal.brightness[0], portal.brightness[1]);
    };
    std::stable_sort(portals_.begin(), portals_.end(),
                     [&](const Portal& a, const Portal& b) { return power(a) > power(b); });
    portals_.resize(static_cast<std::size_t>(most));
  }
  std::vector<BoxTree::Box> boxes;
  for (const Portal& portal : portals_) {
    const Vector3d reach = portal.shape.along.cwiseAbs() + portal.shape.across.cwiseAbs();
    boxes.emplace_back(portal.shape.center - reach, portal.shape.center + reach);
  }
  boxes_ = BoxTree(std::move(boxes));
}

template <class Numbers, class Weight>
Portals::View Portals::view_of(const Numbers& portals, const Vector3d& from, const Vector3d& normal,
                               int rays, Weight weight) const {
  // Cosine-distributed rays that pass a portal, from which number on they leave less noise than
  // aimed ones would.
  constexpr double few = 4.0;
  View view;
  double sum = 0.0;
  for (const int number : portals) {
    const Portal& portal = portals_[static_cast<std::size_t>(number)];
    const Vector3d to = portal.shape.center - from;
    const double height = -to.dot(portal.shape.normal);  // before the front
    const int side = height > 0.0 ? 0 : 1;
    const double of_light = weight(number, side);
    if (!(of_light > 0.0) || !portal.region[side].contains(from)) continue;
    const double radius = portal.shape.along.norm() + portal.shape.across.norm();
    const double rise = to.dot(normal) + radius;  // bound for the portal's highest point
    if (!(rise > 0.0)) continue;
    const double distance2 = to.squaredNorm(), distance = std::sqrt(distance2);
    // Approximate form factor from the point to the portal. Its plane is never seen quite edge-on:
    // the point is one of many of a patch, and rectangles follow real openings roughly.
    const double slant = std::max(std::abs(height), 0.02 * distance) / (distance + radius);
    const double form_factor = std::min(rise / (distance + radius), 1.0) * slant * portal.area /
                               (std::numbers::pi * distance2 + portal.area);
    sum += of_light * form_factor / (1.0 + rays * form_factor / few);
    view.entries_.push_back({number, sum});
  }
  for (View::Entry& entry : view.entries_) entry.up_to /= sum;
  if (!view.entries_.empty()) view.entries_.back().up_to = 1.0;
  return view;
}

// Brightness that a portal shows to its side: nothing to the brighter one.
double Portals::light_towards(int portal, int side) const {
  const Portal& of = portals_[static_cast<std::size_t>(portal)];
  return of.is_dim[side] ? of.brightness[1 - side] : 0.0;
}

Portals::View Portals::view(const Vector3d& from, const Vector3d& normal, int rays) const {
  return view_of(std::views::iota(0, size()), from, normal, rays,
                 [this](int portal, int side) { return light_towards(portal, side); });
}

Portals::View Portals::view_near(const Vector3d& from, const Vector3d& normal, double reach) const {
  thread_local std::vector<int> around;
  const Vector3d all_ways = Vector3d::Constant(reach);
  boxes_.find_overlaps({from - all_ways, from + all_ways}, around);
  return view_of(around, from, normal, 1,
                 [this](int portal, int side) { return light_towards(portal, side); });
}

Portals::View Portals::view_both_ways(const Vector3d& from, const Vector3d& normal,
                                      int rays) const {
  return view_of(std::views::iota(0, size()), from, normal, rays, [](int, int) { return 1.0; });
}

Portals::Aim Portals::draw(const View& view, const Vector3d& from, double which, double u,
                           double v) const {
  const auto& entries = view.entries_;
  const auto found = std::upper_bound(entries.begin(), entries.end() - 1, which,
                                      [](double x, const View::Entry& e) { return x < e.up_to; });
  const Opening& shape = portals_[static_cast<std::size_t>(found->portal)].shape;
  const Vector3d at = shape.center + (2.0 * u - 1.0) * shape.along + (2.0 * v - 1.0) * shape.across;
  return {(at - from).normalized(), found->portal};
}

// Distance to where a ray passes a portal, metres from its origin; infinite if it does not.
double Portals::distance_to(const Portal& portal, const Vector3d& from, const Vector3d& direction) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const Vector3d to = portal.shape.center - from;
  const double cosine = direction.dot(portal.shape.normal), height = to.dot(portal.shape.normal);
  if (!(cosine * height > 0.0)) return never;
  const double t = height / cosine;
  const Vector3d at = t * direction - to;
  const bool is_beside =
      std::abs(at.dot(portal.along)) > 1.0 || std::abs(at.dot(portal.across)) > 1.0;
  return is_beside ? never : t;
}

bool Portals::passes(const Aim& aim, const Vector3d& from, double distance) const {
  return distance_to(portals_[static_cast<std::size_t>(aim.portal)], from, aim.direction) <=
         distance;
}

double Portals::density(const View& view, const Vector3d& from, const Vector3d& direction,
                        double distance) const {
  const auto& entries = view.entries_;
  double sum = 0.0;
  const auto add = [&](std::size_t i) {
    // Bounds the density where a portal is seen edge-on and has no solid angle.
    constexpr double grazing = 1e-9;
    const Portal& portal = portals_[static_cast<std::size_t>(entries[i].portal)];
    const double t = distance_to(portal, from, direction);
    if (!(t <= distance)) return;
    const double chance = entries[i].up_to - (i > 0 ? entries[i - 1].up_to : 0.0);
    const double cosine = std::abs(direction.dot(portal.shape.normal));
    sum += chance * t * t / (portal.area * std::max(cosine, grazing));
  };
  constexpr std::size_t few = 64;  // take less time one by one than the search along the ray
  if (entries.size() <= few) {
    for (std::size_t i = 0; i < entries.size(); ++i) add(i);
    return sum;
  }
  constexpr double farthest = 1e30, rounding = 1e-9;  // m
  thread_local std::vector<int> along;
  auto visits = std::numeric_limits<std::int64_t>::max();
  boxes_.find_along(from, from + std::min(distance, farthest) * direction, rounding, visits, along);
  std::ranges::sort(along);  // sums are the same as one by one
  for (const int number : along) {
    const auto entry = std::ranges::lower_bound(entries, number, {}, &View::Entry::portal);
    if (entry != entries.end() && entry->portal == number) {
      add(static_cast<std::size_t>(entry - entries.begin()));
    }
  }
  return sum;
}

bool Portals::part(const Vector3d& a, const Vector3d& b) const {
  return std::any_of(portals_.begin(), portals_.end(), [&](const Portal& portal) {
    const bool a_is_behind = (a - portal.shape.center).dot(portal.shape.normal) < 0.0;
    const bool b_is_behind = (b - portal.shape.center).dot(portal.shape.normal) < 0.0;
    return a_is_behind != b_is_behind && portal.region[a_is_behind ? 1 : 0].contains(a) &&
           portal.region[b_is_behind ? 1 : 0].contains(b);
  });
}

bool Portals::is_near(const Vector3d& at, double size) const {
  constexpr double least_height = 1e-3;
  const double reach = near_sizes * size;
  thread_local std::vector<int> around;
  const Vector3d all_ways = Vector3d::Constant(reach);
  boxes_.find_overlaps({at - all_ways, at + all_ways}, around);
  return std::ranges::any_of(around, [&](int number) {
    const Portal& portal = portals_[static_cast<std::size_t>(number)];
    if (!portal.is_narrow) return false;
    const Vector3d to = at - portal.shape.center;
    const double height = to.dot(portal.shape.normal);
    if (!portal.is_dim[height > 0.0 ? 0 : 1] || std::abs(height) > reach) return false;
    const double u = std::clamp(to.dot(portal.along), -1.0, 1.0),
                 v = std::clamp(to.dot(portal.across), -1.0, 1.0);
    const Vector3d from_portal = to - u * portal.shape.along - v * portal.shape.across;
    return from_portal.squaredNorm() < reach * reach && std::abs(height) > least_height * size;
  });
}

std::vector<Opening> narrow_openings(const ElementCaster& caster, std::vector<Opening> openings,
                                     double share, const RunControl& run) {
  constexpr int paths = 16;
  const std::vector<float> dark(static_cast<std::size_t>(caster.mesh().element_count()), 0.0f);
  const Sights sights(caster, dark);
  std::vector<char> is_narrow(openings.size(), 0);
  const auto count = static_cast<int>(openings.size());
  const JournalPhase phase({.processes = run.processes}, "narrow openings",
                           [&](Fingerprint& print) {
                             print.add_geometry(caster.mesh());
                             print.add(count);
                             print.add(share);
                           });
  const auto judge = [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      char& answer = is_narrow[static_cast<std::size_t>(i)];
      if (phase.recall(i, answer)) continue;
      const Opening& opening = openings[static_cast<std::size_t>(i)];
      std::array<Sight, 2> sight;
      bool narrow_on_both = true;
      for (const int side : {0, 1}) {
        sights.look(opening, static_cast<std::uint64_t>(i), side, 0, paths, sight[side]);
        narrow_on_both = narrow_on_both && is_narrower(opening, sight[side], share);
      }
      answer = narrow_on_both && joins_parts(sight) ? 1 : 0;
      phase.keep(i, answer);
    }
  };
  phase.for_each({0, count, 4}, judge);
  std::vector<Opening> result;
  for (std::size_t i = 0; i < openings.size(); ++i) {
    if (is_narrow[i]) result.push_back(openings[i]);
  }
  return result;
}

std::vector<Opening> notable_openings(const ElementCaster& caster,
                                      const std::vector<float>& brightness,
                                      const std::vector<float>& reference,
                                      std::vector<Opening> openings) {
  constexpr int paths = 16;
  constexpr double notable = 1e-3;
  const Sights sights(caster, brightness, reference);
  const auto is_notable = [&](int i) {
    const Opening& opening = openings[static_cast<std::size_t>(i)];
    std::array<Sight, 2> seen;
    for (const int side : {0, 1}) {
      sights.look(opening, static_cast<std::uint64_t>(i), side, 0, paths, seen[side]);
    }
    const int dim = seen[0].mean() < seen[1].mean() ? 0 : 1;
    const Vector3d size = seen[dim].region.sizes();
    // None of many paths got through, so less than a fortieth of the light does (rule of three).
    if (seen[dim].paths == 0) return false;
    if (seen[dim].region.isEmpty()) return true;
    // The box of few ends is too small, and that of one is a point. Light that goes as far as the
    // ends spreads over half of a sphere.
    const double box = 2.0 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x()),
                 half_sphere = 2.0 * std::numbers::pi * seen[dim].squares / seen[dim].paths,
                 surface = std::max(box, half_sphere);
    return seen[1 - dim].mean() * opening.area() >=
           notable * surface * seen[dim].reference / seen[dim].paths;
  };
  std::vector<char> is_kept(openings.size(), 1);
  parallel_for(static_cast<int>(openings.size()), 4, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) is_kept[i] = is_notable(i) ? 1 : 0;
  });
  std::erase_if(openings, [&, i = 0](const Opening&) mutable { return is_kept[i++] == 0; });
  return openings;
}

std::shared_ptr<const Portals> find_portals(const ElementCaster& caster,
                                            const std::vector<float>& brightness,
                                            const std::vector<Opening>& openings,
                                            const RunControl& run) {
  const std::vector<Opening> narrow = narrow_openings(caster, openings, narrow_for_gathers, run);
  if (narrow.empty()) return nullptr;
  auto portals = std::make_shared<const Portals>(caster, brightness, narrow);
  return portals->is_empty() ? nullptr : portals;
}

std::shared_ptr<const Portals> find_portals(const Scene& scene, const ElementCaster& caster,
                                            const std::vector<float>& brightness) {
  return find_portals(caster, brightness, find_openings(scene));
}

std::vector<float> brightness_of_vertices(const PatchMesh& mesh, const BandArray& radiosity) {
  std::vector<float> of_element(static_cast<std::size_t>(mesh.element_count()), 0.0f);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int corners = mesh.corner_count(e);
    for (int c = 0; c < corners; ++c) {
      of_element[static_cast<std::size_t>(e)] +=
          radiosity.row(mesh.corners[e][c]).sum() / static_cast<float>(corners);
    }
  }
  return of_element;
}

std::vector<float> brightness_of_patches(const PatchMesh& mesh, const DirectLight& direct_light,
                                         const BandArray& radiosity) {
  std::vector<float> of_element(static_cast<std::size_t>(mesh.element_count()), 0.0f);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    float& brightness = of_element[static_cast<std::size_t>(e)] = radiosity.row(p).sum();
    if (direct_light.owns(mesh.facet[e], mesh.is_back[p] != 0)) {
      brightness -= mesh.emission.row(p).sum();
    }
  }
  return of_element;
}

}  // namespace lightwell
