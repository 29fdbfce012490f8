#include "viewer/export/chart_texels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "mesh/patches/round_grid.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;

/// Largest distance, texels, from a point to the four texel centres that a bilinear filter reads.
constexpr double filter_reach = std::numbers::sqrt2;

/// Face in the plane of its atlas, in texels.
struct FlatFace {
  std::array<Vector2d, 4> corner{};
  int count = 0;

  /// Nearest point of the face, its border included, and the distance to that point.
  std::pair<Vector2d, double> nearest(const Vector2d& p) const;
  /// Weights of the corners at a point of the face: barycentric for a triangle, bilinear for a
  /// quad.
  Eigen::Array4d weights(const Vector2d& p) const;
};

double cross_2d(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::pair<Vector2d, double> FlatFace::nearest(const Vector2d& p) const {
  bool left_of_all = true, right_of_all = true;
  Vector2d best = corner[0];
  double least = std::numeric_limits<double>::infinity();
  for (int c = 0; c < count; ++c) {
    const Vector2d along = corner[(c + 1) % count] - corner[c], to = p - corner[c];
    const double turn = cross_2d(along, to);
    left_of_all = left_of_all && turn >= 0.0;
    right_of_all = right_of_all && turn <= 0.0;
    const double square = along.squaredNorm();
    const double t = square > 0.0 ? std::clamp(to.dot(along) / square, 0.0, 1.0) : 0.0;
    const double distance = (to - t * along).norm();
    if (!(distance < least)) continue;
    least = distance;
    best = corner[c] + t * along;
  }
  if (left_of_all != right_of_all) return {p, 0.0};
  return {best, least};
}

Eigen::Array4d FlatFace::weights(const Vector2d& p) const {
  const Vector2d x = corner[1] - corner[0], y = corner[count - 1] - corner[0], to = p - corner[0];
  const double area = cross_2d(x, y);
  if (count == 3) {
    // All points of a triangle without area get the first corner's value.
    if (!(std::abs(area) > 0.0)) return {1.0, 0.0, 0.0, 0.0};
    const double u = std::clamp(cross_2d(to, y) / area, 0.0, 1.0);
    const double v = std::clamp(cross_2d(x, to) / area, 0.0, 1.0 - u);
    return {1.0 - u - v, u, v, 0.0};
  }
  // (s, t) with p = corner[0] + s x + t y + s t z, by Newton's method from the middle; a convex
  // quadrilateral has one root in the unit square.
  const Vector2d z = corner[2] - corner[1] - corner[3] + corner[0];
  double s = 0.5, t = 0.5;
  constexpr int most_steps = 16;
  constexpr double converged = 1e-9;  // share of the face
  for (int step = 0; step < most_steps; ++step) {
    const Vector2d off = s * x + t * y + s * t * z - to;
    const Vector2d ds = x + t * z, dt = y + s * z;
    const double determinant = cross_2d(ds, dt);
    if (!(std::abs(determinant) > 0.0)) break;
    const double step_s = cross_2d(off, dt) / determinant, step_t = cross_2d(ds, off) / determinant;
    s = std::clamp(s - step_s, -0.5, 1.5);
    t = std::clamp(t - step_t, -0.5, 1.5);
    if (std::abs(step_s) + std::abs(step_t) < converged) break;
  }
  s = std::clamp(s, 0.0, 1.0);
  t = std::clamp(t, 0.0, 1.0);
  return {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
}

/// Corner of the mesh's element that is the first corner of the model's face.
int first_corner_of(const BakedModel& model, const PatchMesh& mesh, int f) {
  const auto& corners = mesh.corners[model.element[f]];
  const int vertex = model.mesh_vertex[model.faces[f][0]];
  return static_cast<int>(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
}

/// Weights of the corners of a sphere's inside element, from those of the outside element; the
/// inside's corners are in reverse order.
Eigen::Array4f turned_weights(const Eigen::Array4f& w, int count) {
  return count == 3 ? Eigen::Array4f(w[0], w[2], w[1], 0.0f)
                    : Eigen::Array4f(w[0], w[3], w[2], w[1]);
}

}  // namespace

ChartTexels::ChartTexels(const LightmapLayout& layout, int chart, const BakedModel& model,
                         const PatchMesh& mesh)
    : layout_(layout), chart_(chart), model_(model), mesh_(mesh) {}

std::vector<ChartTexels::Texel> ChartTexels::texels() const {
  return layout_.charts[chart_].sphere >= 0 ? sphere_texels() : flat_texels();
}

std::vector<ChartTexels::Texel> ChartTexels::flat_texels() const {
  const LightmapChart& chart = layout_.charts[chart_];
  const ChartRectangle& place = layout_.place[chart_];
  // A filter reads at most one texel around the rectangle.
  const int x0 = place.x - 1, y0 = place.y - 1;
  const int width = place.width + 2, height = place.height + 2;
  struct Nearest {
    int face = -1;
    float distance = static_cast<float>(filter_reach);
  };
  std::vector<Nearest> nearest(static_cast<std::size_t>(width) * height);
  std::vector<FlatFace> faces(chart.faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    FlatFace& face = faces[f];
    face.count = model_.corner_count(chart.faces[f]);
    Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (int c = 0; c < face.count; ++c) {
      face.corner[c] = layout_.texel(chart_, chart.place[chart.corners[f][c]]);
      low = low.cwiseMin(face.corner[c]);
      high = high.cwiseMax(face.corner[c]);
    }
    // First and last texel whose centre is within filter_reach of the face's bounds.
    const auto first = [](double from, int at) {
      return std::max(0, static_cast<int>(std::ceil(from - filter_reach - 0.5)) - at);
    };
    const auto last = [](double to, int at, int count) {
      return std::min(count - 1, static_cast<int>(std::floor(to + filter_reach - 0.5)) - at);
    };
    for (int y = first(low.y(), y0); y <= last(high.y(), y0, height); ++y) {
      for (int x = first(low.x(), x0); x <= last(high.x(), x0, width); ++x) {
        Nearest& so_far = nearest[static_cast<std::size_t>(y) * width + x];
        if (so_far.face >= 0 && so_far.distance == 0.0f) continue;
        const auto distance = static_cast<float>(face.nearest({x0 + x + 0.5, y0 + y + 0.5}).second);
        if (distance < so_far.distance) so_far = {static_cast<int>(f), distance};
      }
    }
  }
  std::vector<Texel> result;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Nearest& found = nearest[static_cast<std::size_t>(y) * width + x];
      if (found.face < 0) continue;
      const FlatFace& face = faces[found.face];
      const Vector2d center(x0 + x + 0.5, y0 + y + 0.5);
      const auto [at, distance] = face.nearest(center);
      Texel texel{
          .x = x0 + x, .y = y0 + y, .face = chart.faces[found.face], .is_inside = distance == 0.0};
      const Eigen::Array4d inside = face.weights(at);
      texel.inside = inside.cast<float>();
      texel.weights = texel.inside;
      // Linear extrapolation across the border, from the light at the mirrored point.
      if (const Vector2d mirrored = 2.0 * at - center; distance > 0.0) {
        const auto [within, short_of] = face.nearest(mirrored);
        const double share = (within - at).norm() / distance;
        if (short_of == 0.0 || share > 0.5) {
          texel.weights = (inside + (inside - face.weights(within)) / share).cast<float>();
        }
      }
      result.push_back(texel);
    }
  }
  return result;
}

