#include "scene/io/crossing_polygon.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double coincident = 1e-9;  // of the polygon's size
constexpr double most_work = 1e8;    // pairs of edges, and of edges and lines

// An edge that rises or falls; levels are numbers of lines.
struct SlopedEdge {
  int from = 0, to = 0;  // corners of the polygon, the lower one first
  int loop = 0;
  int winding = 0;  // 1: the polygon passes the edge upwards, -1: downwards
  Vector2d low, high;
  std::size_t first_level = 0, last_level = 0;

  double share(double y) const { return (y - low.y()) / (high.y() - low.y()); }
  double x(double y) const { return low.x() + share(y) * (high.x() - low.x()); }
};

// A piece under construction: between two edges, from a line upwards.
struct OpenPiece {
  std::size_t left = 0, right = 0;  // edges
  std::size_t first_level = 0;

  bool operator==(const OpenPiece& other) const {
    return left == other.left && right == other.right;
  }
};

// The normal of the plane that fits the loop best, on the side of its area or, where the parts of
// the area cancel, of its sharpest corner.
Vector3d fitted_normal(const Loop& loop) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : loop) mean += (p - loop[0]) / static_cast<double>(loop.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : loop) {
    const Vector3d d = p - loop[0] - mean;
    spread += d * d.transpose();
  }
  const Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  const double size = size_of(loop), area = area_vector(loop).dot(normal);
  if (std::abs(area) > flatness * size * size) return area < 0.0 ? Vector3d(-normal) : normal;
  double sharpest = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector3d &at = loop[(i + 1) % loop.size()], &next = loop[(i + 2) % loop.size()];
    const double turn = (at - loop[i]).cross(next - at).dot(normal);
    if (std::abs(turn) > std::abs(sharpest)) sharpest = turn;
  }
  return sharpest < 0.0 ? Vector3d(-normal) : normal;
}

class Cutter {
 public:
  explicit Cutter(const Polygon& polygon) {
    flatten(polygon);
    add_edges(polygon);
  }

