#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/window/point_reading.h"
#include "viewer/window/solution_view.h"

namespace lightwell {

/// What the mouse asks of the scene: the light at a point that was clicked, at what the pointer is
/// over, and the distance between two points.
class PointerTools {
 public:
  /// What read_point() takes for names.
  explicit PointerTools(const Scene* scene, const JoinedSurfaces* names = nullptr)
      : scene_(scene), names_(names) {}

  // Places are pixels of the look's picture from the left and from the top.
  void click(const SolutionView& view, double x, double y);
  void hover(const SolutionView& view, double x, double y);
  void leave() { under_pointer_.reset(); }
  /// The probe that goes with the pointer, on or off.
  void switch_probe() { probing_ = !probing_; }
  bool is_probing() const { return probing_; }
  /// The next two clicks are the ends of what is measured; again: not.
  void switch_measuring();
  bool is_measuring() const { return measuring_; }
  /// Forgets what was clicked.
  void clear();
  /// Reads the same points again, since their light is another now. Forgets them where `same_mesh`
  /// is false.
  void light_changed(const SolutionView& view, bool same_mesh);

  const std::optional<PointReading>& reading() const { return reading_; }
  /// Between the points, m; nothing before both are there.
  std::optional<double> distance() const;
  /// What was clicked, in full.
  std::string panel(const SolutionView& view) const;
  /// What goes with the pointer.
  std::string beside_pointer(const SolutionView& view) const;
  /// Where marks belong.
  std::vector<Eigen::Vector3d> marks() const;

 private:
  PointReading read(const SolutionView& view, const VisibleHit& seen) const;

  const Scene* scene_;
  const JoinedSurfaces* names_;
  bool probing_ = false, measuring_ = false;
  VisibleHit clicked_{};
  std::optional<PointReading> reading_{}, under_pointer_{};
  std::vector<Eigen::Vector3d> measured_{};
};

}  // namespace lightwell
