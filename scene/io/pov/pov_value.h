#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/io/pov/pov_text.h"

namespace lightwell {

/// A number (one component), a vector (two to four) or a colour (five: red, green, blue, filter,
/// transmit). Components beyond `count` are 0.
struct PovVector {
  std::array<double, 5> c{};
  int count = 1;
};

struct PovNode;
struct PovArray;

/// Value of an expression or a name: a vector, a string, a block such as `texture { ... }`, or an
/// array. Blocks are never null; monostate is no value.
using PovValue = std::variant<std::monostate, PovVector, std::string,
                              std::shared_ptr<const PovNode>, std::shared_ptr<PovArray>>;

/// An array of one or more dimensions, the last of which runs fastest; also the twelve numbers of a
/// matrix.
struct PovArray {
  std::vector<std::size_t> sizes{};
  std::vector<PovValue> values{};
};

/// A part of a block: a keyword, or a value if `word` is empty.
struct PovItem {
  std::string_view word{};
  PovValue value{};

  const PovNode* node() const {
    const auto* found = std::get_if<std::shared_ptr<const PovNode>>(&value);
    return found ? found->get() : nullptr;
  }
  const PovVector* vector() const { return std::get_if<PovVector>(&value); }
};

/// A block: `keyword { items }`. The keyword of a map's entry is "[".
struct PovNode {
  std::string_view keyword{};
  std::string name{};  ///< by which the scene declares the block; empty: none
  PovPlace place{};
  std::vector<PovItem> items{};
  int depth = 1;  ///< of the blocks within blocks

  /// Throws InputError "file:line: 'keyword' problem".
  [[noreturn]] void fail(std::string_view problem) const;
  /// The declared name, or the keyword.
  std::string label() const { return name.empty() ? std::string(keyword) : name; }
};

using PovNodePtr = std::shared_ptr<const PovNode>;

/// A place within the items of a block.
class PovCursor {
 public:
  explicit PovCursor(const PovNode& node) : node_(node) {}

  const PovNode& node() const { return node_; }
  bool at_end() const { return at_ >= node_.items.size(); }
  const PovItem& next() { return node_.items[at_++]; }
  const PovItem* look() const { return at_end() ? nullptr : &node_.items[at_]; }
  /// Passes the word if it is next.
  bool take(std::string_view word);
  /// The next value; empty, without passing anything, if the next item is none.
  std::optional<PovVector> vector();
  std::optional<double> number();
  std::optional<std::string> string();
  /// The block that is next, and that is passed; null if the next item is none.
  const PovNode* block();
  /// The next value as a point or a number. Throws InputError naming `what` if there is none.
  Eigen::Vector3d need_point(std::string_view what);
  double need_number(std::string_view what);
  /// A whole number from 0 to 20 000 000.
  std::size_t need_count(std::string_view what);

 private:
  const PovNode& node_;
  std::size_t at_ = 0;
};

/// A vector as a point; a number stands for three equal coordinates.
Eigen::Vector3d pov_point(const PovVector& vector);
/// A vector as a colour; a number stands for red, green and blue alike.
PovVector pov_color(const PovVector& vector);

}  // namespace lightwell
