#include "mesh/discontinuity/critical_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/geometry/cross.h"
#include "mesh/geometry/uncovered_length.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::critical_lines_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector2d;
using Eigen::Vector3d;

// A line on the receiver, in two of its coordinates.
struct PlaneLine {
  Vector2d a, b;
  LineDegree degree = LineDegree::d2;
  bool is_vertex_edge = true;
};

Scene scene_with_light(const Loop& light) {
  Scene scene = empty_scene();
  const int lamp = add_lamp(scene);
  add_polygon(scene, "light", light, {}, lamp);
  return scene;
}

// The lines that fall on `facet`, in coordinates x and y.
std::vector<PlaneLine> lines_on(const Scene& scene, int facet, int x, int y) {
  std::vector<PlaneLine> lines;
  for (const CriticalLine& line : critical_lines(scene).lines) {
    if (line.facet != facet) continue;
    const auto flat = [&](const Vector3d& p) { return Vector2d(p[x], p[y]); };
    lines.push_back({flat(line.ends[0]), flat(line.ends[1]), line.degree, line.is_vertex_edge});
  }
  return lines;
}

// The length of `line`, m, that the lines of its kind in `cover` leave uncovered.
double uncovered(const PlaneLine& line, const std::vector<PlaneLine>& cover, bool any_kind,
                 double tolerance) {
  const Vector2d d = line.b - line.a;
  const double length = d.norm();
  std::vector<std::pair<double, double>> parts;
  for (const PlaneLine& c : cover) {
    if (!any_kind && (c.degree != line.degree || c.is_vertex_edge != line.is_vertex_edge)) continue;
    if (std::abs(cross(d, c.a - line.a)) > tolerance * length) continue;
    if (std::abs(cross(d, c.b - line.a)) > tolerance * length) continue;
    const double s = d.dot(c.a - line.a) / length, t = d.dot(c.b - line.a) / length;
    parts.emplace_back(std::min(s, t), std::max(s, t));
  }
  return uncovered_length(length, std::move(parts));
}

// Expects that both lists hold the same lines, however divided into pieces.
void expect_same_lines(const std::vector<PlaneLine>& found, const std::vector<PlaneLine>& truth,
                       double size) {
  // Rounding: planes of wedges are known to some 1e-15, and lines have lengths of about `size`.
  const double tolerance = 1e-9 * size;
  for (const PlaneLine& line : truth) {
    EXPECT_LE(uncovered(line, found, false, tolerance), tolerance)
        << "missing " << line.a.transpose() << " to " << line.b.transpose();
  }
  for (const PlaneLine& line : found) {
    EXPECT_LE(uncovered(line, truth, false, tolerance), tolerance)
        << "extra " << line.a.transpose() << " to " << line.b.transpose();
  }
}

void expect_polygon_is_drawn(const std::vector<PlaneLine>& lines,
                             const std::vector<Vector2d>& polygon, double size) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PlaneLine edge{polygon[i], polygon[(i + 1) % polygon.size()]};
    EXPECT_LE(uncovered(edge, lines, true, 1e-9 * size), 1e-9 * size) << "edge " << i;
  }
}

bool is_strictly_inside(const std::vector<Vector2d>& convex, const Vector2d& q, double margin) {
  for (std::size_t i = 0; i < convex.size(); ++i) {
    const Vector2d d = (convex[(i + 1) % convex.size()] - convex[i]).normalized();
    if (!(cross(d, q - convex[i]) > margin)) return false;
  }
  return true;
}

// An emitter's corner e at z = 2 casts the shadow b -> 2 b - e of a blocker at z = 1 onto z = 0.
// Every edge of the blocker gives a VE line for each corner of the emitter, every corner an EV line
// for each edge of the emitter.
std::vector<PlaneLine> shadow_lines(const std::vector<Vector2d>& emitter,
                                    const std::vector<Vector2d>& blocker) {
  const auto is_parallel = [](const Vector2d& a, const Vector2d& b) {
    return std::abs(cross(a, b)) < 1e-12;
  };
  const int n = static_cast<int>(emitter.size()), m = static_cast<int>(blocker.size());
  const auto edge = [](const std::vector<Vector2d>& loop, int i) {
    const int count = static_cast<int>(loop.size());
    return Vector2d(loop[(i + 1) % count] - loop[(i + count) % count]);
  };
  std::vector<PlaneLine> lines;
  for (int e = 0; e < n; ++e) {
    for (int b = 0; b < m; ++b) {
      const Vector2d &v = emitter[e], &w = emitter[(e + 1) % n];
      const Vector2d &p = blocker[b], &q = blocker[(b + 1) % m];
      const bool ve =
          is_parallel(edge(emitter, e), q - p) || is_parallel(edge(emitter, e - 1), q - p);
      const bool ev =
          is_parallel(w - v, edge(blocker, b)) || is_parallel(w - v, edge(blocker, b - 1));
      lines.push_back({2 * p - v, 2 * q - v, ve ? LineDegree::d1 : LineDegree::d2, true});
      lines.push_back({2 * p - v, 2 * p - w, ev ? LineDegree::d1 : LineDegree::d2, false});
    }
  }
  return lines;
}

