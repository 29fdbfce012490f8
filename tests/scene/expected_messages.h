#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scene/errors.h"

namespace lightwell::test {

/// Expects an InputError from `call` whose message has all `parts`.
template <class Call>
void expect_message(Call&& call, const std::vector<std::string>& parts) {
  try {
    call();
    FAIL() << "no error that says " << parts.front();
  } catch (const InputError& error) {
    for (const std::string& part : parts) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
          << error.what() << " lacks " << part;
    }
  }
}

}  // namespace lightwell::test
