#include "scene/io/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/io/text_file.h"

namespace lightwell {
namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string did_you_mean(std::string_view given, const std::vector<std::string>& known) {
  // Names are short words; the table of edit distances is quadratic.
  constexpr std::size_t longest = 64;
  if (given.size() > longest) return {};
  // At most about a third of the letters may differ: "reflectivity" still finds "reflectance", "x"
  // finds nothing.
  std::size_t best = given.size() / 3 + 2;
  const std::string* nearest = nullptr;
  for (const std::string& name : known) {
    if (name.size() > longest) continue;
    const std::size_t distance = edit_distance(lower_case(given), lower_case(name));
    if (distance < best && distance < std::max(given.size(), name.size())) {
      best = distance;
      nearest = &name;
    }
  }
  return nearest ? fmt::format(" Did you mean '{}'?", *nearest) : std::string();
}

}  // namespace lightwell