// An emitter facing down at z = 2, a blocker at z = 1 and a floor at z = 0: facets 0, 1, 2.
Scene shadow_scene(const std::vector<Vector2d>& emitter, const std::vector<Vector2d>& blocker,
                   double scale = 1.0) {
  Loop light, sheet;
  for (const Vector2d& p : emitter) light.insert(light.begin(), scale * Vector3d(p.x(), p.y(), 2));
  for (const Vector2d& p : blocker) sheet.push_back(scale * Vector3d(p.x(), p.y(), 1));
  Scene scene = scene_with_light(light);
  add_polygon(scene, "blocker", sheet);
  add_polygon(scene, "floor",
              {scale * Vector3d(-2, -2, 0), scale * Vector3d(2, -2, 0), scale * Vector3d(2, 2, 0),
               scale * Vector3d(-2, 2, 0)});
  return scene;
}

const std::vector<Vector2d> triangle{{-0.4, -0.3}, {0.5, -0.2}, {0.05, 0.5}};
const std::vector<Vector2d> square{{-0.3, -0.3}, {0.3, -0.3}, {0.3, 0.3}, {-0.3, 0.3}};

TEST(CriticalLines, TriangleOverSquareCastsEveryVertexEdgeLine) {
  const auto lines = lines_on(shadow_scene(triangle, square), 2, 0, 1);
  expect_same_lines(lines, shadow_lines(triangle, square), 1.0);
}

TEST(CriticalLines, TriangleOverSquareBoundsUmbraAndPenumbra) {
  const auto lines = lines_on(shadow_scene(triangle, square), 2, 0, 1);
  // The penumbra is the convex hull of the shadows of all corners, the umbra the intersection of
  // these shadows.
  const std::vector<Vector2d> penumbra{{-1.1, -0.4}, {-0.65, -1.1}, {0.55, -1.1}, {1.0, -0.3},
                                       {1.0, 0.9},   {-0.2, 0.9},   {-1.1, 0.8}};
  const std::vector<Vector2d> umbra{{-0.2, -0.3}, {0.1, -0.3}, {0.1, 0.1}, {-0.2, 0.1}};
  expect_polygon_is_drawn(lines, penumbra, 1.0);
  expect_polygon_is_drawn(lines, umbra, 1.0);
  for (const PlaneLine& line : lines) {
    for (double t = 0.05; t < 1.0; t += 0.1) {
      const Vector2d q = line.a + t * (line.b - line.a);
      EXPECT_TRUE(is_strictly_inside(penumbra, q, -1e-9));
      EXPECT_FALSE(is_strictly_inside(umbra, q, 1e-9));
    }
  }
}

