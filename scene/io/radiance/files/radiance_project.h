#pragma once

#include <string>
#include <vector>

#include "scene/io/radiance/text/radiance_primitive.h"
#include "scene/io/text_file.h"

namespace lightwell {

/// The variables of a file for RADIANCE's program rad (.rif), in lines NAME = value. Names may be
/// abbreviated, # begins a comment and a backslash joins lines.
class RadianceProject {
 public:
  struct Value {
    std::string text{};
    RadianceLocation location{};
  };

  /// `file` must outlive the project. Throws InputError for a variable unknown to rad.
  explicit RadianceProject(const TextFile& file);

  /// Values of a variable, by its full name, in file order.
  std::vector<Value> values(std::string_view variable) const;
  /// Words of all values of a variable; quotes keep a word together.
  std::vector<Value> words(std::string_view variable) const;
  /// Variables that the file sets, each once.
  std::vector<std::string> given() const;

 private:
  void assign(std::string_view text, const RadianceLocation& location);

  std::vector<std::pair<std::string, Value>> values_;
};

}  // namespace lightwell
