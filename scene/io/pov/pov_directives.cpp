#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scene/errors.h"
#include "scene/io/pov/pov_language.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr std::array<std::string_view, 6> pov_openers = {"if",    "ifdef", "ifndef",
                                                         "while", "for",   "switch"};

bool opens_block(std::string_view directive) {
  return std::ranges::find(pov_openers, directive) != pov_openers.end();
}

}  // namespace

void PovLanguage::carry_out(const PovToken& directive) {
  const Nested within(directive_depth_);
  const std::string_view word = directive.text;
  if (opens_block(word)) {
    open(directive);
  } else if (word == "else" || word == "elseif" || word == "case" || word == "range") {
    pass_else(directive);
  } else if (word == "break") {
    leave_loop();
  } else if (word == "end") {
    end_block();
  } else if (word == "declare" || word == "local") {
    declare(word == "local");
  } else if (word == "macro") {
    declare_macro(directive);
  } else if (word == "include") {
    include();
  } else if (word == "default") {
    defaults_ = read_block(directive);
    kept_items_ = items_;
  } else if (word == "undef") {
    globals_.erase(std::string(next().text));
  } else if (word == "version") {
    expression();
    end_statement();
  } else if (word == "error") {
    place().fail("the scene says: " + text_value());
  } else if (word == "debug" || word == "warning" || word == "render" || word == "statistics") {
    text_value();
    end_statement();
  } else {
    place().fail(fmt::format("the directive '#{}' is not known here", excerpt(word)));
  }
}

// A semicolon behind a directive belongs to it.
void PovLanguage::end_statement() {
  take(";");
  put_back();
}

// A condition that cannot be read does not hold.
void PovLanguage::open(const PovToken& directive) {
  const std::size_t depth = frames_.size(), start = frames_.back().at;
  const std::string_view word = directive.text;
  try {
    if (word == "while") return begin_loop(start, directive.line);
    if (word == "for") return begin_count(directive);
    if (word == "switch") return begin_choice(directive);
    begin_condition(condition(word), directive.line);
  } catch (const LimitError&) {
    throw;
  } catch (const InputError& error) {
    ahead_.reset();
    if (frames_.size() < depth) place().fail_limit(error.what());
    frames_.resize(depth);
    remarks_.add_unusable("Conditions that cannot be read were taken as false",
                          fmt::format("#{}", word), error.what());
    begin_condition(false, directive.line);
  }
}

bool PovLanguage::condition(std::string_view directive) {
  bool holds = false;
  if (directive == "if" || directive == "elseif" || directive == "while") {
    need("(");
    holds = number() != 0.0;
    need(")");
  } else {
    need("(");
    holds = is_declared(next().text) == (directive == "ifdef");
    if (take("[")) {
      number();
      need("]");
    }
    need(")");
  }
  return holds;
}

void PovLanguage::begin_condition(bool holds, int line) {
  frames_.back().blocks.push_back({.kind = Block::Kind::condition, .line = line});
  while (!holds) {
    const std::string_view stop = skip_branch({"else", "elseif", "end"});
    if (stop == "end") return frames_.back().blocks.pop_back();
    holds = stop == "else" || condition("elseif");
  }
}

void PovLanguage::begin_loop(std::size_t start, int line) {
  const bool holds = condition("while");
  Frame& frame = frames_.back();
  if (holds) {
    frame.blocks.push_back({.kind = Block::Kind::loop, .line = line, .start = start});
  } else {
    frame.blocks.push_back({.line = line});
    skip_branch({"end"});
    frame.blocks.pop_back();
  }
}

void PovLanguage::begin_count(const PovToken& directive) {
  need("(");
  const std::string_view counter = next().text;
  need(",");
  const double first = number();
  need(",");
  const double last = number(), step = take(",") ? number() : 1.0;
  need(")");
  if (step == 0.0) place().fail("'#for' has a step of 0");
  Frame& frame = frames_.back();
  frame.locals[counter] = PovVector{.c = {first}};
  const bool runs = step > 0.0 ? first <= last : first >= last;
  frame.blocks.push_back({.kind = Block::Kind::count,
                          .line = directive.line,
                          .start = frame.at,
                          .counter = counter,
                          .last = last,
                          .step = step});
  if (runs) return;
  skip_branch({"end"});
  frame.blocks.pop_back();
}

