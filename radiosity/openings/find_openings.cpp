#include "radiosity/openings/find_openings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <variant>

#include "radiosity/journal/journal_phase.h"
#include "radiosity/openings/nearest_surface.h"
#include "scene/parallel.h"
#include "scene/sampling.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Shares of scenery_length(). The light through a seam is half of the share by which parts are
// judged at least (PartMeans).
constexpr double widest_opening = 0.1, narrowest_opening = seam_share, shortest_edge = 0.002;
constexpr std::size_t most_edges = 4096, most_openings = 4096;
constexpr int directions = 16;  // of balls about an edge
// Least cosine between the direction of a ball and that of the chord between the two points that
// the ball touches: half of the angle between two directions has 0.98, and an edge of a door that
// stands open leans away from the frame.
constexpr double least_cosine = 0.9;
// Greatest component of a chord along its edge, as a share of its length.
constexpr double most_along = 0.3;
// Rectangles are larger than the measured opening, so that no light passes beside them.
constexpr double margin_along = 1.02, margin_across = 1.1;

struct Edge {
  Vector3d from, to;
  double length() const { return (to - from).norm(); }
};

auto rank(const Edge& edge) {
  const auto key = [](const Vector3d& p) { return std::tuple(p.x(), p.y(), p.z()); };
  return std::tuple(-edge.length(), key(edge.from), key(edge.to));
}

// The longest edges of all polygons that stand in the way of light, each once, longest first.
std::vector<Edge> long_edges(const Scene& scene, double least) {
  std::vector<Edge> edges;
  for (const Surface& surface : scene.surfaces) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    if (!mesh || material.dielectric || surface.motion >= 0) continue;
    const auto add = [&](const std::vector<int>& loop) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        Edge edge{mesh->vertices[static_cast<std::size_t>(loop[i])],
                  mesh->vertices[static_cast<std::size_t>(loop[(i + 1) % loop.size()])]};
        const auto key = [](const Vector3d& p) { return std::tuple(p.x(), p.y(), p.z()); };
        if (key(edge.to) < key(edge.from)) std::swap(edge.from, edge.to);
        if (edge.length() > least) edges.push_back(edge);
      }
    };
    for (const Facet& facet : mesh->facets) {
      add(facet.boundary);
      for (const auto& hole : facet.holes) add(hole);
    }
  }
  const auto before = [](const Edge& a, const Edge& b) { return rank(a) < rank(b); };
  std::sort(edges.begin(), edges.end(), before);
  const auto same = [](const Edge& a, const Edge& b) { return rank(a) == rank(b); };
  edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());
  edges.resize(std::min(edges.size(), most_edges));
  return edges;
}

class OpeningSearch {
 public:
  explicit OpeningSearch(const Scene& scene) : surfaces_(scene), diagonal_(scenery_length(scene)) {}

  void search(const Edge& edge, std::vector<Opening>& found) const {
    // Most edges are concave or far from all others, which three points tell.
    bool is_beside_opening = false;
    for (const double s : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
      is_beside_opening = is_beside_opening || !chords(edge, s).empty();
    }
    if (!is_beside_opening) return;
    const int pieces = edge.length() > 0.02 * diagonal_ ? 8 : 2;
    for (int i = 0; i < pieces; ++i) add_piece(edge, i, pieces, found);
  }

 private:
  // The widest of the narrowest chords in the piece.
  void add_piece(const Edge& edge, int i, int pieces, std::vector<Opening>& found) const {
    const Vector3d half = 0.5 / pieces * (edge.to - edge.from);
    std::array<std::vector<Vector3d>, 2> widest_chord;
    for (const double within : {0.1, 0.5, 0.9}) {
      const auto here = chords(edge, (i + within) / pieces);
      for (std::size_t k = 0; k < std::min(here.size(), widest_chord.size()); ++k) {
        auto& best = widest_chord[k];
        if (best.empty() || best[0].norm() < here[k].norm()) best.assign(1, here[k]);
      }
    }
    const Vector3d middle = edge.from + (2.0 * i + 1.0) * half, axis = half.normalized();
    for (const auto& best : widest_chord) {
      if (best.empty()) continue;
      const Vector3d chord = best[0] - best[0].dot(axis) * axis;
      const Vector3d across = 0.5 * margin_across * chord;
      found.push_back({.center = middle + 0.5 * chord,
                       .along = margin_along * half,
                       .across = across,
                       .normal = axis.cross(across).normalized()});
    }
  }

