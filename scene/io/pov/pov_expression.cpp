#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "scene/io/nearest_name.h"
#include "scene/io/pictures/picture_mean.h"
#include "scene/io/pov/pov_language.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

struct PovConstant {
  std::string_view name;
  PovVector value;
};

constexpr std::array<PovConstant, 21> pov_constants = {{
    {"x", {{1, 0, 0}, 3}},
    {"y", {{0, 1, 0}, 3}},
    {"z", {{0, 0, 1}, 3}},
    {"u", {{1, 0}, 2}},
    {"v", {{0, 1}, 2}},
    {"t", {{0, 0, 0, 1}, 4}},
    {"pi", {{std::numbers::pi}}},
    {"tau", {{2.0 * std::numbers::pi}}},
    {"true", {{1}}},
    {"yes", {{1}}},
    {"on", {{1}}},
    {"false", {{0}}},
    {"no", {{0}}},
    {"off", {{0}}},
    {"clock", {{0}}},
    {"clock_delta", {{1}}},
    {"version", {{3.7}}},
    {"image_width", {{640}}},
    {"image_height", {{480}}},
    {"frame_number", {{1}}},
    {"final_frame", {{1}}},
}};

const PovConstant* constant_called(std::string_view word) {
  const auto* found = std::ranges::find(pov_constants, word, &PovConstant::name);
  return found == pov_constants.end() ? nullptr : found;
}

PovVector truth(bool holds) {
  return {.c = {holds ? 1.0 : 0.0}};
}

// A number stands for equal components, and what a shorter vector lacks is 0.
template <class Operation>
PovVector combined(const PovVector& a, const PovVector& b, const Operation& operation) {
  PovVector result{.count = std::max(a.count, b.count)};
  for (std::size_t i = 0; i < static_cast<std::size_t>(result.count); ++i) {
    result.c[i] = operation(a.count == 1 ? a.c[0] : a.c[i], b.count == 1 ? b.c[0] : b.c[i]);
  }
  return result;
}

const PovVector& as_vector(const PovValue& value, const PovPlace& place) {
  const auto* vector = std::get_if<PovVector>(&value);
  if (!vector) place.fail("a number or a vector stands here in other scenes, and this is neither");
  return *vector;
}

// Quotation marks and backslashes stand behind a backslash.
std::string unescaped(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_escape =
        text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == '"' || text[i + 1] == '\\');
    plain += text[is_escape ? ++i : i];
  }
  return plain;
}

}  // namespace

bool is_pov_constant(std::string_view word) {
  return constant_called(word) != nullptr;
}

const PovValue* PovLanguage::find(std::string_view name) const {
  for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame) {
    const auto local = frame->locals.find(name);
    if (local != frame->locals.end()) return &local->second;
  }
  const auto global = globals_.find(name);
  return global == globals_.end() ? nullptr : &global->second;
}

double PovLanguage::number() {
  const PovValue value = expression();
  const PovVector& vector = as_vector(value, place());
  if (vector.count != 1) place().fail("a vector stands where a number is needed");
  return vector.c[0];
}

std::string PovLanguage::text_value() {
  const PovValue value = expression();
  const auto* text = std::get_if<std::string>(&value);
  if (!text) place().fail("a string is needed here");
  return *text;
}

PovValue PovLanguage::expression() {
  const Nested within(nesting_);
  limit_nesting();
  const PovValue condition = any_of();
  if (!take("?")) return condition;
  const bool holds = as_vector(condition, place()).c[0] != 0.0;
  PovValue first = expression();
  need(":");
  PovValue second = expression();
  return holds ? first : second;
}

PovValue PovLanguage::any_of() {
  PovValue value = all_of();
  while (take("|")) {
    const PovValue other = all_of();
    value = truth(as_vector(value, place()).c[0] != 0.0 || as_vector(other, place()).c[0] != 0.0);
  }
  return value;
}

PovValue PovLanguage::all_of() {
  PovValue value = comparison();
  while (take("&")) {
    const PovValue other = comparison();
    value = truth(as_vector(value, place()).c[0] != 0.0 && as_vector(other, place()).c[0] != 0.0);
  }
  return value;
}

