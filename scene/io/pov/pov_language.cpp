#include "scene/io/pov/pov_language.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scene/errors.h"
#include "scene/io/nearest_name.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr std::int64_t most_steps = 20'000'000;  // a few seconds
constexpr std::size_t most_frames = 200;

std::string shown(const PovToken& token) {
  return token.kind == PovToken::Kind::end ? "the end" : fmt::format("'{}'", excerpt(token.text));
}

}  // namespace

PovPlace PovLanguage::place() const {
  const Frame& frame = frames_.back();
  const auto& tokens = frame.text->tokens();
  const std::size_t before = frame.at > 0 ? frame.at - 1 : 0;
  return {.file = &frame.text->path(), .line = tokens.empty() ? 1 : tokens[before].line};
}

// Counts a step of work.
void PovLanguage::spend(std::int64_t amount) {
  spent_ += amount;
  if (spent_ > most_steps + 4 * FilesRead::bytes()) {
    place().fail_limit(fmt::format("loops and macros take more than {} steps", most_steps));
  }
}

const PovText& PovLanguage::keep(const std::filesystem::path& path, std::string text) {
  return texts_.emplace_back(path, std::move(text));
}

const PovText* PovLanguage::kept(const std::filesystem::path& path) const {
  const auto found = std::ranges::find(texts_, path, &PovText::path);
  return found == texts_.end() ? nullptr : &*found;
}

void PovLanguage::push(Frame frame) {
  if (frames_.size() >= most_frames) {
    place().fail_limit(
        fmt::format("files and macros call each other more than {} deep", most_frames));
  }
  frames_.push_back(std::move(frame));
}

const PovToken& PovLanguage::peek() {
  if (!ahead_) ahead_ = std::exchange(later_, std::nullopt);
  while (!ahead_) {
    Frame& frame = frames_.back();
    if (frame.at < frame.end) {
      const PovToken& token = frame.text->tokens()[frame.at++];
      spend();
      if (token.kind == PovToken::Kind::directive && directive_depth_ == 0) {
        if (nesting_ == 0) {
          start_ = {
              .depth = frames_.size(), .at = frame.at - 1, .open_blocks = frame.blocks.size()};
        }
        carry_out(token);
      } else {
        ahead_ = token;
      }
      continue;
    }
    if (!frame.blocks.empty()) {
      PovPlace{.file = &frame.text->path(), .line = frame.blocks.back().line}.fail_limit(
          "a directive opens here and has no #end");
    }
    if (frame.is_function || frames_.size() == 1) {
      ahead_ = PovToken{};
    } else {
      frames_.pop_back();
    }
  }
  return *ahead_;
}

PovToken PovLanguage::next() {
  PovToken token = peek();
  ahead_.reset();
  return token;
}

// Returns the token that was looked at to the frame that it came from.
void PovLanguage::put_back() {
  if (ahead_ && ahead_->kind != PovToken::Kind::end) --frames_.back().at;
  ahead_.reset();
}

// Makes a token the next one, before the one that was looked at.
void PovLanguage::unread(const PovToken& token) {
  later_ = std::exchange(ahead_, token);
}

bool PovLanguage::take(std::string_view sign) {
  if (!peek().is_sign(sign)) return false;
  ahead_.reset();
  return true;
}

void PovLanguage::need(std::string_view sign) {
  const PovToken& token = peek();
  if (!token.is_sign(sign)) {
    place().fail(fmt::format("'{}' is missing before {}", sign, shown(token)));
  }
  ahead_.reset();
}

void PovLanguage::read(const std::filesystem::path& path, const Visit& visit) {
  const PovText& text = keep(path, TextFile(path).text());
  push({.text = &text, .end = text.tokens().size()});
  read_statements(visit);
  frames_.clear();
}

void PovLanguage::limit_nesting() const {
  constexpr int deepest = 200;
  if (nesting_ > deepest) {
    place().fail_limit(fmt::format("blocks and parentheses are nested more than {} deep", deepest));
  }
}

void PovLanguage::read_statements(const Visit& visit) {
  while (true) {
    try {
      if (peek().kind == PovToken::Kind::end) return;
      const Frame& frame = frames_.back();
      start_ = {.depth = frames_.size(), .at = frame.at - 1, .open_blocks = frame.blocks.size()};
      read_statement(visit);
    } catch (const LimitError&) {
      throw;
    } catch (const InputError& error) {
      constexpr std::int64_t steps_of_a_failure = 1000;
      spend(steps_of_a_failure);
      skip_statement();
      remarks_.add_unusable("Statements that cannot be used were left out", failed_, error.what());
    }
  }
}

void PovLanguage::read_statement(const Visit& visit) {
  const PovToken token = next();
  if (token.is_sign(";") || token.is_sign(",")) return;
  if (token.kind == PovToken::Kind::word) {
    if (const auto macro = macros_.find(token.text); macro != macros_.end()) {
      return call_macro(macro->second, token.text);
    }
    if (peek().is_sign("{")) {
      constexpr std::int64_t steps_of_a_block = 50;
      spend(steps_of_a_block);
      items_ = kept_items_;
      const PovNodePtr block = read_block(token);
      if (block->keyword == "global_settings") {
        PovCursor cursor(*block);
        while (!cursor.at_end()) {
          if (cursor.next().word != "assumed_gamma") continue;
          const double given = cursor.number().value_or(1.0);
          if (given > 0.1 && given < 10.0) gamma_ = given;
        }
      }
      return visit(*block);
    }
  }
  std::vector<std::string> known;
  for (const auto& [name, macro] : macros_) known.push_back(name);
  const std::string hint = did_you_mean(token.text, known);
  place().fail(fmt::format("{} begins no statement that is known here{}{}", shown(token),
                           hint.empty() ? "" : ".", hint));
}

// Goes on behind the statement that failed.
void PovLanguage::skip_statement() {
  ahead_.reset();
  later_.reset();
  directive_depth_ = nesting_ = vector_depth_ = 0;
  failed_ = "statement";
  if (frames_.size() < start_.depth) return;
  frames_.resize(start_.depth);
  Frame& frame = frames_.back();
  frame.blocks.resize(std::min(frame.blocks.size(), start_.open_blocks));
  frame.at = start_.at;
  const auto& tokens = frame.text->tokens();
  const PovToken& first = tokens[frame.at++];
  failed_ = excerpt(first.text);
  if (first.is_sign("}")) return;
  if (first.kind == PovToken::Kind::word && frame.at < frame.end && tokens[frame.at].is_sign("(")) {
    for (int open = 0; frame.at < frame.end;) {  // a call ends with its arguments
      const PovToken& token = tokens[frame.at++];
      open += token.is_sign("(") ? 1 : token.is_sign(")") ? -1 : 0;
      if (open == 0) return;
    }
  }
  int braces = first.is_sign("{") ? 1 : 0;
  while (frame.at < frame.end) {
    const PovToken& token = tokens[frame.at];
    if (token.kind == PovToken::Kind::directive && braces == 0) return;
    ++frame.at;
    if (token.is_sign("{")) ++braces;
    if (token.is_sign("}") && --braces <= 0) return;
    if (token.is_sign(";") && braces == 0) return;
  }
}

}  // namespace lightwell
