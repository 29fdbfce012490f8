#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/patches/round_grid.h"
#include "radiosity/form_factors/hemicube_view.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Planes that bound the pyramids of the five faces, one bit each: the vertex is beyond the plane. A
// polygon whose vertices are all beyond one bounding plane of a face is invisible on that face.
enum Beyond : std::uint16_t {
  below_horizon = 1,
  x_above_z = 1 << 1,
  minus_x_above_z = 1 << 2,
  y_above_z = 1 << 3,
  minus_y_above_z = 1 << 4,
  z_above_x = 1 << 5,
  z_above_minus_x = 1 << 6,
  z_above_y = 1 << 7,
  z_above_minus_y = 1 << 8,
  x_above_y = 1 << 9,
  y_above_x = 1 << 10,
  sum_positive = 1 << 11,  // x > -y, and y > -x
  sum_negative = 1 << 12,
};
constexpr std::array<std::uint16_t, HemicubeCells::face_count> beyond_face = {
    x_above_z | minus_x_above_z | y_above_z | minus_y_above_z,
    below_horizon | z_above_x | y_above_x | sum_negative,
    below_horizon | z_above_minus_x | x_above_y | sum_positive,
    below_horizon | z_above_y | x_above_y | sum_negative,
    below_horizon | z_above_minus_y | y_above_x | sum_positive};

std::uint16_t beyond(const Vector3d& p) {
  const double x = p.x(), y = p.y(), z = p.z();
  const auto bit = [](bool is, unsigned mask) { return is ? mask : 0u; };
  return static_cast<std::uint16_t>(
      bit(!(z > 0), below_horizon) | bit(x > z, x_above_z) | bit(-x > z, minus_x_above_z) |
      bit(y > z, y_above_z) | bit(-y > z, minus_y_above_z) | bit(z > x, z_above_x) |
      bit(z > -x, z_above_minus_x) | bit(z > y, z_above_y) | bit(z > -y, z_above_minus_y) |
      bit(x > y, x_above_y) | bit(y > x, y_above_x) | bit(x + y > 0, sum_positive) |
      bit(x + y < 0, sum_negative));
}

// Normal of the plane through the eye and an edge. The reversed edge gives exactly the negative, so
// that neighbours agree on the side of every cell, even with fused multiply-add.
Vector3d edge_plane(const Vector3d& from, const Vector3d& to) {
  const bool in_order =
      std::lexicographical_compare(from.data(), from.data() + 3, to.data(), to.data() + 3);
  if (in_order) return from.cross(to);
  return -to.cross(from);
}

// Smallest integer that is not less than x, clamped to [0, count].
int first_cell_from(double x, int count) {
  x = std::min(std::max(x, 0.0), static_cast<double>(count));
  const int whole = static_cast<int>(x);
  return whole < x ? whole + 1 : whole;
}

// Factor of inverse distance that counts as nearer. Coincident surfaces then show as one, the first
// drawn, instead of a speckle of rounding errors. An element shows before a coincident black back:
// at the silhouette of a block the faces on both sides of the edge are equally far.
constexpr float nearer = 1.0f + 1e-6f;
// Inverse distance of a surface that lies on the eye.
constexpr float covered = std::numeric_limits<float>::infinity();

void paint_span(float* inverse_distance, int* items, int count, float first, float step, int item) {
  for (int i = 0; i < count; ++i) {
    const float here = first + step * static_cast<float>(i);
    const bool is_before_back = item >= 0 && items[i] < hemicube_item::nothing;
    const bool shows = here > inverse_distance[i] * nearer ||
                       (is_before_back && here * nearer >= inverse_distance[i]);
    inverse_distance[i] = shows ? here : inverse_distance[i];
    items[i] = shows ? item : items[i];
  }
}

}  // namespace

// Draws one hemicube.
class HemicubeScan::Painter {
 public:
  Painter(const HemicubeScan& scan, const HemicubeEye& eye, const HemicubeCells& cells,
          Scratch& scratch, std::span<int> items)
      : scan_(scan), eye_(eye), cells_(cells), scratch_(scratch), items_(items) {}