// Within a vector "<" and ">" are its ends.
PovValue PovLanguage::comparison() {
  PovValue value = sum();
  if (vector_depth_ > 0) return value;
  while (true) {
    const std::string_view sign = peek().kind == PovToken::Kind::sign ? peek().text : "";
    constexpr std::array<std::string_view, 6> signs = {"<", ">", "<=", ">=", "=", "!="};
    if (std::ranges::find(signs, sign) == signs.end()) return value;
    next();
    const PovValue other = sum();
    const auto* text = std::get_if<std::string>(&value);
    const auto* other_text = std::get_if<std::string>(&other);
    const double a = text && other_text ? 0.0 : as_vector(value, place()).c[0];
    const double b = text && other_text ? static_cast<double>(other_text->compare(*text))
                                        : as_vector(other, place()).c[0];
    value = truth(sign == "<"    ? a < b
                  : sign == ">"  ? a > b
                  : sign == "<=" ? a <= b
                  : sign == ">=" ? a >= b
                  : sign == "="  ? a == b
                                 : a != b);
  }
}

PovValue PovLanguage::sum() {
  PovValue value = product();
  while (true) {
    if (take("+")) {
      const PovValue other = product();
      value = combined(as_vector(value, place()), as_vector(other, place()), std::plus<>());
    } else if (take("-")) {
      const PovValue other = product();
      value = combined(as_vector(value, place()), as_vector(other, place()), std::minus<>());
    } else {
      return value;
    }
  }
}

PovValue PovLanguage::product() {
  PovValue value = power();
  while (true) {
    if (take("*")) {
      const PovValue other = power();
      value = combined(as_vector(value, place()), as_vector(other, place()), std::multiplies<>());
    } else if (take("/")) {
      const PovValue other = power();
      const PovVector& by = as_vector(other, place());
      for (std::size_t i = 0; i < static_cast<std::size_t>(by.count); ++i) {
        if (by.c[i] == 0.0) place().fail("a number is divided by 0");
      }
      value = combined(as_vector(value, place()), by, std::divides<>());
    } else {
      return value;
    }
  }
}

PovValue PovLanguage::power() {
  PovValue value = sign();
  while (take("^")) {
    const PovValue exponent = sign();
    value = combined(as_vector(value, place()), as_vector(exponent, place()),
                     [](double a, double b) { return std::pow(a, b); });
  }
  return value;
}

PovValue PovLanguage::sign() {
  const Nested within(nesting_);
  limit_nesting();
  if (take("+")) return sign();
  if (take("-")) {
    const PovValue value = sign();
    return combined(PovVector{}, as_vector(value, place()), std::minus<>());
  }
  if (take("!")) {
    const PovValue value = sign();
    return truth(as_vector(value, place()).c[0] == 0.0);
  }
  return with_members();
}

PovValue PovLanguage::with_members() {
  PovValue value = primary();
  while (true) {
    if (take(".")) {
      value = member(value);
    } else if (const auto* array = std::get_if<std::shared_ptr<PovArray>>(&value);
               array && peek().is_sign("[")) {
      const std::shared_ptr<PovArray> kept = *array;
      value = element(*kept, indices());
      if (std::holds_alternative<std::monostate>(value)) {
        place().fail("an element of an array is used before it has a value");
      }
    } else {
      return value;
    }
  }
}

PovValue PovLanguage::member(const PovValue& of) {
  struct Member {
    std::string_view name;
    std::size_t index;
  };
  constexpr std::array<Member, 11> members = {{{"x", 0},
                                               {"y", 1},
                                               {"z", 2},
                                               {"t", 3},
                                               {"u", 0},
                                               {"v", 1},
                                               {"red", 0},
                                               {"green", 1},
                                               {"blue", 2},
                                               {"filter", 3},
                                               {"transmit", 4}}};
  const PovVector& vector = as_vector(of, place());
  const PovToken word = next();
  if (word.is_word("gray") || word.is_word("grey")) {
    constexpr double red = 0.297, green = 0.589, blue = 0.114;
    return PovVector{.c = {red * vector.c[0] + green * vector.c[1] + blue * vector.c[2]}};
  }
  const auto* found = std::ranges::find(members, word.text, &Member::name);
  if (found == members.end()) {
    place().fail(fmt::format("a vector has no component '{}'", excerpt(word.text)));
  }
  return PovVector{.c = {vector.count == 1 ? vector.c[0] : vector.c[found->index]}};
}

