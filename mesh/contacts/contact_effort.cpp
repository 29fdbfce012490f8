#include "mesh/contacts/contact_effort.h"

#include <algorithm>

namespace lightwell {
namespace {

constexpr std::int64_t per_facet = 100;
constexpr std::int64_t least_pairs = 100'000'000;
constexpr std::int64_t least_contacts = 1'000'000, most_contacts = 10'000'000;

}  // namespace

ContactEffort::ContactEffort(int facets)
    : facets_(std::max(1, facets)),
      most_pairs_(std::max(per_facet * facets_, least_pairs)),
      most_contacts_(std::clamp(per_facet * facets_, least_contacts, most_contacts)) {}

std::size_t ContactEffort::pairs_of_facet() const {
  constexpr std::int64_t share = 10, least = 64;
  return static_cast<std::size_t>(std::max(least, most_pairs_ / share / facets_));
}

std::size_t ContactEffort::contacts_of_facet() const {
  constexpr std::int64_t least = 32;
  return static_cast<std::size_t>(std::max(least, most_contacts_ / facets_));
}

}  // namespace lightwell
