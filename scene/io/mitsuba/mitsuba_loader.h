#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/io/mitsuba/mitsuba_tree.h"

namespace pugi {
class xml_node;
}

namespace lightwell {

/// Builds a MitsubaTree from XML. `$name`s are replaced by the <default>s before them in the file;
/// included files replace their <include> elements.
class MitsubaLoader {
 public:
  explicit MitsubaLoader(MitsubaTree& tree) : tree_(tree) {}
  /// Fills the tree from a scene file; throws InputError as the constructor of MitsubaTree does.
  void load(const std::filesystem::path& path);

 private:
  struct Source;
  MitsubaNode load_file(const std::filesystem::path& path, const MitsubaNode* including);
  MitsubaNode convert(const Source& source, const pugi::xml_node& from, int depth);
  void include(const MitsubaNode& node, MitsubaNode& parent);
  std::string substituted(const MitsubaNode& node, std::string_view text) const;

  MitsubaTree& tree_;
  std::map<std::string, std::string, std::less<>> defaults_;
  // The current file and the files that include it, outermost first.
  std::vector<std::filesystem::path> open_;
  int files_ = 0;
};

}  // namespace lightwell