  // Chords from a point of the edge to the surfaces opposite, narrowest first; of those that point
  // nearly the same way the narrowest alone.
  std::vector<Vector3d> chords(const Edge& edge, double s) const {
    const Vector3d at = edge.from + s * (edge.to - edge.from),
                   axis = (edge.to - edge.from).normalized();
    Vector3d x, y;
    tangent_frame(axis, x, y);
    std::vector<Vector3d> all;
    for (int k = 0; k < directions; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.5) / directions;
      const Vector3d direction = std::cos(angle) * x + std::sin(angle) * y;
      const auto chord = chord_of_ball(at, direction);
      if (chord && std::abs(chord->dot(axis)) <= most_along * chord->norm()) all.push_back(*chord);
    }
    const auto narrower = [](const Vector3d& a, const Vector3d& b) { return a.norm() < b.norm(); };
    std::stable_sort(all.begin(), all.end(), narrower);
    std::vector<Vector3d> distinct;
    constexpr double same_way = 0.5;  // cosine of 60 degrees
    for (const Vector3d& chord : all) {
      const bool is_new =
          std::none_of(distinct.begin(), distinct.end(), [&](const Vector3d& other) {
            return chord.dot(other) > same_way * chord.norm() * other.norm();
          });
      if (is_new) distinct.push_back(chord);
    }
    return distinct;
  }

  // The chord between the two points that the largest empty ball touches, of all that touch `at`
  // from `direction` (unit); empty if the chord is not nearly a diameter, or out of range.
  std::optional<Vector3d> chord_of_ball(const Vector3d& at, const Vector3d& direction) const {
    constexpr double touching = 1.0 - 1e-6, growth = 4.0;
    const double most = 0.5 * widest_opening * diagonal_;
    const auto inside = [&](double radius) {
      return surfaces_.find(at + radius * direction, touching * radius);
    };
    std::optional<Vector3d> touched;
    double radius = 1e-3 * most;
    for (; !(touched = inside(radius)); radius *= growth) {
      if (radius > most) return std::nullopt;
    }
    constexpr int most_steps = 32;
    for (int step = 0; step < most_steps; ++step) {
      const Vector3d chord = *touched - at;
      const double height = chord.dot(direction);
      if (chord.norm() < narrowest_opening * diagonal_ || !(height > 0.0)) return std::nullopt;
      radius = chord.squaredNorm() / (2.0 * height);
      const auto nearer = inside(radius);
      if (nearer) {
        touched = nearer;
        continue;
      }
      if (height < least_cosine * chord.norm() || chord.norm() > 2.0 * most) return std::nullopt;
      return chord;
    }
    return std::nullopt;
  }

  NearestSurface surfaces_;
  double diagonal_;
};

// True if `other` covers the middle of `opening` and is about as wide.
bool is_same(const Opening& opening, const Opening& other) {
  constexpr double parallel = 0.97, ratio = 2.0, off_plane = 0.5;
  const double width = opening.across.norm(), of_other = other.across.norm();
  if (std::abs(opening.normal.dot(other.normal)) < parallel) return false;
  if (width > ratio * of_other || of_other > ratio * width) return false;
  const Vector3d to = opening.center - other.center;
  return std::abs(to.dot(other.normal)) < off_plane * of_other &&
         std::abs(to.dot(other.along)) < other.along.squaredNorm() &&
         std::abs(to.dot(other.across)) < other.across.squaredNorm();
}

// The numbers of an opening, for other processes.
using OpeningNumbers = std::array<double, 12>;

std::vector<OpeningNumbers> numbers_of(const std::vector<Opening>& openings) {
  std::vector<OpeningNumbers> result;
  for (const auto& [center, along, across, normal] : openings) {
    OpeningNumbers& numbers = result.emplace_back();
    Eigen::Map<Eigen::Matrix<double, 3, 4>>(numbers.data()) << center, along, across, normal;
  }
  return result;
}

std::vector<Opening> openings_of(const std::vector<OpeningNumbers>& all) {
  std::vector<Opening> result;
  for (const OpeningNumbers& numbers : all) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 4>> columns(numbers.data());
    result.push_back({.center = columns.col(0),
                      .along = columns.col(1),
                      .across = columns.col(2),
                      .normal = columns.col(3)});
  }
  return result;
}

}  // namespace

std::vector<Opening> find_openings(const Scene& scene, const RunControl& run) {
  if (scene.surfaces.empty()) return {};
  const std::vector<Edge> edges = long_edges(scene, shortest_edge * scenery_length(scene));
  const OpeningSearch search(scene);
  std::vector<std::vector<Opening>> beside(edges.size());
  const int count = static_cast<int>(edges.size());
  const JournalPhase phase({.processes = run.processes}, "openings", [&](Fingerprint& print) {
    print.add(scene_hash(scene));
    print.add(count);
  });
  const int slice = 128 * phase.processes();
  for (int first = 0; first < count; first += slice) {
    const auto report_progress = [&] {
      report(run.progress, "openings", static_cast<double>(first) / count);
    };
    report_progress();
    const auto look = [&](int begin, int end) {
      std::vector<OpeningNumbers> found;
      for (int i = first + begin; i < first + end; ++i) {
        std::vector<Opening>& here = beside[static_cast<std::size_t>(i)];
        if (phase.recall(i, found)) {
          here = openings_of(found);
          continue;
        }
        search.search(edges[static_cast<std::size_t>(i)], here);
        if (phase.is_kept()) phase.keep(i, numbers_of(here));
      }
    };
    phase.for_each({first, std::min(slice, count - first), 8}, look, report_progress);
  }
  std::vector<Opening> openings;
  for (const auto& of_edge : beside) {
    for (const Opening& opening : of_edge) {
      const bool is_known =
          std::any_of(openings.begin(), openings.end(),
                      [&](const Opening& other) { return is_same(opening, other); });
      if (!is_known && openings.size() < most_openings) openings.push_back(opening);
    }
  }
  return openings;
}

}  // namespace lightwell