  void paint_group(const Group& group) {
    if (group.facet == eye_.facet && !eye_.inside) return;
    const double height = eye_.frame.col(2).dot(group.center - eye_.position);
    if (height < -group.radius) return;
    const Eigen::Matrix3d to_frame = eye_.frame.transpose();
    for (int v = group.first_vertex; v < group.last_vertex; ++v) {
      scratch_.vertex[v] = to_frame * (scan_.vertices_[v] - eye_.position);
      scratch_.outside[v] = beyond(scratch_.vertex[v]);
    }
    for (int p = group.first_polygon; p < group.last_polygon; ++p) {
      paint(scan_.polygons_[p], group.facet);
    }
  }

 private:
  void paint(const Polygon& polygon, int facet) {
    std::uint16_t outside = 0xffff;
    for (int v : polygon.vertex) outside &= scratch_.outside[v];
    if (polygon.element == eye_.element || polygon.behind == eye_.element) return;
    const Vector3d normal = eye_.frame.transpose() * polygon.normal;
    const double distance = normal.dot(scratch_.vertex[polygon.vertex[0]]);
    constexpr double parallel = 1.0 - 1e-9;
    if (std::abs(distance) <= scan_.coplanar_ && std::abs(normal.z()) > parallel) {
      paint_coplanar(polygon, facet, normal.z());
      return;
    }
    if (distance < 0.0 ? polygon.front_hidden : polygon.back_hidden) return;
    if ((outside & below_horizon) != 0 || distance == 0.0) return;
    // A direction d is inside the pyramid where inwards * (d . edge plane) > 0 for all edges.
    const double inwards = distance < 0.0 ? -1.0 : 1.0;
    std::array<Vector3d, 4> planes;
    for (int k = 0; k < polygon.corner_count; ++k) {
      const int next = k + 1 < polygon.corner_count ? k + 1 : 0;
      planes[k] = inwards * edge_plane(scratch_.vertex[polygon.vertex[k]],
                                       scratch_.vertex[polygon.vertex[next]]);
    }
    const int item = distance < 0.0 ? polygon.element : polygon.behind;
    for (int f = 0; f < HemicubeCells::face_count; ++f) {
      if ((outside & beyond_face[f]) != 0) continue;
      paint_face(f, polygon, planes, normal / distance, item);
    }
  }

  // A polygon in the eye's own plane. If it lies on the eye, the eye sees nothing else (the floor
  // under a block).
  void paint_coplanar(const Polygon& polygon, int facet, double normal_z) {
    const Vector3d upwards = eye_.frame.col(2);
    const bool lies_on_eye =
        eye_.facet < 0 ? normal_z < 0.0 : scan_.caster_.meets_first(eye_.facet, facet, upwards);
    if (!lies_on_eye) return;
    const bool covered_before = scratch_.inverse_distance[0] == covered;
    if (covered_before &&
        !scan_.caster_.meets_first(facet, hemicube_item::facet(scan_.caster_.mesh(), items_[0]),
                                   upwards)) {
      return;
    }
    const double counter_clockwise = normal_z > 0.0 ? 1.0 : -1.0;
    for (int k = 0; k < polygon.corner_count; ++k) {
      const int next = k + 1 < polygon.corner_count ? k + 1 : 0;
      const Vector3d& a = scratch_.vertex[polygon.vertex[k]];
      const Vector3d& b = scratch_.vertex[polygon.vertex[next]];
      if (!(counter_clockwise * (a.x() * b.y() - a.y() * b.x()) >= 0.0)) return;
    }
    std::fill(items_.begin(), items_.end(), normal_z > 0.0 ? polygon.behind : polygon.element);
    std::fill(scratch_.inverse_distance.begin(), scratch_.inverse_distance.end(), covered);
  }

  // Cells from `first` to `last` - 1.
  struct Range {
    int first, last;
  };
  struct Bounds {
    Range rows, columns;
  };