  std::vector<std::vector<PieceCorner>> pieces() {
    const double edges = static_cast<double>(edges_.size());
    if (edges * edges > most_work) return {};
    add_crossings();
    if (edges * static_cast<double>(levels_.size()) > most_work) return {};
    std::vector<OpenPiece> open;
    for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
      std::vector<OpenPiece> next = runs(l);
      for (OpenPiece& run : next) {
        const auto below = std::ranges::find(open, run);
        if (below == open.end()) continue;
        run.first_level = below->first_level;
        open.erase(below);
      }
      for (const OpenPiece& ended : open) close(ended, l);
      open = std::move(next);
    }
    for (const OpenPiece& ended : open) close(ended, levels_.size() - 1);
    return std::move(pieces_);
  }

 private:
  // Coordinates in the plane in units of the size, with the longest edge along x.
  void flatten(const Polygon& polygon) {
    const Loop& boundary = polygon.boundary;
    const double size = size_of(boundary);
    // The area of a loop that crosses itself has a direction only if the loop is planar.
    const bool is_planar = !is_thin(boundary) && deviation_from_plane({boundary}) <= flatness;
    const Vector3d normal =
        is_planar ? Vector3d(area_vector(boundary).normalized()) : fitted_normal(boundary);
    Vector3d along = Vector3d::Zero();
    for (std::size_t i = 0; i < boundary.size(); ++i) {
      Vector3d edge = boundary[(i + 1) % boundary.size()] - boundary[i];
      edge -= edge.dot(normal) * normal;
      if (edge.squaredNorm() > (1.0 + coincident) * along.squaredNorm()) along = edge;
    }
    if (!(size > 0.0) || along.isZero()) return;
    const Vector3d x = along.normalized(), y = normal.cross(x);
    const auto add = [&](const Loop& loop) {
      for (const Vector3d& p : loop) {
        const Vector3d d = (p - boundary[0]) / size;
        corners_.emplace_back(d.dot(x), d.dot(y));
      }
    };
    add(boundary);
    for (const Loop& hole : polygon.holes) add(hole);
    for (const Vector2d& corner : corners_) levels_.push_back(corner.y());
    join(levels_);
    for (Vector2d& corner : corners_) {
      corner.y() = *(std::ranges::upper_bound(levels_, corner.y()) - 1);
    }
  }

  // Sorts heights; those within `coincident` of the first of them become that one.
  static void join(std::vector<double>& heights) {
    std::ranges::sort(heights);
    std::size_t kept = 0;
    for (const double height : heights) {
      if (kept == 0 || height - heights[kept - 1] > coincident) heights[kept++] = height;
    }
    heights.resize(kept);
  }

  void add_edges(const Polygon& polygon) {
    if (corners_.empty()) return;
    int first = 0;
    loops_ = static_cast<int>(polygon.holes.size()) + 1;
    for (int l = 0; l < loops_; ++l) {
      const Loop& loop = l == 0 ? polygon.boundary : polygon.holes[static_cast<std::size_t>(l - 1)];
      const int n = static_cast<int>(loop.size());
      for (int i = 0; i < n; ++i) {
        int from = first + i, to = first + (i + 1) % n;
        const double rise = at(to).y() - at(from).y();
        if (rise == 0.0) continue;
        if (rise < 0.0) std::swap(from, to);
        edges_.push_back({.from = from,
                          .to = to,
                          .loop = l,
                          .winding = rise > 0.0 ? 1 : -1,
                          .low = at(from),
                          .high = at(to)});
      }
      first += n;
    }
  }
  const Vector2d& at(int corner) const { return corners_[static_cast<std::size_t>(corner)]; }

  // Adds a line through each crossing that lies on no line through a corner.
  void add_crossings() {
    std::vector<double> heights;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      for (std::size_t j = i + 1; j < edges_.size(); ++j) {
        const auto y = crossing(edges_[i], edges_[j]);
        if (!y) continue;
        const auto above = std::ranges::lower_bound(levels_, *y);
        if (*above - *y > coincident && *y - *(above - 1) > coincident) heights.push_back(*y);
      }
    }
    join(heights);
    const auto middle = static_cast<std::ptrdiff_t>(levels_.size());
    levels_.insert(levels_.end(), heights.begin(), heights.end());
    std::ranges::inplace_merge(levels_, levels_.begin() + middle);
  }

  // The height at which one edge passes from one side of the other to the other side.
  static std::optional<double> crossing(const SlopedEdge& e, const SlopedEdge& f) {
    const double low = std::max(e.low.y(), f.low.y()), high = std::min(e.high.y(), f.high.y());
    if (!(high > low)) return std::nullopt;
    const double below = e.x(low) - f.x(low), above = e.x(high) - f.x(high);
    if (std::abs(below) <= coincident || std::abs(above) <= coincident) return std::nullopt;
    if ((below > 0.0) == (above > 0.0)) return std::nullopt;
    return low + below / (below - above) * (high - low);
  }

  // The parts of the polygon between line l and the next one.
  std::vector<OpenPiece> runs(std::size_t l) const {
    const double low = levels_[l], high = levels_[l + 1], middle = 0.5 * (low + high);
    std::vector<std::pair<double, std::size_t>> across;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (edges_[e].low.y() <= low && edges_[e].high.y() >= high) {
        across.emplace_back(edges_[e].x(middle), e);
      }
    }
    std::ranges::sort(across);
    std::vector<OpenPiece> found;
    std::vector<int> winding(static_cast<std::size_t>(loops_), 0);
    std::size_t left = 0;
    bool was_inside = false;
    for (const auto& [x, e] : across) {
      winding[static_cast<std::size_t>(edges_[e].loop)] += edges_[e].winding;
      const bool is_inside = winding[0] != 0 && std::all_of(winding.begin() + 1, winding.end(),
                                                            [](int w) { return w == 0; });
      if (is_inside && !was_inside) left = e;
      if (was_inside && !is_inside && x - edges_[left].x(middle) > coincident) {
        found.push_back({.left = left, .right = e, .first_level = l});
      }
      was_inside = is_inside;
    }
    return found;
  }

  // Ends a piece at a line.
  void close(const OpenPiece& piece, std::size_t level) {
    const double low = levels_[piece.first_level], high = levels_[level];
    std::vector<PieceCorner> corners;
    const std::pair<std::size_t, double> around[] = {
        {piece.left, low}, {piece.right, low}, {piece.right, high}, {piece.left, high}};
    for (const auto& [e, y] : around) {
      const SlopedEdge& edge = edges_[e];
      const PieceCorner corner = known({edge.from, edge.to, edge.share(y)});
      if (corners.empty() || !(corners.back() == corner)) corners.push_back(corner);
    }
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    if (corners.size() >= 3) pieces_.push_back(std::move(corners));
  }

  // The corner of the polygon or of an earlier piece at the place of this one, if there is one, so
  // that pieces share their corners exactly.
  PieceCorner known(const PieceCorner& corner) {
    const Vector2d place = corner.of(corners_);
    if (known_.empty()) {
      for (int i = 0; i < static_cast<int>(corners_.size()); ++i) {
        known_.emplace_back(at(i).x(), PieceCorner{.from = i, .to = i});
      }
      std::ranges::stable_sort(known_, {}, &std::pair<double, PieceCorner>::first);
    }
    constexpr double joined = 4.0 * coincident;
    const auto first = std::ranges::lower_bound(known_, place.x() - joined, {},
                                                &std::pair<double, PieceCorner>::first);
    for (auto i = first; i != known_.end() && i->first <= place.x() + joined; ++i) {
      if ((i->second.of(corners_) - place).norm() <= joined) return i->second;
    }
    known_.insert(
        std::ranges::upper_bound(known_, place.x(), {}, &std::pair<double, PieceCorner>::first),
        {place.x(), corner});
    return corner;
  }

  int loops_ = 0;
  std::vector<Vector2d> corners_;
  std::vector<double> levels_;
  std::vector<SlopedEdge> edges_;
  std::vector<std::pair<double, PieceCorner>> known_;  // by x
  std::vector<std::vector<PieceCorner>> pieces_;
};

}  // namespace

std::vector<std::vector<PieceCorner>> convex_pieces(const Polygon& polygon) {
  if (polygon.boundary.size() < 3) return {};
  return Cutter(polygon).pieces();
}

}  // namespace lightwell
