#include "radiosity/parts/exchange_graph.h"

#include <algorithm>

namespace lightwell {

ExchangeGraph::ExchangeGraph(std::vector<double> area, std::span<const ExchangeLink> links)
    : area_(std::move(area)), first_(area_.size() + 1, 0) {
  for (const ExchangeLink& link : links) {
    if (link.a == link.b) continue;
    ++first_[static_cast<std::size_t>(link.a) + 1];
    ++first_[static_cast<std::size_t>(link.b) + 1];
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  neighbors_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const ExchangeLink& link : links) {
    if (link.a == link.b) continue;
    neighbors_[next[static_cast<std::size_t>(link.a)]++] = {link.b, link.exchange};
    neighbors_[next[static_cast<std::size_t>(link.b)]++] = {link.a, link.exchange};
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < area_.size(); ++i) {
    const auto begin = neighbors_.begin() + static_cast<std::ptrdiff_t>(first_[i]),
               end = neighbors_.begin() + static_cast<std::ptrdiff_t>(first_[i + 1]);
    std::stable_sort(begin, end,
                     [](const Neighbor& a, const Neighbor& b) { return a.node < b.node; });
    first_[i] = kept;
    double sum = 0.0;
    for (auto it = begin; it != end; ++it) {
      sum += double{it->exchange};
      if (kept > first_[i] && neighbors_[kept - 1].node == it->node) {
        neighbors_[kept - 1].exchange += it->exchange;
      } else {
        neighbors_[kept++] = *it;
      }
    }
    area_[i] = std::max(area_[i], sum);
  }
  first_.back() = kept;
  neighbors_.resize(kept);
  neighbors_.shrink_to_fit();
}

}  // namespace lightwell
