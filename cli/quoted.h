#pragma once

#include <string>

namespace lightwell {

/// `word` as one word of a shell command: in single quotes if it is empty or has characters that a
/// shell might interpret.
std::string quoted(const std::string& word);

}  // namespace lightwell
