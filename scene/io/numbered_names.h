#pragma once

#include <map>
#include <set>
#include <string>

namespace lightwell {

/// Distinguishes equal names by a number: "lamp", "lamp 2", "lamp 3".
class NumberedNames {
 public:
  /// Returns `name`, or the first of its numbered forms that was not returned before.
  std::string unique(const std::string& name) {
    std::string result = name;
    int& times = times_named_.emplace(name, 1).first->second;
    while (!given_.insert(result).second) result = name + " " + std::to_string(++times);
    return result;
  }

 private:
  std::map<std::string, int> times_named_;
  std::set<std::string> given_;
};

}  // namespace lightwell
