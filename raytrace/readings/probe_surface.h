#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/gather/final_gather.h"
#include "raytrace/readings/probe.h"

namespace lightwell {

/// Search for the surface that a probe lies on, within a reach of 1e-4 of the scene's diagonal, but
/// at most 2 cm or 2e-6 of the diagonal.
class ProbeSurface {
 public:
  struct Found {
    ElementHit hit{};
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< on the surface
  };

  /// Keeps a reference.
  explicit ProbeSurface(const ElementCaster& caster);

  /// The surface point of a probe; empty if there is none. A probe on an edge, or where another
  /// surface stands on its own surface, is moved by a tenth of the reach to a point that lies
  /// clearly within its facet and in front of what stands there.
  std::optional<Found> find(const Probe& probe) const;
  /// The point at which a probe gathers light: on the surface that was found, or in the air. A
  /// point in the air less than a twentieth of the reach before a surface beside it, or about a
  /// tenth behind, is moved to a tenth of the reach before that surface, in a narrower gap to the
  /// middle. It stays on the back of a surface that separates two rooms.
  GatherPoint point(const Probe& probe, const std::optional<Found>& found) const;
  /// True if a surface shows its back to the probe, less than ten times the reach before it.
  bool is_behind_surface(const Probe& probe) const;

 private:
  struct Frame {
    Eigen::Vector3d normal, a{}, b{};  // a and b are tangent to the surface
  };

  std::optional<Found> below(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) const;
  bool is_inside(const Found& point_on_surface, const Eigen::Vector3d& position, const Frame& frame,
                 double radius) const;
  bool is_behind(const Eigen::Vector3d& position, const Eigen::Vector3d& way,
                 const Frame& frame) const;
  Eigen::Vector3d beside_surfaces(const Probe& probe) const;
  Eigen::Vector3d off_surface(const Eigen::Vector3d& at, const Eigen::Vector3d& way) const;
  bool faces_front(const Eigen::Vector3d& at, const Eigen::Vector3d& way, int facet) const;
  double room_before(const Eigen::Vector3d& at, const Eigen::Vector3d& normal, int facet) const;

  const ElementCaster& caster_;
  double reach_;  // m
};

/// The points at which probes gather light: on the surface that a probe lies on, or in the air.
std::vector<GatherPoint> probe_points(const ElementCaster& caster, std::span<const Probe> probes);

}  // namespace lightwell
