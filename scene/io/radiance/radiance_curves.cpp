// Generators that evaluate formulas: genrev, gensurf, genworm.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/io/radiance/radiance_expression.h"
#include "scene/io/radiance/radiance_generators.h"

namespace lightwell {
namespace {

constexpr int most_curve_polygons = 1'000'000;

void refuse_options(const RadianceCall& call, std::size_t first) {
  for (std::size_t i = first; i < call.words.size(); ++i) {
    if (call.words[i] == "-s") continue;  // smoothed normals
    call.fail(fmt::format(
        "the option '{}' is not read; write what it defines into the formulas themselves",
        call.words[i]));
  }
}

int segments(const RadianceCall& call, std::size_t word) {
  const RadianceExpression formula(call.words[word], {}, call.location);
  const double value = std::round(formula({}));
  if (!(value >= 1.0 && value <= most_curve_polygons)) {
    call.fail(
        fmt::format("the number of segments is {}; give from 1 to {}", value, most_curve_polygons));
  }
  return static_cast<int>(value);
}

// Samples a formula of t at 0, 1 / count, ..., 1.
std::vector<double> samples(const RadianceCall& call, std::size_t word, int count) {
  const RadianceExpression formula(call.words[word], {"t"}, call.location);
  std::vector<double> result;
  for (int i = 0; i <= count; ++i) {
    const double t = static_cast<double>(i) / count;
    result.push_back(formula({&t, 1}));
  }
  return result;
}

}  // namespace

// genrev: an outline revolved about the z axis. The front is to the right of the outline's
// direction in the (r, z) plane, z upwards and r to the right.
void run_genrev(const RadianceCall& call, const RadianceSink& sink) {
  call.require_words(6, "genrev material name 'z(t)' 'r(t)' segments");
  refuse_options(call, 6);
  constexpr int sides = 32;
  const int count = segments(call, 5);
  if (count > most_curve_polygons / sides) call.fail("makes too many polygons; use fewer segments");
  call.account(static_cast<std::int64_t>(count) * sides);
  const std::vector<double> z = samples(call, 3, count), r = samples(call, 4, count);
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
  refuse_options(call, 8);
  const int m = segments(call, 6), n = segments(call, 7);
  if (m > most_curve_polygons / n) {
    call.fail(fmt::format("makes more than {} polygons; use fewer segments", most_curve_polygons));
  }
  call.account(static_cast<std::int64_t>(m) * n);
  std::vector<RadianceExpression> formulas;
  for (std::size_t word = 3; word < 6; ++word) {
    formulas.emplace_back(call.words[word], std::vector<std::string>{"s", "t"}, call.location);
  }
  const auto row_at = [&](int i) {
    Loop row;
    for (int j = 0; j <= n; ++j) {
      const std::array<double, 2> st = {static_cast<double>(i) / m, static_cast<double>(j) / n};
      row.emplace_back(formulas[0](st), formulas[1](st), formulas[2](st));
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
  refuse_options(call, 8);
  const int count = segments(call, 7);
  call.account(count);
  const std::array<std::vector<double>, 3> xyz = {samples(call, 3, count), samples(call, 4, count),
                                                  samples(call, 5, count)};
  const std::vector<double> radius = samples(call, 6, count);
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