TEST(CriticalLines, ParallelEdgesMakeLinesOfFirstDegree) {
  const std::vector<Vector2d> unit{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  std::vector<Vector2d> half = unit;
  for (Vector2d& p : half) p *= 0.5;
  const auto lines = lines_on(shadow_scene(unit, half), 2, 0, 1);
  for (const PlaneLine& line : lines) EXPECT_EQ(line.degree, LineDegree::d1);
  expect_same_lines(lines, shadow_lines(unit, half), 1.0);
}

TEST(CriticalLines, AreTheSameInEveryUnit) {
  const auto lines = lines_on(shadow_scene(triangle, square), 2, 0, 1);
  for (const double scale : {1e-3, 1e3}) {
    auto scaled = lines_on(shadow_scene(triangle, square, scale), 2, 0, 1);
    ASSERT_EQ(scaled.size(), lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      EXPECT_LT((scaled[i].a / scale - lines[i].a).norm(), 1e-12);
      EXPECT_LT((scaled[i].b / scale - lines[i].b).norm(), 1e-12);
    }
  }
}

// The tall block of the Cornell box, alone on a large floor (mm): (x, z) of its critical lines. The
// shadow of a top corner t from a light corner v is k t - (k - 1) v with k = 548.8 / (548.8 - 330).
// Two more edges touch the floor but lie in the umbra, where nothing changes.
const std::vector<PlaneLine> tall_block_lines{
    {{314.0, 456.0}, {265.0, 296.0}, LineDegree::d0, true},
    {{265.0, 296.0}, {423.0, 247.0}, LineDegree::d0, true},
    {{147.35831809872025, 400.0676416819013}, {265.0, 296.0}, LineDegree::d2, true},
    {{423.0, 247.0}, {543.6581352833639, 277.164533820841}, LineDegree::d2, true},
    {{543.6581352833639, 277.164533820841},
     {666.5612431444242, 675.9725776965265},
     LineDegree::d2,
     true},
    {{666.5612431444242, 675.9725776965265},
     {270.2614259597806, 801.3839122486288},
     LineDegree::d2,
     true},
    {{270.2614259597806, 801.3839122486288},
     {147.35831809872025, 400.0676416819013},
     LineDegree::d2,
     true},
    {{147.35831809872025, 241.70383912248633},
     {543.6581352833639, 118.800731261426},
     LineDegree::d2,
     true},
    {{543.6581352833639, 118.800731261426},
     {666.5612431444242, 517.6087751371115},
     LineDegree::d2,
     true},
    {{666.5612431444242, 517.6087751371115},
     {270.2614259597806, 643.0201096892139},
     LineDegree::d2,
     true},
    {{270.2614259597806, 643.0201096892139},
     {147.35831809872025, 241.70383912248633},
     LineDegree::d2,
     true},
    {{265.0, 296.0}, {343.4277879341864, 241.70383912248633}, LineDegree::d2, true},
    {{343.4277879341864, 241.70383912248633},
     {739.7276051188301, 118.800731261426},
     LineDegree::d2,
     true},
    {{739.7276051188301, 118.800731261426},
     {862.6307129798904, 517.6087751371115},
     LineDegree::d2,
     true},
    {{862.6307129798904, 517.6087751371115},
     {466.33089579524676, 643.0201096892139},
     LineDegree::d2,
     true},
    {{466.33089579524676, 643.0201096892139}, {314.0, 456.0}, LineDegree::d2, true},
    {{423.0, 247.0}, {739.7276051188301, 277.164533820841}, LineDegree::d2, true},
    {{739.7276051188301, 277.164533820841},
     {862.6307129798904, 675.9725776965265},
     LineDegree::d2,
     true},
    {{862.6307129798904, 675.9725776965265},
     {466.33089579524676, 801.3839122486288},
     LineDegree::d2,
     true},
    {{466.33089579524676, 801.3839122486288}, {314.0, 456.0}, LineDegree::d2, true},
    {{543.6581352833639, 277.164533820841},
     {543.6581352833639, 118.800731261426},
     LineDegree::d2,
     false},
    {{543.6581352833639, 118.800731261426},
     {739.7276051188301, 118.800731261426},
     LineDegree::d2,
     false},
    {{739.7276051188301, 118.800731261426},
     {739.7276051188301, 277.164533820841},
     LineDegree::d2,
     false},
    {{739.7276051188301, 277.164533820841},
     {543.6581352833639, 277.164533820841},
     LineDegree::d2,
     false},
    {{666.5612431444242, 675.9725776965265},
     {666.5612431444242, 517.6087751371115},
     LineDegree::d2,
     false},
    {{666.5612431444242, 517.6087751371115},
     {862.6307129798904, 517.6087751371115},
     LineDegree::d2,
     false},
    {{862.6307129798904, 517.6087751371115},
     {862.6307129798904, 675.9725776965265},
     LineDegree::d2,
     false},
    {{862.6307129798904, 675.9725776965265},
     {666.5612431444242, 675.9725776965265},
     LineDegree::d2,
     false},
    {{270.2614259597806, 801.3839122486288},
     {270.2614259597806, 643.0201096892139},
     LineDegree::d2,
     false},
    {{270.2614259597806, 643.0201096892139},
     {466.33089579524676, 643.0201096892139},
     LineDegree::d2,
     false},
    {{466.33089579524676, 643.0201096892139},
     {466.33089579524676, 801.3839122486288},
     LineDegree::d2,
     false},
    {{466.33089579524676, 801.3839122486288},
     {270.2614259597806, 801.3839122486288},
     LineDegree::d2,
     false},
    {{147.35831809872025, 400.0676416819013},
     {147.35831809872025, 241.70383912248633},
     LineDegree::d2,
     false},
    {{147.35831809872025, 241.70383912248633},
     {343.4277879341864, 241.70383912248633},
     LineDegree::d2,
     false},
};

Scene tall_block() {
  Scene scene = scene_with_light(
      {{343.0, 548.8, 227.0}, {343.0, 548.8, 332.0}, {213.0, 548.8, 332.0}, {213.0, 548.8, 227.0}});
  const std::vector<Vector2d> base{{423, 247}, {472, 406}, {314, 456}, {265, 296}};
  const auto at = [&](int i, double y) { return Vector3d(base[i % 4].x(), y, base[i % 4].y()); };
  add_polygon(scene, "floor",
              {{-2000, 0, -2000}, {-2000, 0, 3000}, {3000, 0, 3000}, {3000, 0, -2000}});
  add_polygon(scene, "top", {at(0, 330), at(1, 330), at(2, 330), at(3, 330)});
  for (int i = 0; i < 4; ++i) {
    add_polygon(scene, "side", {at(i, 0), at(i, 330), at(i + 1, 330), at(i + 1, 0)});
  }
  return scene;
}

TEST(CriticalLines, BlockOnTheFloorCastsThoseOfItsSilhouettes) {
  const auto found = lines_on(tall_block(), 1, 0, 2);
  std::vector<PlaneLine> truth = tall_block_lines;
  // The top corner (265, 296) leaves the silhouette where the light's edge passes in front of both
  // of its sides: x = 213 meets the plane of the side to (423, 247), z = 227 that of the side to
  // (314, 456).
  const Vector2d t(265, 296);
  const double z = 296.0 - 52.0 * 49.0 / -158.0, x = 265.0 - 69.0 * 49.0 / 160.0;
  const double k = 548.8 / (548.8 - 330.0);
  const auto shadow = [&](const Vector2d& v) { return Vector2d(k * t - (k - 1) * v); };
  truth.push_back({shadow({213, 332}), shadow({213, z}), LineDegree::d2, false});
  truth.push_back({shadow({x, 227}), shadow({343, 227}), LineDegree::d2, false});
  expect_same_lines(found, truth, 1000.0);
}

TEST(CriticalLines, BlockOnTheFloorBoundsUmbraAndPenumbra) {
  const auto lines = lines_on(tall_block(), 1, 0, 2);
  expect_polygon_is_drawn(lines,
                          {{147.35831809872025, 241.70383912248633},
                           {543.6581352833639, 118.800731261426},
                           {739.7276051188301, 118.800731261426},
                           {862.6307129798904, 517.6087751371115},
                           {862.6307129798904, 675.9725776965265},
                           {466.33089579524676, 801.3839122486288},
                           {270.2614259597806, 801.3839122486288},
                           {147.35831809872025, 400.0676416819013}},
                          1000.0);
  expect_polygon_is_drawn(lines,
                          {{265.0, 296.0},
                           {423.0, 247.0},
                           {543.6581352833639, 277.164533820841},
                           {622.0939372030709, 531.6807073970333},
                           {426.14946479658164, 593.6884518294667},
                           {314.00000000000006, 456.0000000000002}},
                          1000.0);
}

// Random boxes, with visibility by brute force: the line of sight is tested against every polygon.
struct BoxScene {
  explicit BoxScene(std::uint32_t seed)
      : scene(boxes_under_a_lamp(seed)),
        points(1e-7),
        planes(facet_planes(scene, points)),
        lines(critical_lines(scene, planes).lines) {}

  bool sees(const Vector3d& from, const Vector3d& to) const {
    for (const FacetPlane& plane : planes) {
      if (plane.facet == 1) continue;  // the lamp
      const double h = plane.height(from), k = plane.height(to);
      constexpr double on_plane = 1e-9;
      if (std::abs(h) < on_plane || std::abs(k) < on_plane || h * k > 0.0) continue;
      if (plane.contains(plane.project(from + h / (h - k) * (to - from)), 0.0)) return false;
    }
    return true;
  }
  // True if p lies on the silhouette as seen from x: around the direction to p some of the lamp's
  // plane is hidden and some is not.
  bool is_outlined(const Vector3d& x, const Vector3d& p) const {
    const Vector3d d = (p - x).normalized(), u = d.unitOrthogonal(), w = d.cross(u);
    bool hidden = false, seen = false;
    constexpr int directions = 32;
    for (int k = 0; k < directions; ++k) {
      const double angle = (k + 0.37) * 2.0 * std::numbers::pi / directions;
      const Vector3d towards = p + 1e-6 * (std::cos(angle) * u + std::sin(angle) * w) - x;
      const double t = -planes[1].height(x) / planes[1].normal.dot(towards);
      (sees(x + t * towards, x) ? seen : hidden) = true;
    }
    return hidden && seen;
  }

  Scene scene;
  WeldedPoints points;
  std::vector<FacetPlane> planes;
  std::vector<CriticalLine> lines;
};

TEST(CriticalLines, AcrossEachOfAVertexACornerOfTheLampAppears) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    const BoxScene s(seed);
    for (const CriticalLine& line : s.lines) {
      if (!line.is_vertex_edge || line.degree == LineDegree::d0) continue;
      const FacetPlane& plane = s.planes[line.plane];
      const Vector3d along = line.ends[1] - line.ends[0];
      const Vector3d middle = line.ends[0] + 0.37 * along;
      const Vector3d aside = 1e-6 * plane.normal.cross(along).normalized();
      bool changes = false;
      for (const Vector3d& corner : s.planes[1].corner) {
        changes |= s.sees(corner, middle + aside) != s.sees(corner, middle - aside);
      }
      EXPECT_TRUE(changes) << "seed " << seed << " at " << middle.transpose();
    }
  }
}

