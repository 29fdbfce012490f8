#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scene/io/radiance/radiance_primitive.h"

namespace lightwell {

/// A formula of a generator, such as "1+.05*sin(PI*t)": numbers, + - * / ^, parentheses, PI, the
/// functions of RADIANCE's calculator, and hermite, bezier and bspline. As there, a sign binds
/// tighter than a power (-2^2 is 4) and powers group from the right.
class RadianceExpression {
 public:
  /// Throws InputError naming the place if the text is no formula of these variables.
  RadianceExpression(const std::string& text, const std::vector<std::string>& variables,
                     const RadianceLocation& location);
  ~RadianceExpression();
  RadianceExpression(RadianceExpression&&) noexcept;

  /// Its value where the variables, in their order, have these values; finite, or InputError.
  double operator()(std::span<const double> values) const;
  /// The same, or not a number, for formulas that are only tried.
  double value_or_nan(std::span<const double> values) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
