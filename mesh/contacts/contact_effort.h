#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace lightwell {

/// Counts the pairs of facets and edges that lie close together and the contacts among them, up to
/// what time and memory allow: n sheets on one another meet in n^2 places. The limits are 100 pairs
/// per facet but at least 10^8, and 100 contacts per facet but at least 10^6 and at most 10^7.
/// Whether they are exceeded does not depend on the number of threads.
class ContactEffort {
 public:
  explicit ContactEffort(int facets);

  void count(std::size_t pairs) { pairs_ += static_cast<std::int64_t>(pairs); }
  void found(std::size_t contacts) { contacts_ += static_cast<std::int64_t>(contacts); }
  /// True above a limit; once true, further work is in vain.
  bool is_exceeded() const { return pairs_ > most_pairs_ || contacts_ > most_contacts_; }

  /// The share of one facet in a tenth of the pairs, and in all contacts: what the search is
  /// restricted to once a limit is exceeded.
  std::size_t pairs_of_facet() const;
  std::size_t contacts_of_facet() const;

 private:
  std::int64_t facets_, most_pairs_, most_contacts_;
  std::atomic<std::int64_t> pairs_{0}, contacts_{0};
};

}  // namespace lightwell
