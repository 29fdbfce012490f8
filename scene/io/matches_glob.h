#pragma once

#include <fnmatch.h>

#include <string>

namespace lightwell {

/// True if a name is `glob`, or fits it as in a shell: `*` stands for any text, `?` for one
/// character and `[ab]` for one of several characters.
inline bool matches_glob(const std::string& glob, const std::string& name) {
  return glob == name || fnmatch(glob.c_str(), name.c_str(), 0) == 0;
}

}  // namespace lightwell