  // Cells spanned by the polygon's corners; all cells if a corner is beside or behind the eye.
  Bounds bounds(int f, const Polygon& polygon) const {
    const HemicubeCells::Face& face = HemicubeCells::face(f);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double bottom = infinity, top = -infinity, left = infinity, right = -infinity;
    const int row_count = cells_.rows(f), column_count = cells_.resolution();
    for (int v : polygon.vertex) {
      const Vector3d& p = scratch_.vertex[v];
      const double outwards = face.outward_sign * p[face.outward_axis];
      if (!(outwards > 0.0)) return {{0, row_count}, {0, column_count}};
      const double scale = 1.0 / (outwards * cells_.step());
      bottom = std::min(bottom, p[face.row_axis] * scale);
      top = std::max(top, p[face.row_axis] * scale);
      left = std::min(left, p[face.column_axis] * scale);
      right = std::max(right, p[face.column_axis] * scale);
    }
    // Bounds must not be too narrow; the edges then decide which cells are covered.
    constexpr double rounding = 1e-6;  // of a cell; far above the rounding of a division
    const auto range = [&](double low, double high, double offset, int count) -> Range {
      const double zero = offset / cells_.step();
      return {first_cell_from(low - zero - rounding, count),
              first_cell_from(high - zero + rounding, count)};
    };
    return {range(bottom, top, cells_.row_offset(f), row_count),
            range(left, right, cells_.column_offset(), column_count)};
  }

  // Crossing of an edge with the rows: column = start + slope * row. A cell whose centre lies on
  // the edge belongs to the polygon on the right, for an edge along the rows to the polygon on the
  // higher side.
  struct Crossing {
    double start, slope;
  };

  void paint_face(int f, const Polygon& polygon, const std::array<Vector3d, 4>& planes,
                  const Vector3d& normal_over_distance, int item) {
    const HemicubeCells::Face& face = HemicubeCells::face(f);
    auto [rows, columns] = bounds(f, polygon);
    if (rows.first >= rows.last || columns.first >= columns.last) return;
    std::array<Crossing, 4> left, right;
    int lefts = 0, rights = 0;
    const double step = cells_.step(), v0 = cells_.row_offset(f), u0 = cells_.column_offset();
    for (int k = 0; k < polygon.corner_count; ++k) {
      const double a = planes[k][face.column_axis], b = planes[k][face.row_axis];
      const double c = face.outward_sign * planes[k][face.outward_axis];
      // Crossings of edges nearly along the rows overflow, and lie far beyond every column.
      constexpr double along_rows = 1e-200;
      if (std::abs(a) < along_rows) {
        const auto inside = [&](int row) {
          const double e = b * (v0 + step * row) + c;
          return e > 0.0 || (e == 0.0 && (b > 0.0 || b == 0.0));
        };
        while (rows.first < rows.last && !inside(rows.first)) ++rows.first;
        while (rows.first < rows.last && !inside(rows.last - 1)) --rows.last;
        continue;
      }
      const Crossing crossing{(-(b * v0 + c) / a - u0) / step, -b / a};
      (a > 0.0 ? left[lefts++] : right[rights++]) = crossing;
    }
    const int n = cells_.resolution();
    const double across = normal_over_distance[face.column_axis] * step;
    const double along = normal_over_distance[face.row_axis] * step;
    const double start = normal_over_distance[face.column_axis] * u0 +
                         normal_over_distance[face.row_axis] * v0 +
                         face.outward_sign * normal_over_distance[face.outward_axis];
    for (int row = rows.first; row < rows.last; ++row) {
      double from = columns.first, to = columns.last;
      for (int k = 0; k < lefts; ++k) from = std::max(from, left[k].start + left[k].slope * row);
      for (int k = 0; k < rights; ++k) to = std::min(to, right[k].start + right[k].slope * row);
      const int first = first_cell_from(from, n), last = first_cell_from(to, n);
      if (first >= last) continue;
      const int at = cells_.first_cell(f) + row * n + first;
      paint_span(scratch_.inverse_distance.data() + at, items_.data() + at, last - first,
                 static_cast<float>(start + along * row + across * first),
                 static_cast<float>(across), item);
    }
  }

  const HemicubeScan& scan_;
  const HemicubeEye& eye_;
  const HemicubeCells& cells_;
  Scratch& scratch_;
  std::span<int> items_;
};

