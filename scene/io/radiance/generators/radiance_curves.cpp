// Generators that evaluate formulas: genrev, gensurf, genworm.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/io/radiance/generators/radiance_generators.h"
#include "scene/io/radiance/text/radiance_definitions.h"
#include "scene/io/radiance/text/radiance_expression.h"

namespace lightwell {
namespace {

constexpr int most_curve_polygons = 1'000'000;

// The formulas of a call, with the definitions that its options from word `first` on make: -e holds
// definitions, -f names a file of them, and -s asks for smooth normals.
class Formulas {
 public:
  Formulas(const RadianceCall& call, std::size_t first) : call_(call) {
    for (std::size_t i = first; i < call.words.size(); ++i) {
      const std::string& option = call.words[i];
      if (option == "-s") continue;
      if (option != "-e" && option != "-f") {
        call.fail(fmt::format("the option '{}' is not read; known are -e, -f and -s", option));
      }
      if (i + 1 == call.words.size()) {
        call.fail(fmt::format("the option '{}' lacks what it defines", option));
      }
      const std::string& given = call.words[++i];
      definitions_.add(option == "-e" ? given : call.open(given).text(), call.location);
    }
  }

  RadianceExpression formula(std::size_t word, const std::vector<std::string>& variables) const {
    return {definitions_.expanded(call_.words[word], call_.location), call_.words[word], variables,
            call_.location};
  }

  int segments(std::size_t word) const {
    const double value = std::round(formula(word, {})({}));
    if (!(value >= 1.0 && value <= most_curve_polygons)) {
      call_.fail(fmt::format("the number of segments is {}; give from 1 to {}", value,
                             most_curve_polygons));
    }
    return static_cast<int>(value);
  }

  // Samples a formula of t at 0, 1 / count, ..., 1.
  std::vector<double> samples(std::size_t word, int count) const {
    const RadianceExpression of_t = formula(word, {"t"});
    std::vector<double> result;
    for (int i = 0; i <= count; ++i) {
      const double t = static_cast<double>(i) / count;
      result.push_back(of_t({&t, 1}));
    }
    return result;
  }

