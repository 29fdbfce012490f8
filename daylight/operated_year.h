#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "daylight/window_operation.h"
#include "daylight/window_plan.h"
#include "daylight/year.h"

namespace lightwell {

/// A computation of the year, in some states of the windows.
struct ComputedYear {
  std::size_t number = 0;      ///< of WindowPlan::computations
  const DaylightModel& model;  ///< of the scene in these states
  double error = 0.0;          ///< see year_error()
};

/// Receives a computation of the year, a block of hours at a time.
using VisitYear = std::function<void(const ComputedYear&, const HourBlock&)>;

/// A year with operated windows.
struct OperatedYear {
  Eigen::ArrayXXi states{};  ///< groups x hours
  WindowPlan plan{};
  std::vector<double> errors{};  ///< of each computation, see year_error()
  /// Error of superposition with all groups changed: root mean square over sensors of superposed
  /// less computed light (without sunlight), relative to the light with all groups in their first
  /// state, in the mean of the year. 0: nothing is superposed.
  double superposition = 0.0;
  Eigen::ArrayXf daylight_factor{};  ///< with all groups in their first state
  /// Light of all hours, lx, sensors x hours; empty without windows, where the one computation has
  /// it already.
  Eigen::ArrayXXf total{}, sunlight{};

  /// Bound of the error of each hour's operated light, in the terms of year_error(); empty without
  /// windows. Computed light has the bound of its computation. Superposed light has the bounds of
  /// its parts, as of independent errors, relative to the sum of the parts, and besides what
  /// superposition leaves out with all groups changed in this hour, relative to the hour's own
  /// light. That is taken whole, since two groups that face each other may leave out all of it. An
  /// hour whose superposed light is no more than nothing has 1.
  std::vector<double> hour_errors{};
  /// Bound of the error of the year's light: the mean of the hours' bounds, weighted by their light
  /// without sunlight.
  double error() const;
  /// Calls `visit` with the light of `hours`, those of the year, in blocks.
  void visit(std::span<const SkyHour> hours,
             const std::function<void(const HourBlock&)>& visit) const;
};

/// Computes the year once for each computation of the plan (one model at a time is in memory beside
/// `open`, that of all groups in their first state, which has the sensors), and puts the operated
/// year together. `scene` is that of `open` as it was read. Throws what operate_windows() and
/// plan_computations() throw.
OperatedYear operate_year(const Scene& scene, const DaylightModel& open,
                          const OperatedWindows& windows, const OperationTask& task,
                          const VisitYear& visit);

}  // namespace lightwell