void PovLanguage::begin_choice(const PovToken& directive) {
  need("(");
  const double value = number();
  need(")");
  frames_.back().blocks.push_back({.kind = Block::Kind::choice, .line = directive.line});
  choose(value);
}

// Goes on behind the #case, #range or #else that fits the value.
void PovLanguage::choose(double value) {
  constexpr double nearly = 1e-10;
  while (true) {
    const std::string_view stop = skip_branch({"case", "range", "else", "end"});
    if (stop == "else") return;
    if (stop == "end") return frames_.back().blocks.pop_back();
    need("(");
    const double low = number();
    double high = low;
    if (stop == "range") {
      need(",");
      high = number();
    }
    need(")");
    if (value >= low - nearly && value <= high + nearly) return;
  }
}

// The end of the branch that was read.
void PovLanguage::pass_else(const PovToken& directive) {
  const std::string_view word = directive.text;
  Frame& frame = frames_.back();
  if (frame.blocks.empty()) place().fail(fmt::format("'#{}' follows no #if", word));
  const Block::Kind kind = frame.blocks.back().kind;
  if (kind == Block::Kind::choice) {  // without #break, the next branch is read as well
    if (word == "else") return;
    need("(");
    number();
    if (take(",")) number();
    return need(")");
  }
  if (kind != Block::Kind::condition) {
    place().fail(fmt::format("'#{}' stands within a loop", word));
  }
  skip_branch({"end"});
  frame.blocks.pop_back();
}

void PovLanguage::end_block() {
  Frame& frame = frames_.back();
  if (frame.blocks.empty()) place().fail("'#end' ends nothing that is open");
  const Block block = frame.blocks.back();
  frame.blocks.pop_back();
  if (block.kind == Block::Kind::loop) {
    frame.at = block.start;
    begin_loop(block.start, block.line);
  } else if (block.kind == Block::Kind::count) {
    auto* counter = std::get_if<PovVector>(&frame.locals[block.counter]);
    if (!counter) place().fail(fmt::format("the counter '{}' is no number", block.counter));
    counter->c[0] += block.step;
    constexpr double nearly = 1e-10;
    const double beyond = (counter->c[0] - block.last) * (block.step > 0.0 ? 1.0 : -1.0);
    if (beyond > nearly * std::abs(block.step)) return;
    frame.at = block.start;
    frame.blocks.push_back(block);
  }
}

// Goes on behind the innermost loop or choice.
void PovLanguage::leave_loop() {
  Frame& frame = frames_.back();
  while (!frame.blocks.empty()) {
    const Block::Kind kind = frame.blocks.back().kind;
    skip_branch({"end"});
    frame.blocks.pop_back();
    if (kind != Block::Kind::condition) return;
  }
  place().fail("'#break' stands outside of loops and #switch");
}

// Passes tokens up to the next of the directives `stops` of this block, and returns it.
std::string_view PovLanguage::skip_branch(std::initializer_list<std::string_view> stops) {
  put_back();
  Frame& frame = frames_.back();
  const auto& tokens = frame.text->tokens();
  int depth = 0;
  while (frame.at < frame.end) {
    const PovToken& token = tokens[frame.at++];
    spend();
    if (token.kind != PovToken::Kind::directive) continue;
    if (depth == 0 && std::ranges::find(stops, token.text) != stops.end()) return token.text;
    if (opens_block(token.text) || token.text == "macro") ++depth;
    if (token.text == "end") --depth;
  }
  const int line = frame.blocks.empty() ? place().line : frame.blocks.back().line;
  PovPlace{.file = &frame.text->path(), .line = line}.fail_limit(
      "a directive opens here and has no #end");
}