TEST(CriticalLines, CornersOfTheLampAppearNowhereElse) {
  int changes = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    const BoxScene s(seed);
    const FacetPlane& floor = s.planes[0];
    Eigen::AlignedBox2d box;
    for (const Vector2d& q : floor.xy) box.extend(q);
    Numbers numbers(seed + 1000);
    for (int k = 0; k < 200; ++k) {
      const Vector2d a(numbers.between(box.min().x(), box.max().x()),
                       numbers.between(box.min().y(), box.max().y()));
      const double angle = numbers.between(0.0, 2.0 * std::numbers::pi);
      const Vector2d b = a + 0.02 * Vector2d(std::cos(angle), std::sin(angle));
      if (!floor.contains(a, 0.0) || !floor.contains(b, 0.0)) continue;
      for (const Vector3d& corner : s.planes[1].corner) {
        if (s.sees(corner, floor.lift(a)) == s.sees(corner, floor.lift(b))) continue;
        ++changes;
        EXPECT_TRUE(std::any_of(s.lines.begin(), s.lines.end(),
                                [&](const CriticalLine& line) {
                                  const Vector2d p = floor.project(line.ends[0]),
                                                 q = floor.project(line.ends[1]);
                                  return line.plane == 0 && line.is_vertex_edge &&
                                         cross(b - a, p - a) * cross(b - a, q - a) <= 0.0 &&
                                         cross(q - p, a - p) * cross(q - p, b - p) <= 0.0;
                                }))
            << "seed " << seed << " at " << floor.lift(a).transpose();
      }
    }
  }
  EXPECT_GT(changes, 500);
}

