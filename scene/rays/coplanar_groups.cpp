#include "scene/rays/coplanar_groups.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "scene/rays/convex_hull.h"
#include "scene/rays/float_rounding.h"
#include "scene/sampling.h"

namespace lightwell {

struct CoplanarGroups::Plane {
  int group = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // towards the front
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  // first corner
  double distance = 0.0;                             // from the middle of the geometry, m, >= 0
  double area = 0.0;                                 // m^2
  Eigen::AlignedBox3d box{};
  std::vector<int> vertices{};                 // indices, polygon after polygon
  std::vector<int> ends{};                     // ends of the polygons in `vertices`
  std::vector<Eigen::AlignedBox2d> boxes{};    // of the polygons, by flatten()
  std::vector<Eigen::Vector2d> convex_hull{};  // counter-clockwise, by flatten()
  int seen_along = -1;                         // axis of the last flatten()
};

namespace {

constexpr double margin = 4.0;  // tolerances by which coinciding planes may differ

Eigen::Vector2d flattened(const Eigen::Vector3d& p, int axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

struct DirectedEdge {
  Eigen::Vector3d from, to;
  bool operator==(const DirectedEdge& other) const { return from == other.from && to == other.to; }
  DirectedEdge reversed() const { return {to, from}; }
};

std::uint64_t hash_of(const DirectedEdge& edge) {
  std::uint64_t key = 0;
  for (int c = 0; c < 3; ++c) {
    // -0 and 0 are the same coordinate.
    key = random_key(key, std::bit_cast<std::uint64_t>(edge.from[c] + 0.0),
                     std::bit_cast<std::uint64_t>(edge.to[c] + 0.0));
  }
  return key;
}

// Groups by edge, in a table with open addressing: there is an entry for each edge of each element,
// and most look-ups find nothing.
class GroupsAtEdges {
 public:
  explicit GroupsAtEdges(std::size_t edges) : slots_(std::bit_ceil(2 * edges + 1)) {}

  void add(const DirectedEdge& edge, int group) {
    const std::uint64_t hash = hash_of(edge);
    std::size_t i = hash & (slots_.size() - 1);
    while (slots_[i].entry >= 0) i = next(i);
    slots_[i] = {hash, static_cast<int>(entries_.size())};
    entries_.push_back({edge, group});
  }
  template <class Visit>
  void for_each_group(const DirectedEdge& edge, Visit visit) const {
    const std::uint64_t hash = hash_of(edge);
    for (std::size_t i = hash & (slots_.size() - 1); slots_[i].entry >= 0; i = next(i)) {
      if (slots_[i].hash != hash) continue;
      const Entry& entry = entries_[static_cast<std::size_t>(slots_[i].entry)];
      if (entry.edge == edge) visit(entry.group);
    }
  }

 private:
  struct Slot {
    std::uint64_t hash = 0;
    int entry = -1;  // -1: empty
  };
  struct Entry {
    DirectedEdge edge;
    int group;
  };
  std::size_t next(std::size_t i) const { return (i + 1) & (slots_.size() - 1); }

  std::vector<Slot> slots_;
  std::vector<Entry> entries_{};
};

template <class Visit>
void for_each_polygon(const CastGeometry& geometry, Visit visit) {
  std::size_t primitive = 0;
  for (const auto& triangle : geometry.triangles) visit(geometry.group[primitive++], triangle);
  for (const auto& quad : geometry.quads) visit(geometry.group[primitive++], quad);
}

// Area of a triangle or a convex quadrilateral, m^2.
double area_of(const CastGeometry& geometry, std::span<const int> polygon) {
  const Eigen::Vector3d& corner = geometry.vertices[polygon[0]];
  Eigen::Vector3d twice = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice +=
        (geometry.vertices[polygon[i - 1]] - corner).cross(geometry.vertices[polygon[i]] - corner);
  }
  return 0.5 * twice.norm();
}

template <class Visit>
void for_each_edge(const CastGeometry& geometry, std::span<const int> polygon, Visit visit) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    visit(DirectedEdge{geometry.vertices[polygon[i]],
                       geometry.vertices[polygon[(i + 1) % polygon.size()]]});
  }
}

}  // namespace

bool CoplanarGroups::lie_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::abs(a.dot(b)) > parallel_cosine;
}

