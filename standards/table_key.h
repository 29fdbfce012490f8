#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace lightwell {

/// A key of a table of limits, and who asks for it.
struct AskedKey {
  std::string key{};
  std::string asked_by{};  ///< "area 'desk'"
  std::string noun{};      ///< of an entry: "activity"
  std::string option{};    ///< that reads another table: "--activities"
};

/// Throws InputError: the table, which has `known`, has no such key; with the nearest key.
[[noreturn]] void refuse_key(const AskedKey& asked, const std::vector<std::string>& known);

/// The entry of a table whose member `key` is that asked for. Throws what refuse_key() throws.
template <class Entry>
const Entry& find_entry(const std::vector<Entry>& table, const AskedKey& asked) {
  const auto at = std::ranges::find(table, asked.key, &Entry::key);
  if (at != table.end()) return *at;
  std::vector<std::string> known;
  for (const Entry& entry : table) known.push_back(entry.key);
  refuse_key(asked, known);
}

}  // namespace lightwell