TEST(CriticalLines, ShadowsOfCornersOnTheLampsEdgesAreLinesOfAnEdge) {
  int found = 0;
  for (std::uint32_t seed = 1; seed < 120; seed += 2) {
    const BoxScene s(seed);
    const FacetPlane &floor = s.planes[0], &lamp = s.planes[1];
    Numbers numbers(seed + 2000);
    for (int point = 0; point < s.points.size(); ++point) {
      const Vector3d p = s.points[point];
      if (!(lamp.height(p) > 1e-6)) continue;
      for (int k = 0; k < 10; ++k) {
        const int e = numbers.below(4);
        const Vector3d a = lamp.corner[e], b = lamp.corner[(e + 1) % 4];
        const Vector3d from = a + numbers.between(0.0, 1.0) * (b - a);
        const double t = -floor.height(from) / floor.normal.dot(p - from);
        const Vector3d x = from + t * (p - from);
        const Vector2d q = floor.project(x);
        if (!(t > 1.0 + 1e-6) || !floor.contains(q, 0.0) || !s.is_outlined(x, p)) continue;
        ++found;
        EXPECT_TRUE(std::any_of(s.lines.begin(), s.lines.end(),
                                [&](const CriticalLine& line) {
                                  return line.plane == 0 && !line.is_vertex_edge &&
                                         segment_distance(q, floor.project(line.ends[0]),
                                                          floor.project(line.ends[1])) < 1e-9;
                                }))
            << "seed " << seed << " at " << x.transpose();
      }
    }
  }
  EXPECT_GT(found, 1000);
}

}  // namespace
}  // namespace lightwell::critical_lines_test