// Texels beyond the seam continue on the other side of it; texels beyond a pole repeat the pole.
std::vector<ChartTexels::Texel> ChartTexels::sphere_texels() const {
  const LightmapChart& chart = layout_.charts[chart_];
  const ChartRectangle& place = layout_.place[chart_];
  const RoundGrid& grid = mesh_.round_grids[chart.sphere];
  std::map<int, int> face_of;  // keyed by the element of the outside
  const bool is_back = mesh_.is_back[mesh_.patch[model_.element[chart.faces.front()]]] != 0;
  for (const int f : chart.faces) {
    const int e = model_.element[f];
    face_of[is_back ? mesh_.twin[e] : e] = f;
  }
  std::vector<Texel> result;
  for (int y = -1; y <= place.height; ++y) {
    const double row = std::clamp((y + 0.5) / place.height, 0.0, 1.0) * grid.rings;
    for (int x = -1; x <= place.width; ++x) {
      const double turn = (x + 0.5) / place.width;
      const double column = (turn - std::floor(turn)) * grid.sectors;
      RoundGridPoint at;
      at.ring = std::clamp(static_cast<int>(row), 0, grid.rings - 1);
      at.sector = std::clamp(static_cast<int>(column), 0, grid.sectors - 1);
      at.u = std::clamp(column - at.sector, 0.0, 1.0);
      at.v = std::clamp(1.0 - (row - at.ring), 0.0, 1.0);
      const auto found = face_of.find(grid.element[at.ring * grid.sectors + at.sector]);
      if (found == face_of.end()) continue;
      const int f = found->second, count = model_.corner_count(f);
      Eigen::Array4f of_mesh = round_weights(grid, at);
      if (is_back) of_mesh = turned_weights(of_mesh, count);
      Texel texel{.x = place.x + x,
                  .y = place.y + y,
                  .face = f,
                  .is_inside = x >= 0 && x < place.width && y >= 0 && y < place.height};
      const int first = first_corner_of(model_, mesh_, f);
      for (int c = 0; c < count; ++c) texel.weights[c] = of_mesh[(first + c) % count];
      texel.inside = texel.weights;
      result.push_back(texel);
    }
  }
  return result;
}

}  // namespace lightwell
