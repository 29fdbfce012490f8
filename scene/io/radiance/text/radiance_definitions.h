#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/io/radiance/text/radiance_primitive.h"

namespace lightwell {

/// Variables and functions that the options -e and -f of a generator define: "r = .5;
/// f(x) = r * x ^ 2" (RADIANCE's manual page of icalc). A definition may use others; a colon may
/// stand for the equals sign, and {braces} hold comments.
class RadianceDefinitions {
 public:
  /// Adds the definitions of a text, parted by semicolons; a later one replaces an earlier one.
  /// Throws InputError naming the place if a part is no definition.
  void add(std::string_view text, const RadianceLocation& location);
  /// The formula with every use of a definition replaced by its body. Throws InputError naming the
  /// place for a wrong number of arguments, and for definitions that use themselves or grow beyond
  /// 65 536 characters.
  std::string expanded(std::string_view formula, const RadianceLocation& location) const;

 private:
  struct Body {
    std::vector<std::string> parameters{};
    std::string text{};
  };
  class Expansion;
  std::map<std::string, Body, std::less<>> bodies_;
};

}  // namespace lightwell
