#include "radiosity/solvers/exchange_groups.h"

#include <algorithm>

#include "scene/disjoint_sets.h"

namespace lightwell {

ExchangeGroups::ExchangeGroups(const FormFactors& form_factors, const std::vector<int>& behind) {
  const int n = form_factors.patch_count();
  DisjointSets groups(static_cast<std::size_t>(n));
  int apart = 0;  // remaining groups of patches that see any other
  std::vector<char> sees(static_cast<std::size_t>(n), 0);
  for (int i = 0; i < n; ++i) {
    sees[i] = !form_factors.row(i).empty() || !form_factors.specular_row(i).patch.empty();
    apart += sees[i];
  }
  for (int i = 0; i < n && apart > 1; ++i) {  // a few rows usually join all patches
    int own = groups.root(i);
    const auto join = [&](int j) {
      const int other = groups.root(j);
      if (other == own) return;
      if (sees[i] && sees[j]) --apart;
      own = groups.join(own, other);
    };
    for (const FormFactor& f : form_factors.row(i)) join(f.patch);
    for (const int j : form_factors.specular_row(i).patch) join(j);
    if (!behind.empty() && behind[i] >= 0) join(behind[i]);
  }
  group_of.resize(groups.size());
  for (int i = 0; i < n; ++i) {
    const int first = groups.root(i);  // never above i
    group_of[i] = first == i ? count++ : group_of[first];
  }
}

}  // namespace lightwell
