#include "mesh/contacts/contact_effort.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "scene/errors.h"

namespace lightwell {
namespace {

constexpr std::int64_t contacts_per_facet = 100;
constexpr std::int64_t least_contacts = 1'000'000;
constexpr std::int64_t most_contacts = 10'000'000;
constexpr std::int64_t most_pairs = 1'000'000'000;

[[noreturn]] void refuse(const Scene& scene, const std::string& why) {
  throw InputError(fmt::format("{}{}{}; remove copies, and what lies on or inside one another",
                               scene.file.string(), scene.file.empty() ? "" : ": ", why));
}

}  // namespace

ContactEffort::ContactEffort(const Scene& scene, int facets)
    : scene_(scene),
      most_contacts_(std::clamp(contacts_per_facet * facets, least_contacts, most_contacts)) {}

void ContactEffort::count(std::size_t pairs) {
  if ((pairs_ += static_cast<std::int64_t>(pairs)) <= most_pairs) return;
  refuse(scene_, fmt::format("more than {} million pairs of polygons or their edges lie close "
                             "together",
                             most_pairs / 1'000'000));
}

void ContactEffort::found(std::size_t contacts) {
  if ((contacts_ += static_cast<std::int64_t>(contacts)) <= most_contacts_) return;
  refuse(scene_, fmt::format("the polygons touch, overlap or cross in more than {:.3g} million "
                             "places",
                             static_cast<double>(most_contacts_) / 1e6));
}

}  // namespace lightwell
