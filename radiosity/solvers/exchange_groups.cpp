#include "radiosity/solvers/exchange_groups.h"

#include <algorithm>
#include <numeric>

namespace lightwell {

ExchangeGroups::ExchangeGroups(const FormFactors& form_factors, const std::vector<int>& behind) {
  const int n = form_factors.patch_count();
  std::vector<int> parent(static_cast<std::size_t>(n));
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  int apart = 0;  // remaining groups of patches that see any other
  std::vector<char> sees(static_cast<std::size_t>(n), 0);
  for (int i = 0; i < n; ++i) {
    sees[i] = !form_factors.row(i).empty() || !form_factors.specular_row(i).patch.empty();
    apart += sees[i];
  }
  for (int i = 0; i < n && apart > 1; ++i) {  // a few rows usually join all patches
    int own = root(i);
    const auto join = [&](int j) {
      if (parent[j] == own) return;
      const int other = root(j);
      if (other == own) return;
      if (sees[i] && sees[j]) --apart;
      parent[std::max(own, other)] = std::min(own, other);
      own = std::min(own, other);
    };
    for (const FormFactor& f : form_factors.row(i)) join(f.patch);
    for (const int j : form_factors.specular_row(i).patch) join(j);
    if (!behind.empty() && behind[i] >= 0) join(behind[i]);
  }
  group_of.resize(parent.size());
  for (int i = 0; i < n; ++i) {
    const int first = root(i);  // never above i
    group_of[i] = first == i ? count++ : group_of[first];
  }
}

}  // namespace lightwell
