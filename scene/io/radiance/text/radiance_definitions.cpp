#include "scene/io/radiance/text/radiance_definitions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr std::size_t longest_formula = 1 << 16;  // characters
constexpr int deepest_use = 32;                   // definitions within definitions
constexpr int most_uses = 10'000;

bool begins_name(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
}

// Length of the name at the start of `text`. RADIANCE's names may hold dots and backquotes.
std::size_t name_length(std::string_view text) {
  if (text.empty() || !begins_name(text.front())) return 0;
  std::size_t length = 1;
  while (length < text.size() &&
         (std::isalnum(static_cast<unsigned char>(text[length])) || text[length] == '_' ||
          text[length] == '.' || text[length] == '`')) {
    ++length;
  }
  return length;
}

// Length of the number at the start of `text`, with its exponent: the e of 1e5 is no name.
std::size_t number_length(std::string_view text) {
  std::size_t length = 0;
  const auto digits = [&] {
    while (length < text.size() &&
           (std::isdigit(static_cast<unsigned char>(text[length])) || text[length] == '.')) {
      ++length;
    }
  };
  digits();
  if (length == 0 || length >= text.size() || (text[length] != 'e' && text[length] != 'E')) {
    return length;
  }
  const std::size_t mantissa = length++;
  if (length < text.size() && (text[length] == '+' || text[length] == '-')) ++length;
  const std::size_t exponent = length;
  digits();
  return length > exponent ? length : mantissa;
}

std::string without_comments(std::string_view text) {
  std::string result;
  int depth = 0;
  for (const char c : text) {
    if (c == '{') ++depth;
    if (depth == 0) result += c == '\n' ? ' ' : c;
    if (c == '}' && depth > 0) --depth;
  }
  return result;
}

// The parts of "a, f(b, c)" at commas outside of parentheses.
std::vector<std::string_view> arguments_of(std::string_view text) {
  std::vector<std::string_view> result;
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')') --depth;
    if (text[i] != ',' || depth != 0) continue;
    result.push_back(text.substr(begin, i - begin));
    begin = i + 1;
  }
  result.push_back(text.substr(begin));
  return result;
}

// Length of "(...)" at the start of `text`; 0 if there is none.
std::size_t parentheses_length(std::string_view text) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')') --depth;
    if (depth == 0) return text[i] == ')' ? i + 1 : 0;
  }
  return 0;
}

}  // namespace

void RadianceDefinitions::add(std::string_view text, const RadianceLocation& location) {
  const std::string plain = without_comments(text);
  std::string_view rest = plain;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    std::string_view part = trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (part.empty()) continue;
    const std::size_t length = name_length(part);
    const std::string name(part.substr(0, length));
    part = trimmed(part.substr(length));
    Body body;
    if (const std::size_t of_list = parentheses_length(part); of_list > 0) {
      for (const std::string_view parameter : arguments_of(part.substr(1, of_list - 2))) {
        body.parameters.emplace_back(trimmed(parameter));
      }
      part = trimmed(part.substr(of_list));
    }
    if (name.empty() || part.empty() || (part.front() != '=' && part.front() != ':')) {
      location.fail(
          "a part of its definitions defines nothing; write 'name = formula' or 'name(x) = "
          "formula', with ';' between two");
    }
    body.text = part.substr(1);
    bodies_.insert_or_assign(name, std::move(body));
  }
}

class RadianceDefinitions::Expansion {
 public:
  using Values = std::map<std::string, std::string, std::less<>>;
  Expansion(const RadianceDefinitions& definitions, const RadianceLocation& location)
      : bodies_(definitions.bodies_), location_(location) {}

  std::string expand(std::string_view text, const Values& parameters, int depth) {
    std::string result;
    while (!text.empty()) {
      std::size_t length = name_length(text);
      if (length == 0) {
        length = std::max<std::size_t>(1, number_length(text));
        result += text.substr(0, length);
        text.remove_prefix(length);
      } else {
        const std::string_view name = text.substr(0, length);
        text.remove_prefix(length);
        const auto value = parameters.find(name);
        result += value != parameters.end() ? value->second : use(name, text, parameters, depth);
      }
      if (result.size() > longest_formula) location_.fail("a formula grows beyond all measure");
    }
    return result;
  }

 private:
  // The body of a definition in place of its use; `rest` loses the arguments.
  std::string use(std::string_view name, std::string_view& rest, const Values& parameters,
                  int depth) {
    const auto found = bodies_.find(name);
    if (found == bodies_.end()) return std::string(name);
    if (depth >= deepest_use || ++uses_ > most_uses) {
      location_.fail(fmt::format("the definition of '{}' uses itself, or too many others", name));
    }
    const Body& body = found->second;
    Values values;
    if (!body.parameters.empty()) {
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
      const std::size_t length = parentheses_length(rest);
      const auto arguments =
          length > 0 ? arguments_of(rest.substr(1, length - 2)) : std::vector<std::string_view>();
      if (arguments.size() != body.parameters.size()) {
        location_.fail(fmt::format("'{}' has {} arguments in its definition, and {} in its use",
                                   name, body.parameters.size(), arguments.size()));
      }
      for (std::size_t i = 0; i < arguments.size(); ++i) {
        values[body.parameters[i]] = "(" + expand(arguments[i], parameters, depth + 1) + ")";
      }
      rest.remove_prefix(length);
    }
    return "(" + expand(body.text, values, depth + 1) + ")";
  }

  const std::map<std::string, Body, std::less<>>& bodies_;
  const RadianceLocation& location_;
  int uses_ = 0;
};

std::string RadianceDefinitions::expanded(std::string_view formula,
                                          const RadianceLocation& location) const {
  if (bodies_.empty()) return std::string(formula);
  return Expansion(*this, location).expand(formula, {}, 0);
}

}  // namespace lightwell
