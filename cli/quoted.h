#pragma once

#include <string>

namespace lightwell {

/// As a shell takes it for one word: in quotes if there is anything in it that means something
/// else.
std::string quoted(const std::string& word);

}  // namespace lightwell
