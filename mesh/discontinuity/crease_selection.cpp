#include "mesh/discontinuity/crease_selection.h"

#include <algorithm>
#include <cmath>

#include "mesh/geometry/cross.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double spacing_share = 0.05;      // of the element size; nearer points make slivers
constexpr double least_angle_sine = 0.208;  // sin(12 degrees)

// Computes the parameters s on a-b and t on p-q of the crossing; false if the segments do not
// cross.
bool crossing(const Vector2d& a, const Vector2d& b, const Vector2d& p, const Vector2d& q, double& s,
              double& t) {
  const Vector2d u = b - a, v = q - p, w = p - a;
  const double determinant = cross(u, v);
  constexpr double parallel = 1e-9;
  if (!(std::abs(determinant) > parallel * u.norm() * v.norm())) return false;
  s = cross(w, v) / determinant;
  t = cross(w, u) / determinant;
  return s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0;
}

// Linear elements gain nothing from a D2 line, across which the curvature of irradiance jumps, once
// several elements lie across the penumbra; even elements then have the smaller error. On the floor
// of the Cornell box, drawing the resolved lines as well lowers the gain of cutting from 1.8 to 1.5
// (bench/discontinuity_bench.cpp).
bool is_resolved(const CriticalLine& line, double element_size) {
  constexpr double enough = 6.0;
  return line.degree == LineDegree::d2 &&
         std::min(line.penumbra[0], line.penumbra[1]) > enough * element_size;
}

}  // namespace

CreaseSelection::CreaseSelection(const std::vector<FacetPlane>& planes,
                                 const std::vector<std::vector<FixedPiece>>& fixed,
                                 const CreaseOptions& options)
    : planes_(planes),
      fixed_(fixed),
      options_(options),
      spacing_(spacing_share * options.element_size),
      drawings_(planes.size()),
      creases_(planes.size()) {}

void CreaseSelection::select(const std::vector<CriticalLine>& lines) {
  constexpr double least_tolerances = 10.0;  // points `spacing_` apart must not be joined
  for (const CriticalLine& line : lines) {
    if (line.degree == LineDegree::d0) continue;
    if (!(elements_ < options_.most_elements)) {
      ++counts_.over_budget;
    } else if (is_resolved(line, options_.element_size)) {
      ++counts_.resolved;
    } else if (spacing_ > least_tolerances * options_.tolerance && add_line(line)) {
      ++counts_.drawn;
    } else {
      ++counts_.too_close;
    }
  }
  for (std::size_t p = 0; p < drawings_.size(); ++p) {
    const Drawing& d = drawings_[p];
    for (const Piece& piece : d.pieces) {
      if (piece.segment < 0) creases_[p].push_back({d.position[piece.a], d.position[piece.b]});
    }
  }
}

CreaseSelection::Drawing& CreaseSelection::drawing(int plane) {
  Drawing& d = drawings_[plane];
  if (d.is_ready) return d;
  d.is_ready = true;
  std::map<int, int> local;
  const auto number = [&](int point, const Vector3d& position) {
    const auto [entry, is_new] = local.try_emplace(point, static_cast<int>(d.xy.size()));
    if (is_new) {
      d.xy.push_back(planes_[plane].project(position));
      d.position.push_back(position);
    }
    return entry->second;
  };
  for (const FixedPiece& f : fixed_[plane]) {
    const int a = number(f.a, f.from), b = number(f.b, f.to);
    d.pieces.push_back({a, b, f.segment});
  }
  return d;
}

// Returns the stops of the line a-b by rising parameter: points of the drawing within `spacing_`,
// crossings with pieces, and the ends of the line.
std::vector<CreaseSelection::Stop> CreaseSelection::stops(const Drawing& d, const Vector2d& a,
                                                          const Vector2d& b) const {
  const Vector2d u = b - a;
  const double squared = u.squaredNorm();
  std::vector<Stop> result;
  for (int p = 0; p < static_cast<int>(d.xy.size()); ++p) {
    if (!(segment_distance(d.xy[p], a, b) <= spacing_)) continue;
    result.push_back({std::clamp(u.dot(d.xy[p] - a) / squared, 0.0, 1.0), p, -1, d.xy[p]});
  }
  const auto is_taken = [&](const Vector2d& q) {
    return std::any_of(result.begin(), result.end(),
                       [&](const Stop& s) { return (s.xy - q).norm() <= spacing_; });
  };
  // An end within `spacing_` of a piece is moved onto the piece, so that rounding leaves no gap.
  for (const double end : {0.0, 1.0}) {
    const Vector2d q = a + end * u;
    if (is_taken(q)) continue;
    Stop stop{end, -1, -1, q};
    double nearest = spacing_;
    for (int i = 0; i < static_cast<int>(d.pieces.size()); ++i) {
      const Vector2d &from = d.xy[d.pieces[i].a], &to = d.xy[d.pieces[i].b];
      const double distance = segment_distance(q, from, to);
      if (!(distance < nearest)) continue;
      nearest = distance;
      stop.piece = i;
      stop.xy = from + (to - from).dot(q - from) / (to - from).squaredNorm() * (to - from);
    }
    if (!is_taken(stop.xy)) result.push_back(stop);
  }
  for (int i = 0; i < static_cast<int>(d.pieces.size()); ++i) {
    double s, t;
    if (!crossing(a, b, d.xy[d.pieces[i].a], d.xy[d.pieces[i].b], s, t)) continue;
    const Vector2d q = a + s * u;
    if (!is_taken(q)) result.push_back({s, -1, i, q});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Stop& p, const Stop& q) { return p.t < q.t; });
  return result;
}

