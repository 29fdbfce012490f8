#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/io/pov/pov_text.h"
#include "scene/io/pov/pov_value.h"
#include "scene/io/remarks.h"

namespace lightwell {

/// The language of scene texts: directives, names, macros and expressions. What remains are blocks
/// of keywords and values.
///
/// Work and memory are bounded: a file beyond the bounds throws LimitError.
class PovLanguage {
 public:
  using Visit = std::function<void(const PovNode& block)>;

  explicit PovLanguage(Remarks& remarks) : remarks_(remarks) {}

  /// Passes the blocks of a file and of the files that it includes to `visit`, in order. Statements
  /// that cannot be read, and blocks for which `visit` throws an InputError other than a
  /// LimitError, are left out with a remark.
  void read(const std::filesystem::path& path, const Visit& visit);

  /// The block behind the last #default; null: none.
  const PovNodePtr& defaults() const { return defaults_; }
  /// Power by which a component of a colour becomes linear (assumed_gamma).
  double gamma() const { return gamma_; }

 private:
  struct Block {  // an open #if, loop or #switch
    enum class Kind : std::uint8_t { condition, loop, count, choice };
    Kind kind = Kind::condition;
    int line = 0;
    std::size_t start = 0;  // token to which a loop returns
    std::string_view counter{};
    double last = 0.0, step = 1.0;
  };
  struct Frame {  // a file, or the body of a macro or a function
    const PovText* text = nullptr;
    std::size_t at = 0, end = 0;
    bool is_function = false;
    std::map<std::string_view, PovValue> locals{};
    std::vector<Block> blocks{};
  };
  struct Start {  // of the statement that is read
    std::size_t depth = 0, at = 0, open_blocks = 0;
  };
  struct Routine {
    const PovText* text = nullptr;
    std::size_t begin = 0, end = 0;
    std::vector<std::string_view> parameters{};
  };

  // Tokens (pov_language.cpp). A directive is carried out when it is met, except within the words
  // of another directive, which it ends.
  const PovToken& peek();
  PovToken next();
  void put_back();
  void unread(const PovToken& token);
  bool take(std::string_view sign);
  void need(std::string_view sign);
  PovPlace place() const;
  void spend(std::int64_t amount = 1);
  void read_statements(const Visit& visit);
  void read_statement(const Visit& visit);
  void skip_statement();
  const PovText& keep(const std::filesystem::path& path, std::string text);
  const PovText* kept(const std::filesystem::path& path) const;
  void push(Frame frame);

  // Directives (pov_directives.cpp).
  void carry_out(const PovToken& directive);
  void open(const PovToken& directive);
  bool condition(std::string_view directive);
  void begin_condition(bool holds, int line);
  void begin_loop(std::size_t start, int line);
  void begin_count(const PovToken& directive);
  void begin_choice(const PovToken& directive);
  void choose(double value);
  void end_statement();
  void pass_else(const PovToken& directive);
  void end_block();
  void leave_loop();
  std::string_view skip_branch(std::initializer_list<std::string_view> stops);
  void declare(bool is_local);
  void declare_element(std::string_view name);
  void declare_macro(const PovToken& directive);
  void declare_function(std::string_view name);
  void include();
  bool is_declared(std::string_view name) const;

  // Blocks and calls (pov_blocks.cpp).
  PovValue right_side(std::string_view name);
  PovNodePtr read_block(const PovToken& keyword);
  void read_item(PovNode& block);
  void add_item(PovNode& block, PovItem item);
  bool begins_value(const PovToken& token) const;
  bool is_value_word(std::string_view word) const;
  void call_macro(const Routine& macro, std::string_view name);
  PovValue array_block();
  void fill_array(PovArray& array);
  std::vector<std::size_t> indices();
  PovValue& element(PovArray& array, const std::vector<std::size_t>& at) const;
  void skip_braces();

  // Expressions (pov_expression.cpp).
  PovValue expression();
  PovValue any_of();
  PovValue all_of();
  PovValue comparison();
  PovValue sum();
  PovValue product();
  PovValue power();
  PovValue sign();
  PovValue with_members();
  PovValue primary();
  PovValue word_value(const PovToken& word);
  PovValue literal_vector();
  PovValue color_value(std::string_view keyword);
  PovValue member(const PovValue& of);
  double number();
  std::string text_value();
  const PovValue* find(std::string_view name) const;

  // Functions (pov_functions.cpp).
  std::optional<PovValue> built_in(std::string_view name);
  PovValue call_function(const Routine& function, std::string_view name);
  std::vector<PovValue> arguments();
  PovValue random(double stream);
  double from_srgb(double value) const;

  /// Counts a block, an expression or a directive within another, as long as it exists.
  class Nested {
   public:
    explicit Nested(int& depth) : depth_(++depth) {}
    ~Nested() { --depth_; }
    Nested(const Nested&) = delete;
    Nested& operator=(const Nested&) = delete;

   private:
    int& depth_;
  };
  void limit_nesting() const;

  Remarks& remarks_;
  std::deque<PovText> texts_{};
  std::vector<Frame> frames_{};
  std::optional<PovToken> ahead_{}, later_{};
  Start start_{};
  std::string failed_{};  // first word of the statement that failed last
  int directive_depth_ = 0, nesting_ = 0, vector_depth_ = 0;
  std::map<std::string, PovValue, std::less<>> globals_{};
  std::map<std::string, Routine, std::less<>> macros_{}, functions_{};
  std::vector<std::uint32_t> streams_{};
  PovNodePtr defaults_{};
  double gamma_ = 1.0;
  std::int64_t spent_ = 0, items_ = 0, kept_items_ = 0;
};

/// True for a name that has a value of its own, such as x, pi or true.
bool is_pov_constant(std::string_view word);
/// True for a function that the language has.
bool is_pov_function(std::string_view word);

/// The names that the standard include files declare, as a scene text; empty for a file of another
/// name. The colours of colors.inc are numbers of red, green and blue.
std::string pov_standard_names(std::string_view file);

}  // namespace lightwell
