#include "scene/io/pov/pov_csg.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/io/convex_cut.h"

namespace lightwell {
namespace {

constexpr double on_the_plane = 1e-9;  // relative to the size of the bodies, far above rounding

bool spans_area(const Loop& loop, double size) {
  return loop.size() >= 3 && area_vector(loop).norm() > on_the_plane * size * size_of(loop);
}

/// Distances of corners from a plane, those within rounding as 0.
std::vector<double> distances(const Loop& loop, const PovHalfSpace& plane, double size) {
  std::vector<double> result;
  for (const Eigen::Vector3d& p : loop) {
    const double d = plane.normal.dot(p) - plane.distance;
    result.push_back(std::abs(d) > on_the_plane * size ? d : 0.0);
  }
  return result;
}

/// A face that lies in a plane of a body, and looks the same way or the other way.
enum class Touch { keep, drop };
struct Touches {
  Touch same = Touch::drop, opposite = Touch::drop;
};

/// The parts of a face inside and outside of a body.
struct Parts {
  std::vector<Loop> inside{}, outside{};
};

// A face that touches the body's plane is outside as a whole where `touches` says keep. For the
// inside, keep means that the face counts as inside of that plane.
Parts cut(Loop face, const PovConvex& body, Touches touches, bool wants_inside, double size) {
  Parts parts;
  const Eigen::Vector3d normal = area_vector(face);
  for (const PovHalfSpace& plane : body.planes) {
    const std::vector<double> distance = distances(face, plane, size);
    if (std::ranges::all_of(distance, [](double d) { return d == 0.0; })) {
      const Touch touch = normal.dot(plane.normal) > 0.0 ? touches.same : touches.opposite;
      if ((touch == Touch::keep) == wants_inside) continue;
      parts.outside.push_back(std::move(face));
      return parts;
    }
    Loop outside = clip_convex(face, distance, 1.0);
    if (spans_area(outside, size)) parts.outside.push_back(std::move(outside));
    face = clip_convex(face, distance, -1.0);
    if (!spans_area(face, size)) return parts;
  }
  parts.inside.push_back(std::move(face));
  return parts;
}

std::vector<Loop> outside_of(std::vector<Loop> faces, const PovConvex& body, Touches touches,
                             double size) {
  std::vector<Loop> left;
  for (Loop& face : faces) {
    Parts parts = cut(face, body, touches, false, size);
    // A face that does not meet the body stays whole.
    if (parts.inside.empty()) parts.outside = {std::move(face)};
    std::ranges::move(parts.outside, std::back_inserter(left));
  }
  return left;
}

std::vector<Loop> inside_of(std::vector<Loop> faces, const PovConvex& body, Touches touches,
                            double size) {
  std::vector<Loop> left;
  for (Loop& face : faces) {
    Parts parts = cut(std::move(face), body, touches, true, size);
    std::ranges::move(parts.inside, std::back_inserter(left));
  }
  return left;
}

void append(std::size_t body, std::vector<Loop> faces, bool is_turned,
            std::vector<PovCutFace>& all) {
  for (Loop& face : faces) {
    if (is_turned) std::ranges::reverse(face);
    all.push_back({.body = body, .loop = std::move(face)});
  }
}

}  // namespace

PovConvex pov_convex(std::vector<Loop> faces) {
  PovConvex body;
  double size = 0.0;
  for (const Loop& face : faces) size = std::max(size, size_of(face));
  for (const Loop& face : faces) {
    const Eigen::Vector3d area = area_vector(face);
    if (!(area.norm() > 0.0) || !is_convex(face)) return {};
    const Eigen::Vector3d normal = area.normalized();
    body.planes.push_back({.normal = normal, .distance = normal.dot(face.front())});
  }
  for (const PovHalfSpace& plane : body.planes) {
    for (const Loop& face : faces) {
      for (const Eigen::Vector3d& p : face) {
        if (plane.normal.dot(p) - plane.distance > flatness * size) return {};
      }
    }
  }
  body.faces = std::move(faces);
  return body;
}

std::vector<PovCutFace> pov_difference(const PovConvex& first, const std::vector<PovConvex>& others,
                                       double size) {
  std::vector<PovCutFace> all;
  for (const Loop& face : first.faces) {
    std::vector<Loop> left = {face};
    // A body that is cut off flush with the face opens it; a body that touches from outside does
    // not.
    const Touches touches{.same = Touch::drop, .opposite = Touch::keep};
    for (const PovConvex& other : others) left = outside_of(std::move(left), other, touches, size);
    append(0, std::move(left), false, all);
  }
  for (std::size_t i = 0; i < others.size(); ++i) {
    for (const Loop& face : others[i].faces) {
      if (face.empty()) continue;
      std::vector<Loop> left = inside_of({face}, first, {}, size);
      for (std::size_t k = 0; k < others.size(); ++k) {
        if (k == i) continue;
        // One of two faces that lie on each other and look the same way stays.
        const Touches touches{.same = k > i ? Touch::keep : Touch::drop};
        left = outside_of(std::move(left), others[k], touches, size);
      }
      append(i + 1, std::move(left), true, all);
    }
  }
  return all;
}

std::vector<PovCutFace> pov_intersection(const std::vector<PovConvex>& bodies, double size) {
  std::vector<PovCutFace> all;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (const Loop& face : bodies[i].faces) {
      if (face.empty()) continue;
      std::vector<Loop> left = {face};
      for (std::size_t k = 0; k < bodies.size(); ++k) {
        if (k == i) continue;
        const Touches touches{.same = k > i ? Touch::keep : Touch::drop};
        left = inside_of(std::move(left), bodies[k], touches, size);
      }
      append(i, std::move(left), false, all);
    }
  }
  return all;
}

}  // namespace lightwell
