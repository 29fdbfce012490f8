#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "scene/errors.h"
#include "validation/validate.h"

namespace lightwell::test {

/// A case of given values.
inline ValidationCase made_up_case(const std::string& id, ComparedValues values) {
  return {.id = id,
          .group = "made up",
          .title = "a title with < and |",
          .source = "thin air",
          .reason = "none",
          .compute = [values](const Progress&) { return values; }};
}

/// A case that passes, one that fails, one that throws, and one that cannot be run.
inline std::vector<ValidationCase> made_up_cases() {
  std::vector<ValidationCase> cases = {
      made_up_case("right", {{"a", 1.0, 1.0, 0.1}, {"b", 2.0, 2.05, 0.1}}),
      made_up_case("wrong", {{"", 1.0, 1.3, 0.1}}), made_up_case("broken", {}),
      made_up_case("missing", {})};
  cases[0].published = {{"b", "Another program", 2.2, "a paper", "its cosine is not one"}};
  cases[2].compute = [](const Progress&) -> ComparedValues {
    throw std::runtime_error("the lamp is out");
  };
  cases[3].compute = {};
  cases[3].note = "nothing here can do that";
  return cases;
}

}  // namespace lightwell::test
