#include "design/places/allowed_places.h"

#include <algorithm>

namespace lightwell {
namespace {

Eigen::Vector3d in_box(const AllowedPlace& box, const Eigen::Vector3d& place) {
  return place.cwiseMax(box.low).cwiseMin(box.high);
}

// The direction from `other` to `place` along the axes that `box` leaves free; of lamps in one
// place the first free axis, `forth` (1) or back (-1). Zero if no axis is free.
Eigen::Vector3d way_apart(const AllowedPlace& box, const Eigen::Vector3d& place,
                          const Eigen::Vector3d& other, double forth) {
  const Eigen::Array3d is_free = (box.high - box.low).array().sign();
  const Eigen::Vector3d way = is_free * (place - other).array();
  if (way.norm() > place_tolerance) return way.normalized();
  for (int axis = 0; axis < 3; ++axis) {
    if (is_free[axis] > 0.0) return forth * Eigen::Vector3d::Unit(axis);
  }
  return Eigen::Vector3d::Zero();
}

// Calls visit(i, place of the other lamp, its number or -1 for one that stays, distance that lacks)
// for each lamp and each other one that is too close.
template <class Visit>
void for_each_close(const AllowedPlaces& allowed, const Eigen::Matrix3Xd& places, Visit&& visit) {
  const auto count = static_cast<int>(allowed.moved.size());
  for (int i = 0; i < count; ++i) {
    const double apart = allowed.moved[static_cast<std::size_t>(i)].apart;
    for (int j = 0; j < i; ++j) {
      const double least = std::max(apart, allowed.moved[static_cast<std::size_t>(j)].apart);
      const double lack = least - (places.col(i) - places.col(j)).norm();
      if (lack > 0.0) visit(i, Eigen::Vector3d(places.col(j)), j, lack);
    }
    for (const Eigen::Vector3d& other : allowed.fixed) {
      const double lack = apart - (places.col(i) - other).norm();
      if (lack > 0.0) visit(i, other, -1, lack);
    }
  }
}

}  // namespace

Eigen::Matrix3Xd places_of(const Scene& scene, const AllowedPlaces& allowed) {
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(allowed.moved.size()));
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const int lamp = allowed.moved[static_cast<std::size_t>(i)].lamp;
    places.col(i) = scene.lamps[static_cast<std::size_t>(lamp)].position;
  }
  return places;
}

bool allows(const AllowedPlaces& allowed, const Eigen::Matrix3Xd& places) {
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const AllowedPlace& box = allowed.moved[static_cast<std::size_t>(i)];
    const Eigen::Vector3d place = places.col(i);
    if (!((place - in_box(box, place)).cwiseAbs().maxCoeff() <= place_tolerance)) return false;
  }
  double most = 0.0;
  for_each_close(allowed, places, [&](int, const Eigen::Vector3d&, int, double lack) {
    most = std::max(most, lack);
  });
  return most <= place_tolerance;
}

std::optional<Eigen::Matrix3Xd> nearest_allowed(const AllowedPlaces& allowed,
                                                const Eigen::Matrix3Xd& wanted) {
  Eigen::Matrix3Xd places = wanted;
  constexpr int most_rounds = 200;  // each halves what lacks, or lamps have no room
  for (int round = 0; round < most_rounds; ++round) {
    for (Eigen::Index i = 0; i < places.cols(); ++i) {
      places.col(i) = in_box(allowed.moved[static_cast<std::size_t>(i)], places.col(i));
    }
    if (allows(allowed, places)) return places;
    Eigen::Matrix3Xd pushed = places;
    const auto push = [&](int lamp, const Eigen::Vector3d& other, double by, double forth) {
      const AllowedPlace& box = allowed.moved[static_cast<std::size_t>(lamp)];
      pushed.col(lamp) += by * way_apart(box, places.col(lamp), other, forth);
    };
    for_each_close(allowed, places, [&](int i, const Eigen::Vector3d& other, int j, double lack) {
      // A little more than what lacks, or the last micrometre would take many rounds.
      const double by = lack + place_tolerance;
      push(i, other, j < 0 ? by : 0.5 * by, 1.0);
      if (j >= 0) push(j, places.col(i), 0.5 * by, -1.0);
    });
    places = pushed;
  }
  return std::nullopt;
}

}  // namespace lightwell
