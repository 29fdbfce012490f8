#include "radiosity/visibility/pair_shafts.h"

#include <algorithm>

#include "scene/parallel.h"

namespace lightwell {

PairShafts::PairShafts(const ElementCaster& caster, const std::vector<PatchOutline>& outlines)
    : mesh_(caster.mesh()),
      shafts_(mesh_),
      ends_(outlines.size()),
      is_covered_(outlines.size()),
      is_hidden_(outlines.size()) {
  parallel_for(mesh_.patch_count(), 64, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      ends_[i] = shafts_.end(outlines[i], mesh_.facet_of(i));
      const int hidden = caster.hidden_elements(i);
      is_hidden_[i] = hidden == mesh_.first_element[i + 1] - mesh_.first_element[i];
      is_covered_[i] = hidden > 0 || shafts_.is_covered(ends_[i]);
    }
  });
}

std::int64_t PairShafts::bytes_for(const PatchMesh& mesh) {
  constexpr std::int64_t corners = 4, allocation = 16;
  constexpr std::int64_t end =
      sizeof(ShaftEnd) + sizeof(ConvexPolygon) + corners * sizeof(Eigen::Vector3d) + 2 * allocation;
  constexpr std::int64_t in_tree = 2 * sizeof(Eigen::AlignedBox3d);
  std::int64_t facets = 0;
  for (const int facet : mesh.facet) facets = std::max<std::int64_t>(facets, facet + 1);
  return mesh.patch_count() * end + facets * (std::int64_t{sizeof(Occluder)} + in_tree);
}

void PairShafts::find(int i, int j, Between& between) const {
  shafts_.find(ends_[i], ends_[j], between);
}

bool PairShafts::has_exact(int i, int j, const Between& between) const {
  return !between.may_be_round && between.pieces.size() <= most_pieces_between &&
         !ends_[i].parts.empty() && !ends_[j].parts.empty();
}

std::optional<VisibleExchange> PairShafts::visible(int i, int j, const Between& between,
                                                   double unoccluded, double tolerance) const {
  if (!has_exact(i, j, between)) return {};
  const bool i_is_smaller = mesh_.area[i] <= mesh_.area[j];
  const int from = i_is_smaller ? i : j, to = i_is_smaller ? j : i;
  return visible_exchange(shafts_, ends_[from], ends_[to], between.pieces, unoccluded,
                          tolerance * mesh_.area[from]);
}

}  // namespace lightwell