HemicubeScan::HemicubeScan(const ElementCaster& caster) : caster_(caster) {
  const PatchMesh& mesh = caster.mesh();
  Eigen::AlignedBox3d box;
  for (int v = 0; v < mesh.vertex_count(); ++v) box.extend(mesh.position(v));
  // Planes that float coordinates of the scene cannot distinguish, as in RayCaster.
  constexpr double roundings = 16.0;
  if (!box.isEmpty()) {
    coplanar_ = roundings * 0.5 * box.diagonal().norm() * std::numeric_limits<float>::epsilon();
  }
  constexpr int group_size = 32;  // elements: few enough to be rejected together, enough to pay
  for (int p = 0; p < mesh.patch_count();) {
    const int first = mesh.first_element[p], facet = mesh.facet_of(p);
    if (mesh.is_back[p] != 0) {
      ++p;
      continue;
    }
    if (facet < 0) {
      add_runs_of_facets(first, mesh.first_element[++p]);
      continue;
    }
    do {
      ++p;
    } while (p < mesh.patch_count() && mesh.facet_of(p) == facet && mesh.is_back[p] == 0 &&
             mesh.first_element[p + 1] - first <= group_size);
    add_facet_elements(first, mesh.first_element[p]);
  }
}

void HemicubeScan::add_runs_of_facets(int first_element, int last_element) {
  const PatchMesh& mesh = caster_.mesh();
  for (int begin = first_element, end = begin; begin < last_element; begin = end) {
    while (end < last_element && mesh.facet[end] == mesh.facet[begin]) ++end;
    add_facet_elements(begin, end);
  }
}

void HemicubeScan::add_facet_elements(int first_element, int last_element) {
  const PatchMesh& mesh = caster_.mesh();
  Group group{.first_polygon = static_cast<int>(polygons_.size()),
              .first_vertex = static_cast<int>(vertices_.size()),
              .facet = mesh.facet[first_element]};
  std::vector<int> used;
  for (int e = first_element; e < last_element; ++e) {
    const int n = mesh.corner_count(e);
    used.insert(used.end(), mesh.corners[e].begin(), mesh.corners[e].begin() + n);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  Eigen::AlignedBox3d box;
  for (int v : used) {
    vertices_.push_back(mesh.position(v));
    box.extend(vertices_.back());
  }
  Vector3d whole = Vector3d::Zero();
  for (int e = first_element; e < last_element; ++e) {
    Polygon polygon{
        .corner_count = mesh.corner_count(e),
        .element = e,
        .behind = mesh.twin[e] >= 0 ? mesh.twin[e] : hemicube_item::black_back(group.facet),
        .front_hidden = caster_.is_hidden(e, false),
        .back_hidden = caster_.is_hidden(e, true)};
    for (int k = 0; k < 4; ++k) {
      const int corner = mesh.corners[e][std::min(k, polygon.corner_count - 1)];
      polygon.vertex[k] =
          group.first_vertex +
          static_cast<int>(std::lower_bound(used.begin(), used.end(), corner) - used.begin());
    }
    const auto& p = polygon.vertex;
    const Vector3d area =
        (vertices_[p[2]] - vertices_[p[0]]).cross(vertices_[p[3]] - vertices_[p[1]]);
    polygon.normal = area.normalized();
    whole += area;
    polygons_.push_back(polygon);
  }
  if (!round_grid_of(mesh, group.facet)) {  // the normal of a sliver is inaccurate
    const Vector3d normal = whole.normalized();
    for (auto p = group.first_polygon; p < static_cast<int>(polygons_.size()); ++p) {
      polygons_[p].normal = normal;
    }
  }
  group.last_polygon = static_cast<int>(polygons_.size());
  group.last_vertex = static_cast<int>(vertices_.size());
  group.center = box.center();
  group.radius = 0.5 * box.diagonal().norm();
  groups_.push_back(group);
}

void HemicubeScan::draw(const HemicubeEye& eye, const HemicubeCells& cells, Scratch& scratch,
                        std::span<int> items) const {
  scratch.vertex.resize(vertices_.size());
  scratch.outside.resize(vertices_.size());
  scratch.inverse_distance.assign(items.size(), 0.0f);
  std::fill(items.begin(), items.end(), hemicube_item::nothing);
  Painter painter(*this, eye, cells, scratch, items);
  for (const Group& group : groups_) painter.paint_group(group);
}

}  // namespace lightwell
