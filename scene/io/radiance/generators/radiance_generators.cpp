#include "scene/io/radiance/generators/radiance_generators.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace lightwell {
namespace {

using Generator = void (*)(const RadianceCall&, const RadianceSink&);

const std::map<std::string, Generator, std::less<>>& generators() {
  static const std::map<std::string, Generator, std::less<>> table = {
      {"genbox", run_genbox}, {"genprism", run_genprism}, {"genblinds", run_genblinds},
      {"genrev", run_genrev}, {"gensurf", run_gensurf},   {"genworm", run_genworm}};
  return table;
}

}  // namespace

void RadianceCall::fail(std::string_view problem) const {
  location.fail(fmt::format("{}: {}", words[0], problem));
}

double RadianceCall::number(std::size_t i, std::string_view what) const {
  if (i >= words.size()) fail(fmt::format("lacks the {}", what));
  const auto value = parse_finite(words[i]);
  if (!value) fail(fmt::format("the {} is '{}', which is not a finite number", what, words[i]));
  return *value;
}

double RadianceCall::positive(std::size_t i, std::string_view what) const {
  const double value = number(i, what);
  if (!(value > 0.0)) fail(fmt::format("the {} is {}; it must be positive", what, value));
  return value;
}

int RadianceCall::count(std::size_t i, std::string_view what) const {
  const double value = number(i, what);
  constexpr double most = 100'000;
  if (!(value >= 1.0 && value <= most) || value != std::floor(value)) {
    fail(fmt::format("the {} is {}; give a whole number from 1 to {}", what, words[i], most));
  }
  return static_cast<int>(value);
}

void RadianceCall::require_words(std::size_t least, std::string_view usage) const {
  if (words.size() < least) {
    fail(fmt::format("has {} arguments, too few; write '{}'", words.size() - 1, usage));
  }
}

GeneratedPolygons::GeneratedPolygons(const RadianceCall& call, const RadianceSink& sink)
    : sink_(sink),
      polygon_{.modifier = call.words[1], .type = "polygon", .location = call.location},
      name_(call.words[2]) {}

void GeneratedPolygons::add(const Loop& loop) {
  if (is_thin(loop)) return;
  polygon_.name = fmt::format("{}.{}", name_, ++count_);
  polygon_.reals.clear();
  for (const Eigen::Vector3d& p : loop) {
    polygon_.reals.insert(polygon_.reals.end(), {p.x(), p.y(), p.z()});
  }
  sink_(polygon_);
}

bool is_radiance_generator(std::string_view program) {
  return generators().contains(program);
}

void run_radiance_generator(const RadianceCall& call, const RadianceSink& sink) {
  generators().find(call.words[0])->second(call, sink);
}

}  // namespace lightwell
