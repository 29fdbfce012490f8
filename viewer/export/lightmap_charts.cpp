#include "viewer/export/lightmap_charts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/round_grid.h"
#include "scene/sampling.h"
#include "viewer/export/chart_neighbours.h"
#include "viewer/export/chart_plane.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Connected groups of `faces` (ascending). Normals of a group are within 25 degrees of the normal
/// of its first face. Faces in a group ascend, and groups ascend by their first face.
std::vector<std::vector<int>> connected_groups(const BakedModel& model, const ChartNeighbours& near,
                                               std::span<const int> faces) {
  constexpr char elsewhere = 2;
  const int first = faces.front();
  std::vector<char> is_taken(static_cast<std::size_t>(faces.back() - first + 1), elsewhere);
  for (const int f : faces) is_taken[f - first] = 0;
  std::vector<std::vector<int>> groups;
  for (const int seed : faces) {
    if (std::exchange(is_taken[seed - first], 1) != 0) continue;
    std::vector<int> group = {seed};
    const Vector3d normal = face_vector(model, seed).normalized();
    for (std::size_t next = 0; next < group.size(); ++next) {
      near.around(group[next], [&](int f) {
        if (f < first || f > faces.back() || is_taken[f - first] != 0) return;
        if (face_vector(model, f).normalized().dot(normal) < most_turned) return;
        is_taken[f - first] = 1;
        group.push_back(f);
      });
    }
    std::sort(group.begin(), group.end());
    groups.push_back(std::move(group));
  }
  return groups;
}

void lay_flat(const BakedModel& model, LightmapChart& chart) {
  chart.place.clear();
  for (const int v : chart.vertices) {
    const Vector3d p = model.position[v] - chart.origin;
    chart.place.emplace_back(p.dot(chart.x_axis), p.dot(chart.y_axis));
  }
}

/// Chart of faces, projected on their mean plane.
LightmapChart project(const BakedModel& model, std::vector<int> faces) {
  LightmapChart chart;
  Vector3d normal = Vector3d::Zero(), a, b;
  std::map<int, int> number;
  for (const int f : faces) {
    normal += face_vector(model, f);
    std::array<int, 4> corners{-1, -1, -1, -1};
    for (int c = 0; c < model.corner_count(f); ++c) {
      const int v = model.faces[f][c];
      const auto [at, is_new] = number.try_emplace(v, static_cast<int>(chart.vertices.size()));
      if (is_new) chart.vertices.push_back(v);
      corners[c] = at->second;
    }
    chart.corners.push_back(corners);
  }
  chart.faces = std::move(faces);
  tangent_frame(normal.normalized(), a, b);
  chart.origin = model.position[chart.vertices.front()];
  chart.x_axis = a;
  chart.y_axis = b;
  lay_flat(model, chart);
  return chart;
}

/// Turns a chart so that its smallest bounding rectangle lies along the axes, the longer side along
/// x, and moves the rectangle's corner to the origin.
void straighten_chart(const BakedModel& model, LightmapChart& chart) {
  const Vector2d x = box_direction(chart.place);
  const Vector3d a = chart.x_axis, b = chart.y_axis;
  chart.x_axis = x.x() * a + x.y() * b;
  chart.y_axis = -x.y() * a + x.x() * b;
  lay_flat(model, chart);
  Vector2d low = chart.place.front(), high = low;
  for (const Vector2d& p : chart.place) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  chart.origin += low.x() * chart.x_axis + low.y() * chart.y_axis;
  for (Vector2d& p : chart.place) p -= low;
  chart.size = high - low;
}

/// Corners of a chart's faces, with one vertex in place of several that are joined in creases.
std::vector<std::array<int, 4>> joined_chart_corners(const LightmapChart& chart,
                                                     const ChartNeighbours& near) {
  std::map<int, int> first;  // by representative, the chart's first vertex
  std::vector<int> number;
  for (std::size_t v = 0; v < chart.vertices.size(); ++v) {
    number.push_back(
        first.try_emplace(near.joined(chart.vertices[v]), static_cast<int>(v)).first->second);
  }
  std::vector<std::array<int, 4>> corners = chart.corners;
  for (auto& face : corners) {
    for (int& c : face) {
      if (c >= 0) c = number[c];
    }
  }
  return corners;
}