// Planes of all groups but round shapes, by distance from the middle of the geometry.
std::vector<CoplanarGroups::Plane> CoplanarGroups::planes_of(const CastGeometry& geometry) {
  int groups = 0;
  for (const int g : geometry.group) groups = std::max(groups, g + 1);
  std::vector<Plane> planes(groups);
  Eigen::AlignedBox3d all;
  for_each_polygon(geometry, [&](int group, std::span<const int> polygon) {
    Plane& plane = planes[group];
    for (const int v : polygon) plane.box.extend(geometry.vertices[v]);
    all.extend(plane.box);
    plane.vertices.insert(plane.vertices.end(), polygon.begin(), polygon.end());
    plane.ends.push_back(static_cast<int>(plane.vertices.size()));
    plane.area += area_of(geometry, polygon);
    if (!plane.normal.isZero()) return;
    const Eigen::Vector3d& corner = geometry.vertices[polygon[0]];
    const Eigen::Vector3d n =
        (geometry.vertices[polygon[1]] - corner).cross(geometry.vertices[polygon[2]] - corner);
    if (!(n.norm() > 0.0)) return;
    plane.group = group;
    plane.normal = n.normalized();
    plane.corner = corner;
  });
  std::erase_if(planes, [](const Plane& p) { return p.normal.isZero(); });
  for (Plane& plane : planes) {
    plane.distance = std::abs(plane.normal.dot(plane.corner - all.center()));
  }
  std::sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.group < b.group;
  });
  return planes;
}

CoplanarGroups::CoplanarGroups(const CastGeometry& geometry, double tolerance) {
  std::vector<Plane> planes = planes_of(geometry);
  for (Plane& plane : planes) {
    // Margins: boxes of flat things are flat, and boxes set apart by rounding must meet. The ray
    // caster's allowance for rounding must not take a ray that starts a little off the plane across
    // the plane.
    plane.box.min().array() -= margin * tolerance;
    plane.box.max().array() += margin * tolerance;
    if (plane.group >= static_cast<int>(groups_.size())) groups_.resize(plane.group + 1);
    Group& group = groups_[plane.group];
    // A direction seldom in any plane of a scene, so that coinciding planes have normals of one
    // sign.
    const Eigen::Vector3d askew(0.8191, 0.4927, 0.2937);
    group.facing = plane.normal.dot(askew) < 0.0 ? -1 : 1;
    group.normal = group.facing * plane.normal;
    group.corner = plane.corner;
    group.area = plane.area;
  }
  std::vector<Pair> pairs;
  for (std::size_t begin = 0, end = 0; begin < planes.size(); begin = end) {
    end = begin + 1;
    while (end < planes.size() && planes[end].distance - planes[end - 1].distance <= tolerance) {
      ++end;
    }
    add_overlaps(geometry, {planes.data() + begin, end - begin}, tolerance, pairs);
  }
  align_normals(pairs);
  for (Group& group : groups_) group.overlaps.sort();
  const bool has_any = std::any_of(groups_.begin(), groups_.end(),
                                   [](const Group& g) { return !g.overlaps.empty(); });
  if (!has_any) return;
  find_bodies(geometry, tolerance);
  sort_by_side(pairs);
}

void CoplanarGroups::sort_by_side(const std::vector<Pair>& pairs) {
  for (const auto& [pair, box] : pairs) {
    for (const int i : {0, 1}) {
      const int side = order(pair[1 - i], pair[i]);
      if (side > 0) groups_[pair[i]].above.add(box);
      if (side < 0) groups_[pair[i]].below.add(box);
    }
  }
  for (Group& group : groups_) {
    group.above.sort();
    group.below.sort();
  }
}

// Rounding may still have given two normals of one plane opposite signs.
void CoplanarGroups::align_normals(const std::vector<Pair>& pairs) {
  const bool are_aligned = std::ranges::all_of(pairs, [&](const Pair& pair) {
    return normal(pair.group[0]).dot(normal(pair.group[1])) > 0.0;
  });
  if (are_aligned) return;
  std::map<int, std::vector<int>> others;
  for (const Pair& pair : pairs) {
    const auto [a, b] = pair.group;
    others[a].push_back(b);
    others[b].push_back(a);
  }
  std::vector<char> is_done(groups_.size(), 0);
  for (const auto& entry : others) {
    std::vector<int> open = {entry.first};
    is_done[entry.first] = 1;
    while (!open.empty()) {
      const int a = open.back();
      open.pop_back();
      for (const int b : others[a]) {
        if (is_done[b]) continue;
        is_done[b] = 1;
        open.push_back(b);
        if (normal(a).dot(normal(b)) > 0.0) continue;
        groups_[b].normal = -groups_[b].normal;
        groups_[b].facing = -groups_[b].facing;
      }
    }
  }
}

