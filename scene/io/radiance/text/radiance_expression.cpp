#include "scene/io/radiance/text/radiance_expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace lightwell {
namespace {

double chosen(double condition, double yes, double no) {
  return condition > 0.0 ? yes : no;
}

// select(n, x1, x2, ...) is the n-th of the x.
double selected(const double* x, int count) {
  const double n = std::round(x[0]);
  return n >= 1.0 && n < count ? x[static_cast<int>(n)] : std::nan("");
}

// Number in [0,1) by a cell of a lattice; the mixing steps of SplitMix64.
double at_cell(double x, double y, double z) {
  std::uint64_t h = 0;
  for (const double v : {x, y, z}) {
    h += static_cast<std::uint64_t>(static_cast<std::int64_t>(std::clamp(v, -9e15, 9e15))) +
         0x9e3779b97f4a7c15ull;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
    h ^= h >> 31;
  }
  return static_cast<double>(h >> 11) * 0x1p-53;
}

// Smooth noise in [-1,1] with the mean 0, random at whole coordinates. The values differ from those
// of RADIANCE, whose statistics are alike.
double noise3(double x, double y, double z) {
  const double x0 = std::floor(x), y0 = std::floor(y), z0 = std::floor(z);
  const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double u = smooth(x - x0), v = smooth(y - y0), w = smooth(z - z0);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    sum += (i ? u : 1.0 - u) * (j ? v : 1.0 - v) * (k ? w : 1.0 - w) *
           (2.0 * at_cell(x0 + i, y0 + j, z0 + k) - 1.0);
  }
  return sum;
}

// Noise of several sizes: each half as large and half as strong as the one before.
double fnoise3(double x, double y, double z) {
  double sum = 0.0;
  constexpr int octaves = 6;
  for (int i = 0; i < octaves; ++i) {
    sum += std::ldexp(noise3(std::ldexp(x, i), std::ldexp(y, i), std::ldexp(z, i)), -i - 1);
  }
  return sum;
}

// Cubic curves over t in [0,1] by their control values; Foley et al. 1990, section 11.2.
double hermite(double p0, double p1, double r0, double r1, double t) {
  return p0 * ((2 * t - 3) * t * t + 1) + p1 * (3 - 2 * t) * t * t + r0 * ((t - 2) * t + 1) * t +
         r1 * (t - 1) * t * t;
}

double bezier(double p1, double p2, double p3, double p4, double t) {
  const double s = 1 - t;
  return p1 * s * s * s + 3 * p2 * t * s * s + 3 * p3 * t * t * s + p4 * t * t * t;
}

double bspline(double p1, double p2, double p3, double p4, double t) {
  const double s = 1 - t;
  return (p1 * s * s * s + p2 * ((3 * t - 6) * t * t + 4) + p3 * (((3 - 3 * t) * t + 3) * t + 1) +
          p4 * t * t * t) /
         6;
}

void define_operators(mu::Parser& parser) {
  parser.EnableBuiltInOprt(false);
  parser.ClearInfixOprt();
  parser.ClearPostfixOprt();
  parser.ClearConst();
  parser.ClearFun();
  constexpr int sum = 1, product = 2, power = 3, sign = 4;
  parser.DefineOprt(
      "+", [](double a, double b) { return a + b; }, sum);
  parser.DefineOprt(
      "-", [](double a, double b) { return a - b; }, sum);
  parser.DefineOprt(
      "*", [](double a, double b) { return a * b; }, product);
  parser.DefineOprt(
      "/", [](double a, double b) { return a / b; }, product);
  parser.DefineOprt(
      "^", [](double a, double b) { return std::pow(a, b); }, power, mu::oaRIGHT);
  parser.DefineInfixOprt(
      "-", [](double a) { return -a; }, sign);
  parser.DefineInfixOprt(
      "+", [](double a) { return a; }, sign);
}

void define_functions(mu::Parser& parser) {
  using One = double (*)(double);
  const std::initializer_list<std::pair<const char*, One>> functions = {
      {"sin", std::sin},   {"cos", std::cos},     {"tan", std::tan},     {"asin", std::asin},
      {"acos", std::acos}, {"atan", std::atan},   {"exp", std::exp},     {"log", std::log},
      {"sqrt", std::sqrt}, {"log10", std::log10}, {"floor", std::floor}, {"ceil", std::ceil},
      {"abs", std::abs}};
  for (const auto& [name, function] : functions) parser.DefineFun(name, function);
  parser.DefineFun("atan2", [](double y, double x) { return std::atan2(y, x); });
  parser.DefineFun("min", [](const double* x, int n) { return *std::min_element(x, x + n); });
  parser.DefineFun("max", [](const double* x, int n) { return *std::max_element(x, x + n); });
  parser.DefineFun("select", selected);
  parser.DefineFun("noise3", noise3);
  parser.DefineFun("fnoise3", fnoise3);
  parser.DefineFun("rand", [](double x) { return at_cell(std::round(x * 1e6), 0.0, 0.0); });
  parser.DefineFun("sq", [](double x) { return x * x; });
  parser.DefineFun("if", chosen);
  parser.DefineFun("hermite", hermite);
  parser.DefineFun("bezier", bezier);
  parser.DefineFun("bspline", bspline);
  parser.DefineConst("PI", std::numbers::pi);
}

// Beginning of a formula, short enough for a message.
std::string beginning(const std::string& text) {
  constexpr std::size_t longest = 80;
  return text.size() <= longest ? text : std::string(text, 0, longest).append("...");
}

}  // namespace

struct RadianceExpression::Impl {
  mu::Parser parser;
  std::vector<double> values;  // storage of the parser's variables
  std::string text;
  RadianceLocation location;
};

RadianceExpression::RadianceExpression(const std::string& text, const std::string& shown,
                                       const std::vector<std::string>& variables,
                                       const RadianceLocation& location)
    : impl_(std::make_unique<Impl>()) {
  impl_->text = shown;
  impl_->location = location;
  impl_->values.resize(variables.size());
  try {
    define_operators(impl_->parser);
    define_functions(impl_->parser);
    for (std::size_t i = 0; i < variables.size(); ++i) {
      impl_->parser.DefineVar(variables[i], &impl_->values[i]);
    }
    impl_->parser.SetExpr(text);
    impl_->parser.Eval();  // reports faults of the text
    if (impl_->parser.GetNumResults() != 1) {
      location.fail(fmt::format("the formula '{}' gives several values", beginning(shown)));
    }
  } catch (const mu::Parser::exception_type& error) {
    location.fail(fmt::format(
        "the formula '{}' cannot be read: {}", beginning(shown),
        text == shown ? beginning(error.GetMsg()) : "a definition that it uses is no formula"));
  }
}

RadianceExpression::~RadianceExpression() = default;
RadianceExpression::RadianceExpression(RadianceExpression&&) noexcept = default;

double RadianceExpression::value_or_nan(std::span<const double> values) const {
  std::ranges::copy(values, impl_->values.begin());
  try {
    return impl_->parser.Eval();
  } catch (const mu::Parser::exception_type&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

double RadianceExpression::operator()(std::span<const double> values) const {
  const double value = value_or_nan(values);
  if (!std::isfinite(value)) {
    impl_->location.fail(
        fmt::format("the formula '{}' has no finite value everywhere", beginning(impl_->text)));
  }
  return value;
}

}  // namespace lightwell
