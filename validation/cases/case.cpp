#include "validation/cases/case.h"

#include <cmath>
#include <limits>

namespace lightwell {

double ComparedValue::error() const {
  const double error = std::abs(computed - expected);
  return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

double ComparedValue::share() const {
  const double off = error();
  if (off == 0.0) return 0.0;
  return tolerance > 0.0 ? off / tolerance : std::numeric_limits<double>::infinity();
}

}  // namespace lightwell