bool PovLanguage::is_declared(std::string_view name) const {
  return find(name) || macros_.contains(name) || functions_.contains(name);
}

void PovLanguage::declare(bool is_local) {
  const PovToken word = next();
  if (word.kind != PovToken::Kind::word) {
    place().fail(fmt::format("'{}' is no name", excerpt(word.text)));
  }
  const std::string_view name = word.text;
  if (peek().is_sign("[")) return declare_element(name);
  need("=");
  if (peek().is_word("function")) return declare_function(name);
  PovValue value = right_side(name);
  kept_items_ = items_;
  end_statement();
  Frame& frame = frames_.back();
  const auto local = frame.locals.find(name);
  if (local != frame.locals.end()) {
    local->second = std::move(value);
  } else if (is_local) {
    frame.locals.emplace(name, std::move(value));
  } else {
    globals_.insert_or_assign(std::string(name), std::move(value));
  }
}

void PovLanguage::declare_element(std::string_view name) {
  const auto* found = find(name);
  const auto* array = found ? std::get_if<std::shared_ptr<PovArray>>(found) : nullptr;
  if (!array) place().fail(fmt::format("'{}' is no array that is declared before", excerpt(name)));
  const std::shared_ptr<PovArray> kept = *array;
  PovValue& slot = element(*kept, indices());
  need("=");
  PovValue value = right_side(name);
  if (std::holds_alternative<std::shared_ptr<PovArray>>(value)) {
    place().fail("an array is no element of another; declare one of two dimensions");
  }
  kept_items_ = items_;
  slot = std::move(value);
  end_statement();
}

void PovLanguage::declare_macro(const PovToken& directive) {
  const std::string name(next().text);
  Routine macro{.text = frames_.back().text};
  need("(");
  while (!take(")")) {
    const PovToken word = next();
    if (word.is_sign(",")) continue;
    if (word.kind != PovToken::Kind::word) {
      place().fail(fmt::format("the macro '{}' has a parameter that is no name", excerpt(name)));
    }
    if (word.text != "optional") macro.parameters.push_back(word.text);
  }
  Frame& frame = frames_.back();
  macro.begin = frame.at;
  frame.blocks.push_back({.line = directive.line});
  skip_branch({"end"});
  frame.blocks.pop_back();
  macro.end = frame.at - 1;
  macros_.insert_or_assign(name, std::move(macro));
}

// A function is an expression of its parameters, x, y and z unless it names others.
void PovLanguage::declare_function(std::string_view name) {
  next();
  Routine function{.text = frames_.back().text};
  if (take("(")) {
    while (!take(")")) {
      const PovToken word = next();
      if (word.kind == PovToken::Kind::end) place().fail("')' is missing");
      if (word.kind == PovToken::Kind::word) function.parameters.push_back(word.text);
    }
  } else {
    function.parameters = {"x", "y", "z"};
  }
  need("{");
  function.begin = frames_.back().at;
  skip_braces();
  function.end = frames_.back().at - 1;
  functions_.insert_or_assign(std::string(name), std::move(function));
  end_statement();
}

void PovLanguage::include() {
  const std::string name = text_value();
  put_back();
  const std::filesystem::path& here = frames_.back().text->path();
  for (const auto& from : {here.parent_path(), frames_.front().text->path().parent_path()}) {
    const std::filesystem::path path = from / name;
    if (!is_file(path)) continue;
    const PovText* known = kept(path);
    const PovText& text = known ? *known : keep(path, TextFile(path).text());
    return push({.text = &text, .end = text.tokens().size()});
  }
  std::string names = pov_standard_names(name);
  if (names.empty()) {
    return remarks_.add("Included files are missing, and what they declare is not known", name);
  }
  const PovText* known = kept(name);
  const PovText& text = known ? *known : keep(name, std::move(names));
  push({.text = &text, .end = text.tokens().size()});
}

}  // namespace lightwell
