#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "scene/degree.h"
#include "scene/io/pictures/picture_mean.h"
#include "scene/io/pov/pov_language.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

using Numbers = std::vector<double>;
struct PovFunction {
  std::size_t arguments;
  double (*call)(const Numbers& a);
};

const std::map<std::string_view, PovFunction>& number_functions() {
  static const std::map<std::string_view, PovFunction> all = {
      {"abs", {1, [](const Numbers& a) { return std::abs(a[0]); }}},
      {"acos", {1, [](const Numbers& a) { return std::acos(a[0]); }}},
      {"acosh", {1, [](const Numbers& a) { return std::acosh(a[0]); }}},
      {"asin", {1, [](const Numbers& a) { return std::asin(a[0]); }}},
      {"asinh", {1, [](const Numbers& a) { return std::asinh(a[0]); }}},
      {"atan", {1, [](const Numbers& a) { return std::atan(a[0]); }}},
      {"atan2", {2, [](const Numbers& a) { return std::atan2(a[0], a[1]); }}},
      {"atanh", {1, [](const Numbers& a) { return std::atanh(a[0]); }}},
      {"ceil", {1, [](const Numbers& a) { return std::ceil(a[0]); }}},
      {"cos", {1, [](const Numbers& a) { return std::cos(a[0]); }}},
      {"cosh", {1, [](const Numbers& a) { return std::cosh(a[0]); }}},
      {"degrees", {1, [](const Numbers& a) { return a[0] / degree; }}},
      {"div", {2, [](const Numbers& a) { return std::trunc(a[0] / a[1]); }}},
      {"exp", {1, [](const Numbers& a) { return std::exp(a[0]); }}},
      {"floor", {1, [](const Numbers& a) { return std::floor(a[0]); }}},
      {"int", {1, [](const Numbers& a) { return std::trunc(a[0]); }}},
      {"ln", {1, [](const Numbers& a) { return std::log(a[0]); }}},
      {"log", {1, [](const Numbers& a) { return std::log10(a[0]); }}},
      {"mod", {2, [](const Numbers& a) { return std::fmod(a[0], a[1]); }}},
      {"pow", {2, [](const Numbers& a) { return std::pow(a[0], a[1]); }}},
      {"radians", {1, [](const Numbers& a) { return a[0] * degree; }}},
      {"sin", {1, [](const Numbers& a) { return std::sin(a[0]); }}},
      {"sinh", {1, [](const Numbers& a) { return std::sinh(a[0]); }}},
      {"sqr", {1, [](const Numbers& a) { return a[0] * a[0]; }}},
      {"sqrt", {1, [](const Numbers& a) { return std::sqrt(a[0]); }}},
      {"tan", {1, [](const Numbers& a) { return std::tan(a[0]); }}},
      {"tanh", {1, [](const Numbers& a) { return std::tanh(a[0]); }}},
  };
  return all;
}

constexpr std::array<std::string_view, 26> other_functions = {
    "min",        "max",        "select",  "vdot",         "vcross",
    "vlength",    "vnormalize", "vrotate", "vaxis_rotate", "rand",
    "seed",       "asc",        "strlen",  "strcmp",       "val",
    "concat",     "str",        "chr",     "substr",       "strlwr",
    "strupr",     "vstr",       "defined", "dimensions",   "dimension_size",
    "file_exists"};

constexpr std::size_t longest_string = 65'536;

PovVector vector_of(const Eigen::Vector3d& v) {
  return {.c = {v.x(), v.y(), v.z()}, .count = 3};
}

PovVector number_of(double value) {
  return {.c = {value}};
}

/// Arguments of a call, with messages for those that are of another kind.
struct Given {
  const std::vector<PovValue>& values;
  std::string_view name;
  const PovPlace& place;

  void require(std::size_t least, std::size_t most) const {
    if (values.size() >= least && values.size() <= most) return;
    place.fail(fmt::format("'{}' has {} arguments; it needs {}", name, values.size(), least));
  }
  const PovVector& vector(std::size_t i) const {
    const auto* found = i < values.size() ? std::get_if<PovVector>(&values[i]) : nullptr;
    if (!found) place.fail(fmt::format("argument {} of '{}' is no number or vector", i + 1, name));
    return *found;
  }
  double number(std::size_t i) const { return vector(i).c[0]; }
  Eigen::Vector3d point(std::size_t i) const { return pov_point(vector(i)); }
  const std::string& text(std::size_t i) const {
    const auto* found = i < values.size() ? std::get_if<std::string>(&values[i]) : nullptr;
    if (!found) place.fail(fmt::format("argument {} of '{}' is no string", i + 1, name));
    return *found;
  }
};

