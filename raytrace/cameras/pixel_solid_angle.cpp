#include "raytrace/cameras/pixel_solid_angle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "raytrace/cameras/fisheye.h"
#include "raytrace/cameras/picture_plane.h"

namespace lightwell {
namespace {

using Place = Eigen::Vector2d;

// Gauss and Legendre's points and weights on [0, 1].
constexpr std::array<double, 8> gauss_points = {
    0.01985507175123188, 0.10166676129318664, 0.23723379504183550, 0.40828267875217510,
    0.59171732124782490, 0.76276620495816450, 0.89833323870681336, 0.98014492824876812};
constexpr std::array<double, 8> gauss_weights = {
    0.05061426814518813, 0.11119051722668724, 0.15685332293894364, 0.18134189168918100,
    0.18134189168918100, 0.15685332293894364, 0.11119051722668724, 0.05061426814518813};

// Integral of (1 - cos theta) d phi along the straight way from a to b.
double along_line(Projection projection, const Place& a, const Place& b) {
  const Place way = b - a;
  double sum = 0.0;
  for (std::size_t i = 0; i < gauss_points.size(); ++i) {
    const Place p = a + gauss_points[i] * way;
    const double r2 = p.squaredNorm();
    if (r2 == 0.0) continue;
    const double half = std::sin(0.5 * fisheye_angle(projection, std::sqrt(r2)));
    sum += gauss_weights[i] * 2.0 * half * half * (p.x() * way.y() - p.y() * way.x()) / r2;
  }
  return sum;
}

// Integral of (1 - cos theta) d phi along the arc of a circle of this radius about the origin, from
// the direction of a to that of b the shorter way.
double along_arc(Projection projection, double radius, const Place& a, const Place& b) {
  const double half = std::sin(0.5 * fisheye_angle(projection, radius));
  const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  return 2.0 * half * half * turn;
}

// The same for the edge from a to b of a pixel, of which the parts beyond the circle are replaced
// by the arc before them. So the edges around a pixel add up to the boundary of the pixel's part
// within the circle.
double along_edge(Projection projection, double circle, const Place& a, const Place& b) {
  const Place way = b - a;
  const double length2 = way.squaredNorm(), half = -a.dot(way) / length2;
  const double under = half * half - (a.squaredNorm() - circle * circle) / length2;
  const auto arc = [&](const Place& from, const Place& to) {
    return along_arc(projection, circle, from, to);
  };
  if (!(under > 0.0)) return arc(a, b);
  const double enter = std::clamp(half - std::sqrt(under), 0.0, 1.0);
  const double leave = std::clamp(half + std::sqrt(under), 0.0, 1.0);
  if (enter == leave) return arc(a, b);
  const Place in = a + enter * way, out = a + leave * way;
  double sum = along_line(projection, in, out);
  if (enter > 0.0) sum += arc(a, in);
  if (leave < 1.0) sum += arc(out, b);
  return sum;
}

double triangle_solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c) {
  return 2.0 * std::atan2(std::abs(a.dot(b.cross(c))), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
}

double flat_solid_angle(const PicturePlane& plane, int panel, const std::array<Place, 4>& corners) {
  std::array<Eigen::Vector3d, 4> directions;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto direction = plane.direction(corners[i], panel);
    if (!direction) return 0.0;
    directions[i] = *direction;
  }
  return triangle_solid_angle(directions[0], directions[1], directions[2]) +
         triangle_solid_angle(directions[0], directions[2], directions[3]);
}

}  // namespace

double pixel_solid_angle(const Camera& camera, int x, int y) {
  const PicturePlane plane(camera);
  const int panel = plane.panel_at(x + 0.5, y + 0.5);
  // Around the pixel: to the right along the bottom, then upwards.
  const std::array<Place, 4> corners = {plane.place(x, y + 1, panel),
                                        plane.place(x + 1, y + 1, panel),
                                        plane.place(x + 1, y, panel), plane.place(x, y, panel)};
  const Place& low = corners[0];
  const Place& high = corners[2];
  const Projection projection = camera.projection;
  switch (projection) {
    case Projection::orthographic:
      return 0.0;
    case Projection::perspective:
    case Projection::cube_map:
      return flat_solid_angle(plane, panel, corners);
    case Projection::cylindrical:
      return (high.x() - low.x()) * (std::sin(std::atan(high.y())) - std::sin(std::atan(low.y())));
    case Projection::equirectangular:
    case Projection::stereo_panorama:
      return (high.x() - low.x()) * (std::sin(high.y()) - std::sin(low.y()));
    case Projection::equidistant:
    case Projection::equisolid:
    case Projection::hemispherical:
    case Projection::stereographic:
      break;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sum += along_edge(projection, plane.circle(), corners[i], corners[(i + 1) % corners.size()]);
  }
  return sum;
}

}  // namespace lightwell
