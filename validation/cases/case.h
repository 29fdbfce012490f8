#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/progress.h"

namespace lightwell {

/// A computed value beside the expected one.
struct ComparedValue {
  std::string place{};  ///< "point C", "30 degrees"; empty: the case has one value
  double expected = 0.0, computed = 0.0;
  double tolerance = 0.0;  ///< bound of |computed - expected|, >= 0

  double error() const;
  bool passes() const { return error() <= tolerance; }
  /// Error over tolerance; 0 where both are 0.
  double share() const;
};

using ComparedValues = std::vector<ComparedValue>;

/// A figure of another program, or of a published table, for a value of a case.
struct PublishedValue {
  std::string place{};    ///< of the ComparedValue; empty: the only one
  std::string program{};  ///< "View3D 3.5", "CIE 171:2006, table 19"
  double value = 0.0;
  std::string source{};
  /// Reason why the figure is wrong, with the derivation; empty: it is not known to be wrong.
  std::string mistake{};
};

/// A case with a known answer.
struct ValidationCase {
  std::string id{}, group{}, title{};
  std::string unit{};    ///< of the values; empty: none
  std::string source{};  ///< of the expected values: a closed form or a stored number
  std::string reason{};  ///< of the tolerance
  std::string note{};    ///< parts of the case that are left out, and why
  std::vector<PublishedValue> published{};
  bool has_plot = false;  ///< pages show all of its values beside each other
  /// Computes all values. Throws Interrupted if `progress` says stop. Empty: the case cannot be
  /// run, and `note` has the reason.
  std::function<ComparedValues(const Progress& progress)> compute{};

  bool can_run() const { return static_cast<bool>(compute); }
};

}  // namespace lightwell