// `length` and `digits` as for printf's "%*.*f"; a negative length fills with zeros.
std::string shown_number(double value, double length, double digits) {
  constexpr double most = 50.0;
  const int wide = static_cast<int>(std::clamp(length, -most, most));
  const int places = digits < 0.0 ? 6 : static_cast<int>(std::min(digits, most));
  return wide < 0 ? fmt::format("{:0{}.{}f}", value, -wide, places)
                  : fmt::format("{:{}.{}f}", value, wide, places);
}

std::optional<PovValue> vector_function(const Given& given) {
  const std::string_view name = given.name;
  if (name == "vdot") return number_of(given.point(0).dot(given.point(1)));
  if (name == "vlength") return number_of(given.point(0).norm());
  if (name == "vcross") return vector_of(given.point(0).cross(given.point(1)));
  if (name == "vnormalize") return vector_of(given.point(0).normalized());
  if (name == "vrotate") {
    const Eigen::Vector3d turn = degree * given.point(1);
    const Eigen::Matrix3d all = (Eigen::AngleAxisd(turn.z(), Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(turn.y(), Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(turn.x(), Eigen::Vector3d::UnitX()))
                                    .toRotationMatrix();
    return vector_of(all * given.point(0));
  }
  if (name == "vaxis_rotate") {
    const Eigen::Vector3d axis = given.point(1);
    if (!(axis.norm() > 0.0)) given.place.fail("'vaxis_rotate' has an axis without length");
    return vector_of(Eigen::AngleAxisd(degree * given.number(2), axis.normalized()) *
                     given.point(0));
  }
  return std::nullopt;
}

std::optional<PovValue> string_function(const Given& given) {
  const std::string_view name = given.name;
  if (name == "asc") {
    return number_of(given.text(0).empty() ? 0.0 : static_cast<unsigned char>(given.text(0)[0]));
  }
  if (name == "strlen") return number_of(static_cast<double>(given.text(0).size()));
  if (name == "strcmp") return number_of(given.text(0).compare(given.text(1)));
  if (name == "val") return number_of(parse_finite(trimmed(given.text(0))).value_or(0.0));
  if (name == "chr") {
    return std::string(1, static_cast<char>(std::clamp(given.number(0), 1.0, 127.0)));
  }
  if (name == "str") return shown_number(given.number(0), given.number(1), given.number(2));
  if (name == "concat") {
    std::string all;
    for (std::size_t i = 0; i < given.values.size(); ++i) {
      all += given.text(i);
      if (all.size() > longest_string) {
        given.place.fail_limit(fmt::format("a string has more than {} bytes", longest_string));
      }
    }
    return all;
  }
  if (name == "substr") {
    const double first = given.number(1), length = given.number(2);
    const auto size = static_cast<double>(given.text(0).size());
    if (!(first >= 1.0 && length >= 0.0 && first - 1.0 + length <= size)) {
      given.place.fail("'substr' reaches beyond the ends of its string");
    }
    return given.text(0).substr(static_cast<std::size_t>(first) - 1,
                                static_cast<std::size_t>(length));
  }
  if (name == "strlwr" || name == "strupr") {
    std::string text = given.text(0);
    for (char& c : text) {
      if (name == "strlwr" && c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
      if (name == "strupr" && c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    }
    return text;
  }
  if (name != "vstr") return std::nullopt;
  given.require(5, 5);
  std::string all;
  const int count = std::clamp(static_cast<int>(given.number(0)), 1, 5);
  for (int i = 0; i < count; ++i) {
    if (i > 0) all += given.text(2);
    all += shown_number(given.vector(1).c[static_cast<std::size_t>(i)], given.number(3),
                        given.number(4));
  }
  return all;
}

PovValue extreme(const Given& given) {
  given.require(1, 100);
  double best = given.number(0);
  for (std::size_t i = 1; i < given.values.size(); ++i) {
    best = given.name == "min" ? std::min(best, given.number(i)) : std::max(best, given.number(i));
  }
  return number_of(best);
}

// The second value below 0, the third at 0, the last above; without a fourth, the third from 0 up.
PovValue selected(const Given& given) {
  given.require(3, 4);
  const double by = given.number(0);
  if (by < 0.0) return given.values[1];
  return by == 0.0 || given.values.size() == 3 ? given.values[2] : given.values[3];
}

}  // namespace

bool is_pov_function(std::string_view word) {
  return number_functions().contains(word) ||
         std::ranges::find(other_functions, word) != other_functions.end();
}

std::vector<PovValue> PovLanguage::arguments() {
  const int outer = std::exchange(vector_depth_, 0);
  std::vector<PovValue> values;
  need("(");
  while (!take(")")) {
    values.push_back(expression());
    if (!take(",") && !peek().is_sign(")")) need(")");
  }
  vector_depth_ = outer;
  return values;
}

std::optional<PovValue> PovLanguage::built_in(std::string_view name) {
  if (!is_pov_function(name)) return std::nullopt;
  if (name == "defined") {
    need("(");
    const bool is_there = is_declared(next().text);
    need(")");
    return number_of(is_there ? 1.0 : 0.0);
  }
  const std::vector<PovValue> values = arguments();
  const PovPlace at = place();
  const Given given{.values = values, .name = name, .place = at};
  const auto simple = number_functions().find(name);
  if (simple != number_functions().end()) {
    given.require(simple->second.arguments, simple->second.arguments);
    Numbers numbers;
    for (std::size_t i = 0; i < values.size(); ++i) numbers.push_back(given.number(i));
    const double result = simple->second.call(numbers);
    if (!std::isfinite(result)) {
      at.fail(fmt::format("'{}' has no finite value for {:g}", name, numbers[0]));
    }
    return number_of(result);
  }
  if (name == "min" || name == "max") return extreme(given);
  if (name == "select") return selected(given);
  if (name == "rand") return random(given.number(0));
  if (name == "seed") {
    spend();
    streams_.push_back(static_cast<std::uint32_t>(
        static_cast<std::int64_t>(std::clamp(given.number(0), -1e15, 1e15))));
    return number_of(static_cast<double>(streams_.size() - 1));
  }
  if (name == "file_exists") {
    return number_of(is_file(frames_.front().text->path().parent_path() / given.text(0)) ? 1 : 0);
  }
  if (name == "dimensions" || name == "dimension_size") {
    const auto* array =
        values.empty() ? nullptr : std::get_if<std::shared_ptr<PovArray>>(&values[0]);
    if (!array) at.fail(fmt::format("'{}' needs an array", name));
    const auto& sizes = (*array)->sizes;
    if (name == "dimensions") return number_of(static_cast<double>(sizes.size()));
    const double which = given.number(1);
    if (!(which >= 1.0 && which <= static_cast<double>(sizes.size()))) {
      at.fail("'dimension_size' names a dimension that the array lacks");
    }
    return number_of(static_cast<double>(sizes[static_cast<std::size_t>(which) - 1]));
  }
  if (auto value = vector_function(given)) return value;
  auto text = string_function(given);
  if (const auto* made = text ? std::get_if<std::string>(&*text) : nullptr) {
    constexpr std::size_t bytes_per_step = 16;
    spend(static_cast<std::int64_t>(made->size() / bytes_per_step));
  }
  if (!text) at.fail(fmt::format("the function '{}' is not known here", name));
  return text;
}

// A linear congruence modulo 2^32 (Knuth, The Art of Computer Programming, 3.2.1).
PovValue PovLanguage::random(double stream) {
  if (!(stream >= 0.0 && stream < static_cast<double>(streams_.size()))) {
    place().fail("'rand' has no stream; declare one by seed()");
  }
  std::uint32_t& state = streams_[static_cast<std::size_t>(stream)];
  constexpr std::uint32_t factor = 1812433253u, addend = 12345u;
  state = state * factor + addend;
  return number_of(static_cast<double>(state) / 4294967295.0);
}

PovValue PovLanguage::call_function(const Routine& function, std::string_view name) {
  const std::vector<PovValue> values = arguments();
  if (values.size() != function.parameters.size()) {
    place().fail(fmt::format("the function '{}' has {} parameters, and is called with {}",
                             excerpt(name), function.parameters.size(), values.size()));
  }
  put_back();
  Frame frame{
      .text = function.text, .at = function.begin, .end = function.end, .is_function = true};
  for (std::size_t i = 0; i < values.size(); ++i) {
    frame.locals.insert_or_assign(function.parameters[i], values[i]);
  }
  push(std::move(frame));
  const int outer = std::exchange(vector_depth_, 0);
  PovValue value = expression();
  vector_depth_ = outer;
  if (peek().kind != PovToken::Kind::end) {
    place().fail(fmt::format("the function '{}' is no single expression", excerpt(name)));
  }
  ahead_.reset();
  frames_.pop_back();
  return value;
}

// `value` is sRGB; the result is in the power law of the scene's colours.
double PovLanguage::from_srgb(double value) const {
  const double linear = value > 0.0 && value < 1.0 ? linear_from_srgb(value) : value;
  return linear > 0.0 ? std::pow(linear, 1.0 / gamma_) : linear;
}

}  // namespace lightwell