// True if the piece between two neighbouring stops keeps its distance and angle from everything
// else.
bool CreaseSelection::fits(const Drawing& d, const Stop& from, const Stop& to) const {
  const Vector2d u = to.xy - from.xy;
  if (!(u.norm() > spacing_)) return false;
  const auto has = [](const Piece& piece, int point) {
    return point >= 0 && (piece.a == point || piece.b == point);
  };
  const auto is_narrow = [](const Vector2d& one, const Vector2d& other) {
    return one.dot(other) > 0.0 &&
           std::abs(cross(one, other)) < least_angle_sine * one.norm() * other.norm();
  };
  for (int i = 0; i < static_cast<int>(d.pieces.size()); ++i) {
    const Piece& piece = d.pieces[i];
    const Vector2d &p = d.xy[piece.a], &q = d.xy[piece.b];
    if (has(piece, from.point) && has(piece, to.point)) return false;
    bool touches = false;
    for (const auto& [stop, at, out] :
         {std::tuple(&from, from.xy, u), {&to, to.xy, Vector2d(-u)}}) {
      if (!has(piece, stop->point) && stop->piece != i) continue;
      touches = true;
      for (const Vector2d& end : {p, q}) {
        if ((end - at).norm() > 0.5 * spacing_ && is_narrow(out, end - at)) return false;
      }
    }
    double s, t;
    if (!touches && crossing(from.xy, to.xy, p, q, s, t)) return false;
  }
  for (int p = 0; p < static_cast<int>(d.xy.size()); ++p) {
    if (p == from.point || p == to.point) continue;
    if (segment_distance(d.xy[p], from.xy, to.xy) < 0.5 * spacing_) return false;
  }
  return true;
}

// Makes the point of a stop. On a line shared with another facet, a point that the other facet has
// made within `spacing_` is used, so that both facets get the same vertex.
int CreaseSelection::make_point(const FacetPlane& plane, Drawing& d, const Stop& stop) {
  const int point = static_cast<int>(d.xy.size());
  Vector3d position = plane.lift(stop.xy);
  if (stop.piece >= 0) {
    const Piece piece = d.pieces[stop.piece];
    if (piece.segment >= 0) {
      auto& made = made_on_segment_[piece.segment];
      const auto known = std::find_if(made.begin(), made.end(), [&](const Vector3d& p) {
        return (p - position).norm() <= spacing_;
      });
      if (known == made.end())
        made.push_back(position);
      else
        position = *known;
    }
    d.pieces[stop.piece].b = point;
    d.pieces.push_back({point, piece.b, piece.segment});
  }
  d.xy.push_back(plane.project(position));
  d.position.push_back(position);
  return point;
}

bool CreaseSelection::add_line(const CriticalLine& line) {
  const FacetPlane& plane = planes_[line.plane];
  const double h = options_.element_size;
  const Vector2d a = plane.project(line.ends[0]), b = plane.project(line.ends[1]);
  if (!((b - a).norm() > spacing_) || !(plane.area() > h * h)) return false;
  Drawing& d = drawing(line.plane);
  std::vector<Stop> chain = stops(d, a, b);
  // Points are made only where a piece is kept, so pieces that are left out leave no trace.
  // Splitting a piece renumbers the second half of that piece and no other.
  bool is_kept = false;
  for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
    Stop &from = chain[k], &to = chain[k + 1];
    if (!fits(d, from, to)) continue;
    for (Stop* stop : {&from, &to}) {
      if (stop->point >= 0) continue;
      const int before = static_cast<int>(d.pieces.size());
      stop->point = make_point(plane, d, *stop);
      stop->xy = d.xy[stop->point];
      if (stop->piece < 0) continue;
      for (std::size_t later = k; later < chain.size(); ++later) {
        Stop& other = chain[later];
        if (other.point >= 0 || other.piece != stop->piece) continue;
        const Piece& second = d.pieces[before];
        const Vector2d &p = d.xy[second.a], &q = d.xy[second.b];
        if ((q - p).dot(other.xy - p) > 0.0) other.piece = before;
      }
    }
    d.pieces.push_back({from.point, to.point});
    is_kept = true;
    // A line that crosses a quadrilateral leaves triangles on both sides, and more where the line
    // ends.
    elements_ += std::ceil((to.xy - from.xy).norm() / h) + 1.0;
  }
  return is_kept;
}

}  // namespace lightwell
