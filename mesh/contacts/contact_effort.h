#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "scene/scene.h"

namespace lightwell {

/// Counts what there is to do about facets that touch and cross, and throws InputError where nobody
/// has the time or the memory: a million sheets on one another meet in a million million places.
/// Bounds are 10^9 pairs that lie close together, and 100 contacts a facet, at least 10^6 and at
/// most 10^7. Whether they are passed does not depend on the number of threads.
class ContactEffort {
 public:
  ContactEffort(const Scene& scene, int facets);

  void count(std::size_t pairs);
  void found(std::size_t contacts);

 private:
  const Scene& scene_;
  std::int64_t most_contacts_;
  std::atomic<std::int64_t> pairs_{0}, contacts_{0};
};

}  // namespace lightwell