/// Appends charts of connected faces. Faces are cut along the first line between borders that are
/// too near to each other (see narrow_gaps), until there is none.
void cut_and_add(const BakedModel& model, const ChartNeighbours& near, std::vector<int> faces,
                 double gap, std::vector<LightmapChart>& charts) {
  std::vector<std::vector<int>> waiting = {std::move(faces)};
  while (!waiting.empty()) {
    LightmapChart chart = project(model, std::move(waiting.back()));
    waiting.pop_back();
    const std::vector<CutLine> lines =
        narrow_gaps(joined_chart_corners(chart, near), chart.place, gap);
    if (lines.empty()) {
      straighten_chart(model, chart);
      charts.push_back(std::move(chart));
      continue;
    }
    std::array<std::vector<int>, 2> sides;
    for (std::size_t f = 0; f < chart.faces.size(); ++f) {
      const int count = model.corner_count(chart.faces[f]);
      Vector2d center = Vector2d::Zero();
      for (int c = 0; c < count; ++c) center += chart.place[chart.corners[f][c]] / count;
      const bool is_beyond = (center - lines.front().point).dot(lines.front().normal) > 0.0;
      sides[is_beyond ? 1 : 0].push_back(chart.faces[f]);
    }
    for (const auto& side : sides) {  // neither is empty: see narrow_gaps
      for (auto& group : connected_groups(model, near, side)) waiting.push_back(std::move(group));
    }
  }
}

/// Chart of a sphere by longitude and latitude, in which light is interpolated between vertices. A
/// pole has a vertex for each sector.
LightmapChart unroll(const BakedModel& model, const PatchMesh& mesh, int sphere,
                     std::vector<int> faces) {
  const RoundGrid& grid = mesh.round_grids[sphere];
  std::map<int, int> cell_of;
  for (std::size_t i = 0; i < grid.element.size(); ++i) {
    cell_of[grid.element[i]] = static_cast<int>(i);
  }
  const auto& [center, r] = std::get<Sphere>(grid.shape);
  LightmapChart chart;
  chart.sphere = sphere;
  chart.size = {2.0 * std::numbers::pi * r, std::numbers::pi * r};
  std::map<std::pair<int, int>, int> number;  // key: vertex, column in half sectors
  for (const int f : faces) {
    const int e = model.element[f];
    const auto found = cell_of.find(e);
    const int cell = found != cell_of.end() ? found->second : cell_of.at(mesh.twin[e]);
    const int ring = cell / grid.sectors, sector = cell % grid.sectors;
    std::array<int, 4> corners{-1, -1, -1, -1};
    for (int c = 0; c < model.corner_count(f); ++c) {
      const int v = model.faces[f][c];
      const Vector3d towards = (model.position[v] - center).normalized();
      const double across = std::hypot(towards.x(), towards.y());
      const bool is_pole = !(across > 0.25 * std::numbers::pi / grid.rings);
      // Longitude from the middle of this cell, in sectors, the shorter way around.
      const double phi = std::atan2(towards.y(), towards.x()) / (2.0 * std::numbers::pi);
      const double turned = phi * grid.sectors - (sector + 0.5);
      const double wrapped = turned - grid.sectors * std::round(turned / grid.sectors);
      const int column = 2 * sector + (is_pole ? 1 : wrapped > 0.0 ? 2 : 0);
      const double latitude = std::atan2(across, towards.z()) / std::numbers::pi * grid.rings;
      const int row = latitude < ring + 0.5 ? ring : ring + 1;
      const auto [at, is_new] =
          number.try_emplace({v, column}, static_cast<int>(chart.vertices.size()));
      if (is_new) {
        chart.vertices.push_back(v);
        chart.place.emplace_back(0.5 * column / grid.sectors * chart.size.x(),
                                 (1.0 - static_cast<double>(row) / grid.rings) * chart.size.y());
      }
      corners[c] = at->second;
    }
    chart.corners.push_back(corners);
  }
  chart.faces = std::move(faces);
  return chart;
}

