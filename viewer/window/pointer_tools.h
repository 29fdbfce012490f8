#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/window/point_reading.h"
#include "viewer/window/solution_view.h"

namespace lightwell {

/// Tools of the mouse: the light at a clicked point, the light under the pointer, and the distance
/// between two points.
class PointerTools {
 public:
  /// `scene` and `names` as read_point() takes them.
  explicit PointerTools(const Scene* scene, const JoinedSurfaces* names = nullptr)
      : scene_(scene), names_(names) {}

  // x and y are pixels of the look's picture, from the left and from the top.
  void click(const SolutionView& view, double x, double y);
  void hover(const SolutionView& view, double x, double y);
  void leave() { under_pointer_.reset(); }
  /// Switches the reading under the pointer on or off.
  void switch_probe() { probing_ = !probing_; }
  bool is_probing() const { return probing_; }
  /// Switches measuring on or off: two clicks are the ends of the distance.
  void switch_measuring();
  bool is_measuring() const { return measuring_; }
  /// Forgets all clicked points.
  void clear();
  /// Reads the clicked point again after a change of the light. Forgets the reading if `same_mesh`
  /// is false.
  void light_changed(const SolutionView& view, bool same_mesh);

  const std::optional<PointReading>& reading() const { return reading_; }
  /// Returns the distance between the two measured points, m; nothing before the second click.
  std::optional<double> distance() const;
  /// Text of the panel: the full reading of the clicked point, or the distance while measuring.
  std::string panel(const SolutionView& view) const;
  /// Text of the note beside the pointer; empty without a reading under the pointer.
  std::string beside_pointer(const SolutionView& view) const;
  /// Positions of the clicked points, m.
  std::vector<Eigen::Vector3d> marks() const;

 private:
  PointReading read(const SolutionView& view, const VisibleHit& seen);

  const Scene* scene_;
  const JoinedSurfaces* names_;
  std::optional<Eigen::ArrayXf> bounds_{};  ///< lx, per element; empty: not computed yet
  bool probing_ = false, measuring_ = false;
  VisibleHit clicked_{};
  std::optional<PointReading> reading_{}, under_pointer_{};
  std::vector<Eigen::Vector3d> measured_{};
};

}  // namespace lightwell
