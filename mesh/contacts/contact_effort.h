#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "scene/scene.h"

namespace lightwell {

/// Counts the pairs of facets and edges that lie close together and the contacts among them, and
/// throws InputError where the counts exceed what time and memory allow: n sheets on one another
/// meet in n^2 places. The limits are 10^9 pairs, and 100 contacts per facet but at least 10^6 and
/// at most 10^7. The outcome does not depend on the number of threads.
class ContactEffort {
 public:
  ContactEffort(const Scene& scene, int facets);

  /// Adds to the count of pairs. Throws InputError above the limit.
  void count(std::size_t pairs);
  /// Adds to the count of contacts. Throws InputError above the limit.
  void found(std::size_t contacts);

 private:
  const Scene& scene_;
  std::int64_t most_contacts_;
  std::atomic<std::int64_t> pairs_{0}, contacts_{0};
};

}  // namespace lightwell