bool is_dark(const BakedModel& model, const LightmapChart& chart) {
  return std::ranges::none_of(chart.vertices, [&](int v) {
    return (model.irradiance.row(v) > 0.0f).any() || (model.radiosity.row(v) > 0.0f).any();
  });
}

int sphere_of(const PatchMesh& mesh, int element) {
  const RoundGrid* grid = round_grid_of(mesh, mesh.facet[element]);
  const bool is_sphere = grid && std::holds_alternative<Sphere>(grid->shape);
  return is_sphere ? static_cast<int>(grid - mesh.round_grids.data()) : -1;
}

/// True if other surfaces cover all faces of a chart.
bool is_covered(const BakedModel& model, const ElementCaster& caster, const LightmapChart& chart) {
  const PatchMesh& mesh = caster.mesh();
  return std::ranges::all_of(chart.faces, [&](int f) {
    const int e = model.element[f];
    const bool is_back = mesh.is_back[mesh.patch[e]] != 0;
    return caster.is_hidden(is_back ? mesh.twin[e] : e, is_back);
  });
}

/// Lays covered dark charts into the gaps of the lit chart on the same side of the same facet.
void lay_into_hosts(const BakedModel& model, const PatchMesh& mesh,
                    std::vector<LightmapChart>& charts) {
  std::map<std::pair<int, bool>, int> lit;  // first lit chart of each facet and side
  std::vector<int> covered;
  const ElementCaster caster(mesh);
  const auto key = [&](const LightmapChart& chart) {
    const int e = model.element[chart.faces.front()];
    return std::pair(mesh.facet[e], mesh.is_back[mesh.patch[e]] != 0);
  };
  for (std::size_t c = 0; c < charts.size(); ++c) {
    if (charts[c].sphere >= 0) continue;
    if (!charts[c].is_dark) {
      lit.try_emplace(key(charts[c]), static_cast<int>(c));
    } else if (is_covered(model, caster, charts[c])) {
      covered.push_back(static_cast<int>(c));
    }
  }
  for (const int c : covered) {
    const auto host = lit.find(key(charts[c]));
    if (host == lit.end()) continue;
    const LightmapChart& around = charts[host->second];
    LightmapChart laid = charts[c];
    laid.host = host->second;
    laid.origin = around.origin;
    laid.x_axis = around.x_axis;
    laid.y_axis = around.y_axis;
    laid.size = around.size;
    lay_flat(model, laid);
    // A covered chart that exceeds the host's rectangle would lie on other charts.
    const double hair = 1e-6 * around.size.norm();
    const bool is_within = std::ranges::all_of(laid.place, [&](const Vector2d& p) {
      return (p.array() >= -hair).all() && (p.array() <= around.size.array() + hair).all();
    });
    if (is_within) charts[c] = std::move(laid);
  }
}

}  // namespace

std::vector<LightmapChart> cut_charts(const BakedModel& model, const PatchMesh& mesh, double gap) {
  std::vector<LightmapChart> charts;
  for (const BakedPart& part : model.parts) {
    std::map<int, std::vector<int>> by_sphere;
    for (int f = part.first_face; f < part.first_face + part.face_count; ++f) {
      by_sphere[sphere_of(mesh, model.element[f])].push_back(f);
    }
    for (auto& [sphere, faces] : by_sphere) {
      if (sphere >= 0) {
        charts.push_back(unroll(model, mesh, sphere, std::move(faces)));
        continue;
      }
      const ChartNeighbours near(model, part);
      for (auto& group : connected_groups(model, near, faces)) {
        cut_and_add(model, near, std::move(group), gap, charts);
      }
    }
  }
  bool any_dark = false;
  for (LightmapChart& chart : charts) any_dark |= chart.is_dark = is_dark(model, chart);
  if (any_dark) lay_into_hosts(model, mesh, charts);
  return charts;
}

}  // namespace lightwell
