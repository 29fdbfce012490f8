#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "scene/io/pov/pov_language.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr int deepest_blocks = 60;
constexpr std::int64_t most_items = 4'000'000;

// Words that a value follows, and that are part of the value.
constexpr std::array<std::string_view, 18> words_of_colors = {
    "rgb",    "rgbf", "rgbt",  "rgbft", "srgb", "srgbf",  "srgbt",    "srgbft", "color",
    "colour", "red",  "green", "blue",  "gray", "filter", "transmit", "grey",   "rgbtf"};

// Blocks whose contents have no meaning here.
constexpr std::array<std::string_view, 3> blocks_without_items = {"function", "spline",
                                                                  "parametric"};

}  // namespace

PovValue PovLanguage::right_side(std::string_view name) {
  const Nested within(nesting_);
  limit_nesting();
  const PovToken& token = peek();
  if (token.is_word("array")) return array_block();
  if (const auto macro = macros_.find(token.text);
      token.kind == PovToken::Kind::word && macro != macros_.end()) {
    const PovToken word = next();
    call_macro(macro->second, word.text);
    return right_side(name);
  }
  if (token.kind == PovToken::Kind::word) {
    const bool is_name = find(token.text) != nullptr;
    const PovToken word = next();
    if (!is_name && peek().is_sign("{")) {
      const PovNodePtr read = read_block(word);
      auto block = std::make_shared<PovNode>(*read);
      block->name = name;
      if (word.text != "texture") return PovNodePtr(std::move(block));
      // Further textures are layers on the first.
      while (peek().is_word("texture")) {
        const PovToken again = next();
        add_item(*block, {.value = read_block(again)});
      }
      return PovNodePtr(std::move(block));
    }
    unread(word);
  }
  return expression();
}

bool PovLanguage::begins_value(const PovToken& token) const {
  if (token.kind == PovToken::Kind::number || token.kind == PovToken::Kind::string) return true;
  for (const char* sign : {"<", "(", "-", "+", "!"}) {
    if (token.is_sign(sign)) return true;
  }
  return token.kind == PovToken::Kind::word && is_value_word(token.text);
}

bool PovLanguage::is_value_word(std::string_view word) const {
  return find(word) || functions_.contains(word) || macros_.contains(word) ||
         std::ranges::find(words_of_colors, word) != words_of_colors.end() ||
         is_pov_constant(word) || is_pov_function(word);
}

PovNodePtr PovLanguage::read_block(const PovToken& keyword) {
  const Nested within(nesting_);
  limit_nesting();
  const int outer = std::exchange(directive_depth_, 0);
  const bool is_entry = keyword.is_sign("[");
  auto block = std::make_shared<PovNode>();
  block->keyword = keyword.text;
  block->place = place();
  if (!is_entry) need("{");
  const bool is_opaque =
      std::ranges::find(blocks_without_items, keyword.text) != blocks_without_items.end();
  if (is_opaque) {
    skip_braces();
  } else {
    while (!take(is_entry ? "]" : "}")) read_item(*block);
  }
  directive_depth_ = outer;
  return block;
}

// Passes tokens up to the brace that closes the one before.
void PovLanguage::skip_braces() {
  for (int depth = 1; depth > 0;) {
    const PovToken token = next();
    if (token.kind == PovToken::Kind::end) place().fail("'}' is missing");
    if (token.is_sign("{")) ++depth;
    if (token.is_sign("}")) --depth;
  }
}

void PovLanguage::add_item(PovNode& block, PovItem item) {
  if (++items_ > most_items + FilesRead::bytes()) {
    place().fail_limit(fmt::format("blocks have more than {} values and words", most_items));
  }
  if (const PovNode* child = item.node()) {
    block.depth = std::max(block.depth, child->depth + 1);
    if (block.depth > deepest_blocks) {
      place().fail_limit(fmt::format("blocks are nested more than {} deep", deepest_blocks));
    }
  }
  if (const PovVector* vector = item.vector();
      vector && !std::ranges::all_of(vector->c, [](double c) { return std::isfinite(c); })) {
    place().fail("a number is beyond all bounds");
  }
  const auto* array = std::get_if<std::shared_ptr<PovArray>>(&item.value);
  if (array && !(*array)->sizes.empty()) place().fail("an array is no part of a block");
  block.items.push_back(std::move(item));
}