// The body of a group consists of the faces that meet the group along an edge and run along the
// edge in the opposite direction, as faces of one surface do. Walls of the next room are thereby
// left out.
void CoplanarGroups::find_bodies(const CastGeometry& geometry, double tolerance) {
  std::size_t edges = 0;
  for_each_polygon(geometry, [&](int group, std::span<const int> polygon) {
    if (has_overlaps(group)) edges += polygon.size();
  });
  GroupsAtEdges groups_at(edges);
  for_each_polygon(geometry, [&](int group, std::span<const int> polygon) {
    if (!has_overlaps(group)) return;
    for_each_edge(geometry, polygon, [&](const DirectedEdge& edge) { groups_at.add(edge, group); });
  });
  std::vector<double> side(groups_.size(), 0.0);  // length of edges above less below, m
  for_each_polygon(geometry, [&](int group, std::span<const int> polygon) {
    for_each_edge(geometry, polygon, [&](const DirectedEdge& edge) {
      groups_at.for_each_group(edge.reversed(), [&](int other) {
        if (other == group) return;
        double above = 0.0, below = 0.0;
        for (const int v : polygon) {
          const double h = height(other, geometry.vertices[v]);
          above = std::max(above, h);
          below = std::max(below, -h);
        }
        if (std::max(above, below) <= tolerance) return;
        const double length = (edge.to - edge.from).norm();
        side[other] += above > below ? length : -length;
      });
    });
  });
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].body = side[g] > 0.0 ? 1 : side[g] < 0.0 ? -1 : 0;
  }
}

int CoplanarGroups::order(int a, int b) const {
  if (a == b) return 0;
  const Group &first = groups_[a], &second = groups_[b];
  if (first.body != 0 && second.body != 0) {
    // Away from the plane: a room's wall first, then the contents of the room.
    const auto level = [](const Group& g) {
      const bool is_solid = g.body != g.facing;
      return g.body * (is_solid ? 2 : 1);
    };
    const int difference = level(first) - level(second);
    if (difference != 0) return difference > 0 ? 1 : -1;
  }
  if (first.facing != second.facing) {
    const bool is_leaf = first.body == 0 && second.body == 0 && have_one_area(first, second);
    return is_leaf ? first.facing : -first.facing;
  }
  return lies_before(a, b) ? first.facing : -first.facing;
}

bool CoplanarGroups::have_one_area(const Group& a, const Group& b) {
  constexpr double same = 1e-6;  // share of the area; float coordinates round to about 1e-7
  return std::abs(a.area - b.area) <= same * (a.area + b.area);
}

// True if the first of two groups that face the same way lies before the other. A sheet of the area
// of a body's face, such as the light of a luminaire's housing, lies before the face. What is the
// same twice must be one surface everywhere, so numbers decide last.
bool CoplanarGroups::lies_before(int a, int b) const {
  const Group &first = groups_[a], &second = groups_[b];
  if (!have_one_area(first, second)) return first.area < second.area;
  const bool is_sheet = first.body == 0;
  return is_sheet == (second.body == 0) ? a < b : is_sheet;
}

// Sweeps along x over planes at one distance from the middle.
void CoplanarGroups::add_overlaps(const CastGeometry& geometry,
                                  std::span<CoplanarGroups::Plane> planes, double tolerance,
                                  std::vector<Pair>& pairs) {
  std::sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) {
    const double x = a.box.min().x(), y = b.box.min().x();
    return x != y ? x < y : a.group < b.group;
  });
  // Beyond this number of pairs all groups count as covered, which costs their rays time only.
  std::size_t pairs_left = 1000 * planes.size();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    Plane& a = planes[i];
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      Plane& b = planes[j];
      if (b.box.min().x() > a.box.max().x()) break;
      if (pairs_left-- == 0) {
        for (const Plane& plane : planes) {
          Group& group = groups_[plane.group];
          group.overlaps = group.above = group.below = Boxes(plane.box);
        }
        return;
      }
      if (!lie_parallel(a.normal, b.normal) || !a.box.intersects(b.box)) continue;
      const Eigen::AlignedBox3d shared = a.box.intersection(b.box);
      if (!is_one_plane(a, b, shared.center(), tolerance)) continue;
      // Facets that share an edge have boxes that meet, without lying on each other.
      int along = 0;
      a.normal.cwiseAbs().maxCoeff(&along);
      flatten(geometry, along, a);
      flatten(geometry, along, b);
      if (is_apart(a.convex_hull, b.convex_hull, tolerance) ||
          is_apart(b.convex_hull, a.convex_hull, tolerance) ||
          !share_area(geometry, a, b, along, tolerance)) {
        continue;
      }
      pairs.push_back({.group = {a.group, b.group}, .box = shared});
      for (const int g : pairs.back().group) groups_[g].overlaps.add(shared);
    }
  }
}