PovValue PovLanguage::primary() {
  const PovToken token = next();
  if (token.kind == PovToken::Kind::number) return PovVector{.c = {token.number}};
  if (token.kind == PovToken::Kind::string) return unescaped(token.text);
  if (token.is_sign("(")) {
    const int outer = std::exchange(vector_depth_, 0);
    PovValue value = expression();
    need(")");
    vector_depth_ = outer;
    return value;
  }
  if (token.is_sign("<")) return literal_vector();
  if (token.kind == PovToken::Kind::word) return word_value(token);
  if (token.kind == PovToken::Kind::end) place().fail("a value is missing before the end");
  place().fail(fmt::format("a value is missing before '{}'", excerpt(token.text)));
}

PovValue PovLanguage::word_value(const PovToken& word) {
  if (const PovValue* known = find(word.text)) return *known;
  if (const auto macro = macros_.find(word.text); macro != macros_.end()) {
    call_macro(macro->second, word.text);
    return with_members();
  }
  const auto function = functions_.find(word.text);
  if (function != functions_.end()) {
    const Routine routine = function->second;
    return call_function(routine, word.text);
  }
  if (const PovConstant* constant = constant_called(word.text)) return constant->value;
  if (auto value = built_in(word.text)) return *std::move(value);
  if (is_value_word(word.text)) return color_value(word.text);
  std::vector<std::string> known;
  for (const auto& [name, value] : globals_) known.push_back(name);
  const std::string hint = did_you_mean(word.text, known);
  place().fail(fmt::format("'{}' is not declared before this line{}{}", excerpt(word.text),
                           hint.empty() ? "" : ".", hint));
}

// Twelve components are those of a matrix.
PovValue PovLanguage::literal_vector() {
  ++vector_depth_;
  std::vector<double> components;
  while (!take(">")) {
    constexpr std::size_t most = 12;
    if (components.size() >= most) place().fail("a vector has more than 12 components");
    components.push_back(number());
    take(",");
  }
  --vector_depth_;
  if (components.empty()) place().fail("a vector has no components");
  if (components.size() > std::tuple_size_v<decltype(PovVector::c)>) {
    auto matrix = std::make_shared<PovArray>();
    for (const double value : components) matrix->values.emplace_back(PovVector{.c = {value}});
    return matrix;
  }
  PovVector vector{.count = static_cast<int>(components.size())};
  std::ranges::copy(components, vector.c.begin());
  if (vector.count == 1) vector.count = 2;
  return vector;
}

// The value behind a word such as rgb. A component by its name leaves the others 0.
PovValue PovLanguage::color_value(std::string_view keyword) {
  const Nested within(nesting_);
  limit_nesting();
  const auto follows = [&](std::initializer_list<std::string_view> words) {
    return peek().kind == PovToken::Kind::word &&
           std::ranges::find(words, peek().text) != words.end();
  };
  PovVector color{.count = 5};
  if (keyword == "color" || keyword == "colour") {
    const PovValue given = sum();
    color = pov_color(as_vector(given, place()));
  } else if (keyword == "red" || keyword == "green" || keyword == "blue" || keyword == "filter" ||
             keyword == "transmit") {
    const std::size_t index = keyword == "red"      ? 0
                              : keyword == "green"  ? 1
                              : keyword == "blue"   ? 2
                              : keyword == "filter" ? 3
                                                    : 4;
    const PovValue amount = product();
    color.c[index] = as_vector(amount, place()).c[0];
  } else {
    const PovValue given = product();
    const PovVector& vector = as_vector(given, place());
    color = pov_color(vector);
    if (vector.count == 1 && keyword.ends_with('f')) color.c[3] = vector.c[0];
    if (vector.count == 1 && keyword.ends_with('t')) color.c[4] = vector.c[0];
    if (vector.count > 1 && keyword.ends_with("rgbt")) std::swap(color.c[3], color.c[4]);
    if (keyword.starts_with("s")) {
      for (std::size_t i = 0; i < 3; ++i) color.c[i] = from_srgb(color.c[i]);
    }
  }
  while (follows({"red", "green", "blue", "filter", "transmit"})) {
    const PovToken word = next();
    if (!begins_value(peek())) {
      unread(word);
      break;
    }
    const PovValue part = color_value(word.text);
    color = combined(color, as_vector(part, place()), std::plus<>());
    color.count = 5;
  }
  return color;
}

}  // namespace lightwell