void PovLanguage::read_item(PovNode& block) {
  const PovToken token = peek();
  if (token.kind == PovToken::Kind::end) {
    block.place.fail_limit(
        fmt::format("'{}' opens a block here that has no end; write '}}'", excerpt(block.keyword)));
  }
  if (take(",") || take(";")) return;
  if (token.is_sign("[")) {
    next();
    return add_item(block, {.value = read_block(token)});
  }
  if (token.is_sign("{")) return add_item(block, {.value = read_block(token)});
  if (token.kind != PovToken::Kind::word) return add_item(block, {.value = expression()});
  if (const auto macro = macros_.find(token.text); macro != macros_.end()) {
    next();
    return call_macro(macro->second, token.text);
  }
  const PovValue* known = find(token.text);
  if (known && std::holds_alternative<PovNodePtr>(*known)) {
    PovValue value = *known;
    next();
    return add_item(block, {.value = std::move(value)});
  }
  if (known || is_pov_constant(token.text) || functions_.contains(token.text)) {
    return add_item(block, {.value = expression()});
  }
  next();
  if (peek().is_sign("{")) return add_item(block, {.value = read_block(token)});
  const bool is_of_value = is_value_word(token.text) && !is_pov_constant(token.text) &&
                           (begins_value(peek()) || peek().is_sign("("));
  if (is_of_value) {
    unread(token);
    return add_item(block, {.value = expression()});
  }
  if (peek().is_sign("(")) {
    place().fail(
        fmt::format("'{}' is called, but no macro or function of that name is declared "
                    "before",
                    excerpt(token.text)));
  }
  add_item(block, {.word = token.text});
}

// The macro's tokens are read in place of the call.
void PovLanguage::call_macro(const Routine& macro, std::string_view name) {
  Frame frame{.text = macro.text, .at = macro.begin, .end = macro.end};
  const Nested within(nesting_);
  limit_nesting();
  need("(");
  for (const std::string_view parameter : macro.parameters) {
    if (peek().is_sign(")")) break;
    PovValue value = right_side("");
    frame.locals.insert_or_assign(parameter, std::move(value));
    if (!take(",")) break;
  }
  if (!peek().is_sign(")")) {
    place().fail(
        fmt::format("the macro '{}' has {} parameters, and is called with more, or ')' is "
                    "missing",
                    excerpt(name), macro.parameters.size()));
  }
  next();
  push(std::move(frame));
}

std::vector<std::size_t> PovLanguage::indices() {
  std::vector<std::size_t> result;
  while (take("[")) {
    const double value = number();
    constexpr double most = 1e6;
    if (!(value > -0.5 && value <= most)) {
      place().fail(fmt::format("an index of an array is {:g}", value));
    }
    result.push_back(static_cast<std::size_t>(std::llround(value)));
    need("]");
  }
  return result;
}

PovValue& PovLanguage::element(PovArray& array, const std::vector<std::size_t>& at) const {
  if (at.size() != array.sizes.size()) {
    place().fail(
        fmt::format("an array of {} dimensions has {} indices", array.sizes.size(), at.size()));
  }
  std::size_t place_of = 0;
  for (std::size_t d = 0; d < at.size(); ++d) {
    if (at[d] >= array.sizes[d]) {
      place().fail(
          fmt::format("the index {} is beyond the end of an array of {}", at[d], array.sizes[d]));
    }
    place_of = place_of * array.sizes[d] + at[d];
  }
  return array.values[place_of];
}

PovValue PovLanguage::array_block() {
  next();
  auto array = std::make_shared<PovArray>();
  array->sizes = indices();
  double count = 1.0;
  for (const std::size_t size : array->sizes) count *= static_cast<double>(size);
  constexpr double most = 1e6;
  if (count > most) place().fail_limit(fmt::format("an array has more than {:g} elements", most));
  if (!array->sizes.empty()) {
    spend(static_cast<std::int64_t>(count));
    array->values.resize(static_cast<std::size_t>(count));
  }
  if (take("{")) fill_array(*array);
  if (array->sizes.empty()) array->sizes = {array->values.size()};
  return array;
}

// Braces of inner dimensions are passed over.
void PovLanguage::fill_array(PovArray& array) {
  std::size_t filled = 0;
  for (int depth = 1; depth > 0;) {
    if (peek().kind == PovToken::Kind::end) place().fail("'}' is missing");
    if (take(",")) continue;
    if (take("{")) {
      ++depth;
    } else if (take("}")) {
      --depth;
    } else {
      PovValue value = right_side("");
      if (std::holds_alternative<std::shared_ptr<PovArray>>(value)) {
        place().fail("an array is no element of another; declare one of two dimensions");
      }
      if (array.sizes.empty()) array.values.emplace_back();
      if (filled >= array.values.size()) place().fail("an array has more values than elements");
      array.values[filled++] = std::move(value);
    }
  }
}

}  // namespace lightwell