 private:
  const RadianceCall& call_;
  RadianceDefinitions definitions_;
};

}  // namespace

// genrev: an outline revolved about the z axis. The front is to the right of the outline's
// direction in the (r, z) plane, z upwards and r to the right.
void run_genrev(const RadianceCall& call, const RadianceSink& sink) {
  call.require_words(6, "genrev material name 'z(t)' 'r(t)' segments");
  const Formulas formulas(call, 6);
  constexpr int sides = 32;
  const int count = formulas.segments(5);
  if (count > most_curve_polygons / sides) call.fail("makes too many polygons; use fewer segments");
  call.account(static_cast<std::int64_t>(count) * sides);
  const std::vector<double> z = formulas.samples(3, count), r = formulas.samples(4, count);
  if (!(*std::ranges::min_element(r) >= 0.0)) {
    call.fail(fmt::format("the radius '{}' is negative somewhere", call.words[4]));
  }
  // Cross-sections are polygons with the circumference of the circle, so that cylinders keep their
  // area.
  const double half = std::numbers::pi / sides, outside = half / std::sin(half);
  const auto point = [&](std::size_t i, int side) -> Eigen::Vector3d {
    const double angle = 2.0 * half * (side % sides);
    return {outside * r[i] * std::cos(angle), outside * r[i] * std::sin(angle), z[i]};
  };
  GeneratedPolygons polygons(call, sink);
  for (std::size_t i = 0; i + 1 < z.size(); ++i) {
    for (int side = 0; side < sides; ++side) {
      Loop loop = {point(i, side)};
      if (r[i] > 0.0) loop.push_back(point(i, side + 1));
      loop.push_back(point(i + 1, side + 1));
      if (r[i + 1] > 0.0) loop.push_back(point(i + 1, side));
      if (loop.size() > 2) polygons.add(loop);
    }
  }
}

void run_gensurf(const RadianceCall& call, const RadianceSink& sink) {
  call.require_words(8, "gensurf material name 'x(s,t)' 'y(s,t)' 'z(s,t)' m n");
  const Formulas formulas(call, 8);
  const int m = formulas.segments(6), n = formulas.segments(7);
  if (m > most_curve_polygons / n) {
    call.fail(fmt::format("makes more than {} polygons; use fewer segments", most_curve_polygons));
  }
  call.account(static_cast<std::int64_t>(m) * n);
  std::vector<RadianceExpression> xyz;
  for (std::size_t word = 3; word < 6; ++word) xyz.push_back(formulas.formula(word, {"s", "t"}));
  const auto row_at = [&](int i) {
    Loop row;
    for (int j = 0; j <= n; ++j) {
      const std::array<double, 2> st = {static_cast<double>(i) / m, static_cast<double>(j) / n};
      row.emplace_back(xyz[0](st), xyz[1](st), xyz[2](st));
    }
    return row;
  };
  GeneratedPolygons polygons(call, sink);
  Loop row = row_at(0);
  for (int i = 0; i < m; ++i) {
    Loop next = row_at(i + 1);
    for (std::size_t j = 0; j + 1 < row.size(); ++j) {
      const auto &a = row[j], &b = next[j], &c = next[j + 1], &d = row[j + 1];
      const Loop square = {a, b, c, d};
      if (!is_thin(square) && deviation_from_plane({square}) <= flatness) {
        polygons.add(square);
      } else if (j % 2 == 1) {  // alternating diagonals follow a curve on both sides
        polygons.add({a, b, d});
        polygons.add({d, b, c});
      } else {
        polygons.add({b, c, a});
        polygons.add({a, c, d});
      }
    }
    row = std::move(next);
  }
}

// genworm: spheres along a curve and, between each two, the cone tangent to both.
void run_genworm(const RadianceCall& call, const RadianceSink& sink) {
  call.require_words(8, "genworm material name 'x(t)' 'y(t)' 'z(t)' 'r(t)' segments");
  const Formulas formulas(call, 8);
  const int count = formulas.segments(7);
  call.account(count);
  const std::array<std::vector<double>, 3> xyz = {
      formulas.samples(3, count), formulas.samples(4, count), formulas.samples(5, count)};
  const std::vector<double> radius = formulas.samples(6, count);
  if (!(*std::ranges::min_element(radius) >= 0.0)) {
    call.fail(fmt::format("the radius '{}' is negative somewhere", call.words[6]));
  }
  RadiancePrimitive p{.modifier = call.words[1], .location = call.location};
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < radius.size(); ++i) {
    const Eigen::Vector3d center(xyz[0][i], xyz[1][i], xyz[2][i]);
    const double r = radius[i];
    const double length = (center - last).norm();
    // A sphere inside its neighbour has no tangent cone.
    const double slope = i > 0 && length > 0.0 ? (radius[i - 1] - r) / length : 1.0;
    if (i > 0 && std::abs(slope) < 1.0) {
      const Eigen::Vector3d axis = (center - last) / length;
      const Eigen::Vector3d from = last + slope * radius[i - 1] * axis;
      const Eigen::Vector3d to = center + slope * r * axis;
      const double shrink = std::sqrt(1.0 - slope * slope);
      p.type = "cone";
      p.name = fmt::format("{}.c{}", call.words[2], i);
      p.reals = {from.x(),  from.y(), from.z(), to.x(), to.y(), to.z(), shrink * radius[i - 1],
                 shrink * r};
      sink(p);
    }
    p.type = "sphere";
    p.name = fmt::format("{}.s{}", call.words[2], i);
    p.reals = {center.x(), center.y(), center.z(), r};
    sink(p);
    last = center;
  }
}

}  // namespace lightwell
