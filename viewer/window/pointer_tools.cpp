#include "viewer/window/pointer_tools.h"

#include <fmt/format.h>

#include <cmath>

#include "radiosity/refine/illuminance_bound.h"

namespace lightwell {
namespace {

ShownUnits units_of(const RadiositySolution& solution) {
  return {solution.metres_per_unit, solution.unit_name, solution.relative_units};
}

VisibleHit look_at(const SolutionView& view, double x, double y) {
  return visible_hit_at_pixel(view.caster(), view.kinds(), view.look().camera, x, y,
                              {.unlit = view.look().unlit});
}

}  // namespace

PointReading PointerTools::read(const SolutionView& view, const VisibleHit& seen) {
  const SolvedScene& solved = view.solved();
  PointReading reading =
      read_point(solved.mesh, solved.solution.bands, view.irradiance(), scene_, seen, names_);
  if (!bounds_) bounds_ = illuminance_bounds(solved.mesh, solved.solution);
  if (reading.element < bounds_->size()) reading.lux_within = (*bounds_)[reading.element];
  return reading;
}

void PointerTools::click(const SolutionView& view, double x, double y) {
  const VisibleHit seen = look_at(view, x, y);
  if (measuring_) {
    if (!seen) return;
    if (measured_.size() > 1) measured_.clear();
    measured_.push_back(seen.position);
    return;
  }
  clicked_ = seen;
  reading_.reset();
  if (seen) reading_ = read(view, seen);
}

void PointerTools::hover(const SolutionView& view, double x, double y) {
  under_pointer_.reset();
  if (!probing_) return;
  if (const VisibleHit seen = look_at(view, x, y)) under_pointer_ = read(view, seen);
}

void PointerTools::switch_measuring() {
  measuring_ = !measuring_;
  measured_.clear();
}

void PointerTools::clear() {
  reading_.reset();
  measured_.clear();
  clicked_ = {};
}

void PointerTools::light_changed(const SolutionView& view, bool same_mesh) {
  under_pointer_.reset();
  bounds_.reset();
  if (!same_mesh) {
    reading_.reset();
    clicked_ = {};
  } else if (reading_) {
    reading_ = read(view, clicked_);
  }
}

std::optional<double> PointerTools::distance() const {
  if (measured_.size() < 2) return {};
  return (measured_[1] - measured_[0]).norm();
}

std::string PointerTools::panel(const SolutionView& view) const {
  const RadiositySolution& solution = view.solved().solution;
  if (measuring_) {
    const auto length = distance();
    if (!length) {
      return measured_.empty() ? "measuring: click the first point"
                               : "measuring: click the second point";
    }
    const double scale = solution.metres_per_unit;
    // A component that is 0 up to the rounding of rays is shown as 0.
    const Eigen::Vector3d way = (measured_[1] - measured_[0]).unaryExpr([&](double along) {
      return std::abs(along) < 1e-6 * *length ? 0.0 : along / scale;
    });
    return fmt::format("distance {:.5g} {}\nalong x, y, z  {:.4g}, {:.4g}, {:.4g}", *length / scale,
                       solution.unit_name, way.x(), way.y(), way.z());
  }
  return reading_ ? full_text(*reading_, solution.bands, units_of(solution)) : "";
}

std::string PointerTools::beside_pointer(const SolutionView& view) const {
  return under_pointer_ ? short_text(*under_pointer_, units_of(view.solved().solution)) : "";
}

std::vector<Eigen::Vector3d> PointerTools::marks() const {
  if (measuring_) return measured_;
  return reading_ ? std::vector{reading_->position} : std::vector<Eigen::Vector3d>{};
}

}  // namespace lightwell
