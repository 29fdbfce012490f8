#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/io/radiance/text/radiance_expression.h"
#include "scene/io/radiance/text/radiance_primitive.h"

namespace lightwell {

/// The function file of a pattern, which defines what the pattern's formulas use.
class RadianceFunctionFile {
 public:
  /// `file` is searched beside the pattern's file and in `folder` (see find_radiance_file()), then
  /// among the known ones (see radiance_library()); "." is none. Throws InputError if it is not
  /// there.
  RadianceFunctionFile(const RadiancePrimitive& pattern, const std::string& file,
                       const std::filesystem::path& folder);

  /// A formula of `variables` and of the arguments A1, A2, ... of the pattern, whose values follow
  /// those of the variables (see append_arguments()). Throws InputError for a formula that uses
  /// anything else.
  RadianceExpression formula(const std::string& text, std::vector<std::string> variables) const;
  void append_arguments(std::vector<double>& values) const;
  /// Text of the file.
  const std::string& text() const { return text_; }

 private:
  std::vector<double> arguments_;
  RadianceLocation location_;
  std::size_t argument_count_ = 0;
  std::string text_;
};

}  // namespace lightwell
