#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightwell {

/// An element of a Mitsuba scene as it stands once `$name`s are replaced and includes are in place.
struct MitsubaNode {
  std::string tag{};   ///< "bsdf", "shape", "float" ...
  std::string type{};  ///< the plugin's name
  std::string id{};
  std::string name{};  ///< of a property, in the spelling of Mitsuba 2 and 3: "to_world"
  std::vector<std::pair<std::string, std::string>> attributes{};  ///< the others
  std::vector<MitsubaNode> children{};
  const std::filesystem::path* file = nullptr;
  int line = 0;

  /// An attribute other than the four above; nullptr if there is none.
  const std::string* attribute(std::string_view key) const;
  /// What notes call it: its id, or its type and line.
  std::string label() const;
  /// Throws InputError "file:line: <tag> `problem`".
  [[noreturn]] void fail(std::string_view problem) const;

  /// The first child with that property name, as it stands; nullptr if there is none.
  const MitsubaNode* property(std::string_view property_name) const;
  /// Values of properties that are there. Each throws InputError if it is of another type; numbers
  /// must be finite.
  std::optional<double> number(std::string_view property_name) const;
  double number_or(std::string_view property_name, double otherwise) const;
  bool boolean_or(std::string_view property_name, bool otherwise) const;
  std::string string_or(std::string_view property_name, std::string_view otherwise) const;
  /// An attribute that is a finite number; throws InputError if it is no number or missing.
  double number_attribute(std::string_view key) const;
};

/// The numbers of "1, 2 3"; throws InputError naming `node` if there is anything else.
std::vector<double> parse_numbers(const MitsubaNode& node, std::string_view text);

/// A scene file of Mitsuba 0.5, 0.6, 2 or 3 and the files it includes.
class MitsubaTree {
 public:
  /// Throws InputError naming file and line for torn XML, a root other than <scene>, an unknown
  /// `$name`, an id given twice, and files that include each other or more than 16 deep.
  explicit MitsubaTree(const std::filesystem::path& path);
  MitsubaTree(const MitsubaTree&) = delete;
  MitsubaTree& operator=(const MitsubaTree&) = delete;

  const MitsubaNode& root() const { return root_; }
  /// What `node` stands for: the element a <ref> names, or `node` itself. Throws InputError naming
  /// the ids there are if it names none.
  const MitsubaNode& resolved(const MitsubaNode& node) const;
  /// The children, refs resolved, whose tag is `tag`.
  std::vector<const MitsubaNode*> children(const MitsubaNode& node, std::string_view tag) const;
  /// The file a node names, beside the file it stands in or beside the main one.
  std::filesystem::path file_named(const MitsubaNode& node, const std::string& name) const;

 private:
  friend class MitsubaLoader;
  std::vector<std::unique_ptr<std::filesystem::path>> files_;
  MitsubaNode root_;
  std::map<std::string, const MitsubaNode*, std::less<>> by_id_;
};

}  // namespace lightwell
