#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightwell {

/// An element of a Mitsuba scene after substitution of `$name`s and includes.
struct MitsubaNode {
  std::string tag{};   ///< "bsdf", "shape", "float" ...
  std::string type{};  ///< the plugin's name
  std::string id{};
  std::string name{};  ///< property name in the spelling of Mitsuba 2 and 3: "to_world"
  /// Attributes other than those above.
  std::vector<std::pair<std::string, std::string>> attributes{};
  std::vector<MitsubaNode> children{};
  const std::filesystem::path* file = nullptr;
  int line = 0;

  /// Attribute other than tag, type, id and name; nullptr if missing.
  const std::string* attribute(std::string_view key) const;
  /// Label of the element in notes: its id, or its type and line.
  std::string label() const;
  /// "file:line: <tag> `problem`".
  std::string called(std::string_view problem) const;
  /// Throws InputError "file:line: <tag> `problem`".
  [[noreturn]] void fail(std::string_view problem) const;

  /// First child with this property name, refs unresolved; nullptr if missing.
  const MitsubaNode* property(std::string_view property_name) const;
  /// Value of a property of this element. Each accessor throws InputError if the property has
  /// another type or is a number that is not finite.
  std::optional<double> number(std::string_view property_name) const;
  double number_or(std::string_view property_name, double otherwise) const;
  bool boolean_or(std::string_view property_name, bool otherwise) const;
  std::string string_or(std::string_view property_name, std::string_view otherwise) const;
  /// A finite number from an attribute; throws InputError if the attribute is missing or no finite
  /// number.
  double number_attribute(std::string_view key) const;
};

/// Parses "1, 2 3"; throws InputError naming `node` if `text` contains anything but numbers.
std::vector<double> parse_numbers(const MitsubaNode& node, std::string_view text);

/// A part of a scene file that refers to something missing: a reference to no element, or an
/// include of no file.
struct MitsubaGap {
  std::string what{};  ///< the kind of gap, for Remarks::add_unusable()
  std::string name{};
  std::string why{};  ///< place and remedy
};

/// A scene file of Mitsuba 0.5, 0.6, 2 or 3 and the files it includes.
class MitsubaTree {
 public:
  /// Throws InputError naming file and line for torn XML, a root other than <scene>, an unknown
  /// `$name`, an id given twice, and files that include each other or more than 16 deep.
  /// References to no element and includes of no file are left out (gaps()).
  explicit MitsubaTree(const std::filesystem::path& path);
  MitsubaTree(const MitsubaTree&) = delete;
  MitsubaTree& operator=(const MitsubaTree&) = delete;

  const MitsubaNode& root() const { return root_; }
  /// The references and includes that were left out.
  const std::vector<MitsubaGap>& gaps() const { return gaps_; }
  /// The element referenced by a <ref>, or `node` itself if it is no <ref>.
  const MitsubaNode& resolved(const MitsubaNode& node) const;
  /// Children with tag `tag`, refs resolved.
  std::vector<const MitsubaNode*> children(const MitsubaNode& node, std::string_view tag) const;
  /// Path of a file named by a node, beside the file of the node or beside the main file. Throws
  /// InputError if there is none.
  std::filesystem::path file_named(const MitsubaNode& node, const std::string& name) const;
  /// True if file_named() finds a file.
  bool has_file(const MitsubaNode& node, const std::string& name) const;

 private:
  friend class MitsubaLoader;
  std::optional<std::filesystem::path> found_file(const MitsubaNode& node,
                                                  const std::string& name) const;
  void drop_dangling(MitsubaNode& node, const std::set<std::string, std::less<>>& ids);
  std::vector<std::unique_ptr<std::filesystem::path>> files_;
  MitsubaNode root_;
  std::map<std::string, const MitsubaNode*, std::less<>> by_id_;
  std::vector<MitsubaGap> gaps_;
};

}  // namespace lightwell
