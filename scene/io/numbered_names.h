#pragma once

#include <map>
#include <set>
#include <string>

namespace lightwell {

/// `name` without what is beyond its first bytes: copies repeat the names of what they copy.
inline std::string shortened(std::string name, std::size_t longest = 250) {
  if (name.size() <= longest) return name;
  std::size_t end = longest;
  const auto continues = [&](std::size_t i) {  // a character of UTF-8
    return (static_cast<unsigned char>(name[i]) & 0xC0u) == 0x80u;
  };
  while (end > 0 && continues(end)) --end;
  name.resize(end);
  return name;
}

/// Distinguishes equal names by a number: "lamp", "lamp 2", "lamp 3".
class NumberedNames {
 public:
  /// Returns `wanted`, shortened, or the first of its numbered forms that was not returned before.
  std::string unique(const std::string& wanted) {
    const std::string name = shortened(wanted);
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
