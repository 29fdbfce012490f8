#pragma once

#include <string>
#include <vector>

#include "scene/io/radiance/radiance_primitive.h"
#include "scene/io/text_file.h"

namespace lightwell {

/// The variables of a file for RADIANCE's program rad (.rif): NAME = value, where a name may be cut
/// short, # begins a comment and a backslash joins lines.
class RadianceProject {
 public:
  struct Value {
    std::string text{};
    RadianceLocation location{};
  };

  /// `file` must outlive the project. Throws InputError for a variable that rad does not know.
  explicit RadianceProject(const TextFile& file);

  /// The values of a variable, called by its full name, in their order.
  std::vector<Value> values(std::string_view variable) const;
  /// The words of all these values; quotes keep a word together.
  std::vector<Value> words(std::string_view variable) const;
  /// The variables that are given, each once.
  std::vector<std::string> given() const;

 private:
  void assign(std::string_view text, const RadianceLocation& location);

  std::vector<std::pair<std::string, Value>> values_;
};

}  // namespace lightwell
