#include "scene/io/radiance/patterns/radiance_place.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scene/io/radiance/patterns/radiance_function_file.h"

namespace lightwell {
namespace {

// Points of a box that are spread evenly: multiples of the powers of the root of x^4 = x + 1.
Eigen::Vector3d spread(int i) {
  constexpr double g = 1.2207440846057596;
  const Eigen::Vector3d x = (i + 0.5) * Eigen::Vector3d(1.0 / g, 1.0 / (g * g), 1.0 / (g * g * g));
  return x.unaryExpr([](double v) { return v - std::floor(v); });
}

}  // namespace

Spectrum mean_over(const RadiancePrimitive& pattern, const Eigen::AlignedBox3d& box,
                   const std::filesystem::path& folder) {
  const bool is_bright = pattern.type == "brightfunc";
  if (!is_bright && pattern.type != "colorfunc") pattern.fail("is no function of the position");
  if (box.isEmpty()) pattern.fail("is on no surface");
  const std::size_t file = is_bright ? 1 : 3;
  if (pattern.strings.size() <= file) pattern.fail("lacks a function or a file");
  const RadianceFunctionFile functions(pattern, pattern.strings[file], folder);
  std::vector<RadianceExpression> factors;
  for (std::size_t i = 0; i < file; ++i) {
    factors.push_back(functions.formula(pattern.strings[i], {"Px", "Py", "Pz", "Nx", "Ny", "Nz"}));
  }
  const Eigen::Affine3d to_local = pattern.frame.inverse();
  constexpr int points = 2048;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int i = 0; i < points; ++i) {
    const Eigen::Vector3d p = to_local * (box.min() + spread(i).cwiseProduct(box.sizes()));
    std::vector<double> values = {p.x(), p.y(), p.z(), 0.0, 0.0, 1.0};
    functions.append_arguments(values);
    for (int k = 0; k < 3; ++k) {
      const double value =
          factors[is_bright ? 0 : static_cast<std::size_t>(k)].value_or_nan(values);
      if (value > 0.0 && std::isfinite(value)) sum[k] += value;
    }
  }
  constexpr double digits = 1e3;
  return ((sum / points * digits).round() / digits).cast<float>();
}

Eigen::AlignedBox3d radiance_bounds(const RadiancePrimitive& p) {
  Eigen::AlignedBox3d box;
  const auto add = [&](std::size_t first, double radius) {
    if (p.reals.size() < first + 3) return;
    const Eigen::Vector3d at(p.reals[first], p.reals[first + 1], p.reals[first + 2]);
    box.extend(at - Eigen::Vector3d::Constant(radius));
    box.extend(at + Eigen::Vector3d::Constant(radius));
  };
  const double last = p.reals.empty() ? 0.0 : std::abs(p.reals.back());
  if (p.type == "polygon") {
    for (std::size_t i = 0; i < p.reals.size(); i += 3) add(i, 0.0);
  } else if (p.type == "sphere" || p.type == "bubble") {
    add(0, last);
  } else if (p.type == "ring") {
    add(0, std::max(last, p.reals.size() > 6 ? p.reals[6] : 0.0));
  } else if (p.kind() == RadianceKind::surface && p.type != "source") {
    add(0, last);
    add(3, last);
  }
  return box;
}

}  // namespace lightwell
