#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scene/io/radiance/text/radiance_primitive.h"

namespace lightwell {

/// A formula of a generator, such as "1+.05*sin(PI*t)": numbers, + - * / ^, parentheses, PI, the
/// functions of RADIANCE's calculator, and hermite, bezier and bspline. As in RADIANCE, a sign
/// binds tighter than a power (-2^2 is 4) and powers group from the right.
class RadianceExpression {
 public:
  /// Throws InputError naming the place if the text is no formula of these variables.
  RadianceExpression(const std::string& text, const std::vector<std::string>& variables,
                     const RadianceLocation& location)
      : RadianceExpression(text, text, variables, location) {}
  /// A formula that messages call `shown`: definitions of a file, which may be no formulas at all,
  /// are not quoted.
  RadianceExpression(const std::string& text, const std::string& shown,
                     const std::vector<std::string>& variables, const RadianceLocation& location);
  ~RadianceExpression();
  RadianceExpression(RadianceExpression&&) noexcept;

  /// Value of the formula for `values` of the variables, in their order; throws InputError if not
  /// finite.
  double operator()(std::span<const double> values) const;
  /// Value of the formula, NaN where evaluation fails; for formulas that are only tried.
  double value_or_nan(std::span<const double> values) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
