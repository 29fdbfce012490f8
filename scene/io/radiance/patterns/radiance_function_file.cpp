#include "scene/io/radiance/patterns/radiance_function_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/io/radiance/files/radiance_loader.h"
#include "scene/io/radiance/patterns/radiance_library.h"
#include "scene/io/radiance/text/radiance_definitions.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr std::size_t least_arguments = 10;  // A1 to A10 are known to every formula

std::string text_of(const std::string& file, const RadiancePrimitive& pattern,
                    const std::filesystem::path& folder) {
  if (file == ".") return {};
  if (const auto path = find_radiance_file(file, pattern.location, folder)) {
    return TextFile(*path).text();
  }
  const std::string_view known = radiance_library(file);
  if (known.empty()) {
    pattern.fail(fmt::format("names the file '{}', which is not there", excerpt(file)));
  }
  return std::string(known);
}

}  // namespace

RadianceFunctionFile::RadianceFunctionFile(const RadiancePrimitive& pattern,
                                           const std::string& file,
                                           const std::filesystem::path& folder)
    : arguments_(pattern.reals),
      location_(pattern.location),
      argument_count_(pattern.reals.size()),
      text_(text_of(file, pattern, folder)) {
  arguments_.resize(std::max(least_arguments, argument_count_));
}

RadianceExpression RadianceFunctionFile::formula(const std::string& text,
                                                 std::vector<std::string> variables) const {
  RadianceDefinitions definitions;
  definitions.add(radiance_library("rayinit.cal"), location_);
  definitions.add(text_, location_);
  definitions.add(fmt::format("AC = {}", argument_count_), location_);
  for (std::size_t i = 1; i <= arguments_.size(); ++i) variables.push_back(fmt::format("A{}", i));
  return {definitions.expanded(text, location_), text, variables, location_};
}

void RadianceFunctionFile::append_arguments(std::vector<double>& values) const {
  values.insert(values.end(), arguments_.begin(), arguments_.end());
}

}  // namespace lightwell