// True if any two polygons of the planes share area. Hulls may where polygons do not: a lamp lies
// in the hole of its ceiling. Also true for very many polygons, untested.
bool CoplanarGroups::share_area(const CastGeometry& geometry, const Plane& a, const Plane& b,
                                int along, double tolerance) {
  using Polygons = std::vector<std::vector<Eigen::Vector2d>>;
  const Eigen::AlignedBox3d shared = a.box.intersection(b.box);
  const Eigen::AlignedBox2d there(flattened(shared.min(), along), flattened(shared.max(), along));
  const auto polygons_there = [&](const Plane& plane) {
    Polygons polygons;
    for (std::size_t p = 0; p < plane.ends.size(); ++p) {
      if (!plane.boxes[p].intersects(there)) continue;
      std::vector<Eigen::Vector2d> points;
      for (int i = p == 0 ? 0 : plane.ends[p - 1]; i < plane.ends[p]; ++i) {
        points.push_back(flattened(geometry.vertices[plane.vertices[i]], along));
      }
      polygons.push_back(convex_hull(std::move(points)));
    }
    return polygons;
  };
  const Polygons ones = polygons_there(a), others = polygons_there(b);
  constexpr std::size_t most_pairs = 1 << 18;
  if (ones.size() * others.size() > most_pairs) return true;
  return std::ranges::any_of(ones, [&](const auto& one) {
    return std::ranges::any_of(others, [&](const auto& other) {
      return !is_apart(one, other, tolerance) && !is_apart(other, one, tolerance);
    });
  });
}

// Planes on opposite sides of the middle are at the same distance as coinciding planes, so the
// heights of `place` are compared.
bool CoplanarGroups::is_one_plane(const Plane& a, const Plane& b, const Eigen::Vector3d& place,
                                  double tolerance) {
  const double above_a = a.normal.dot(place - a.corner), above_b = b.normal.dot(place - b.corner);
  return std::abs(a.normal.dot(b.normal) > 0.0 ? above_a - above_b : above_a + above_b) <=
         margin * tolerance;
}

void CoplanarGroups::flatten(const CastGeometry& geometry, int along, Plane& plane) {
  if (plane.seen_along == along) return;
  std::vector<Eigen::Vector2d> points;
  plane.boxes.clear();
  std::size_t polygon = 0;
  for (std::size_t i = 0; i < plane.vertices.size(); ++i) {
    points.push_back(flattened(geometry.vertices[plane.vertices[i]], along));
    if (static_cast<int>(i) >= plane.ends[polygon]) ++polygon;
    if (polygon == plane.boxes.size()) plane.boxes.emplace_back();
    plane.boxes[polygon].extend(points.back());
  }
  plane.convex_hull = convex_hull(std::move(points));
  plane.seen_along = along;
}

bool CoplanarGroups::may_be_covered(int group, const Eigen::Vector3d& point) const {
  return is_known(group) && groups_[group].overlaps.contain(point);
}

bool CoplanarGroups::may_be_covered(int group, const Eigen::Vector3d& point,
                                    const Eigen::Vector3d& direction) const {
  if (!is_known(group)) return false;
  const Group& of = groups_[group];
  return (of.normal.dot(direction) > 0.0 ? of.above : of.below).contain(point);
}

void CoplanarGroups::Boxes::sort() {
  if (boxes_.empty()) return;
  Eigen::AlignedBox3d all;
  for (const Eigen::AlignedBox3d& box : boxes_) all.extend(box);
  all.sizes().maxCoeff(&axis_);
  const auto low = [this](const Eigen::AlignedBox3d& box) { return box.min()[axis_]; };
  std::ranges::stable_sort(boxes_, {}, low);
  reach_.clear();
  for (const Eigen::AlignedBox3d& box : boxes_) {
    reach_.push_back(std::max(reach_.empty() ? box.max()[axis_] : reach_.back(), box.max()[axis_]));
  }
}

bool CoplanarGroups::Boxes::contain(const Eigen::Vector3d& point) const {
  const double at = point[axis_];
  const auto end = std::ranges::partition_point(
      boxes_, [&](const Eigen::AlignedBox3d& box) { return box.min()[axis_] <= at; });
  for (std::size_t i = static_cast<std::size_t>(end - boxes_.begin()); i-- > 0;) {
    if (reach_[i] < at) return false;
    if (boxes_[i].contains(point)) return true;
  }
  return false;
}

}  // namespace lightwell
