#include "mesh/contacts/contact_graph.h"

#include <algorithm>

#include "scene/disjoint_sets.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

std::uint64_t ends_key(int a, int b) {
  return (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint64_t>(b);
}

// The entries of `all` that are not in `less`; both are ascending.
std::vector<int> without_atoms(const std::vector<int>& all, const std::vector<int>& less) {
  std::vector<int> rest;
  std::set_difference(all.begin(), all.end(), less.begin(), less.end(), std::back_inserter(rest));
  return rest;
}

}  // namespace

ContactGraph::ContactGraph(const Scene& scene, const std::vector<FacetPlane>& planes,
                           WeldedPoints points, const PatchSizes& sizes,
                           const std::vector<CriticalLine>& critical, double most_elements,
                           const Progress& progress)
    : planes_(planes),
      sizes_(sizes),
      welded_(std::move(points)),
      contact_segments_(planes.size()),
      lacks_contacts_(planes.size(), 0),
      crease_segments_(planes.size()) {
  segment_of_ends_.reserve(planes.size() + planes.size() / 2);  // two triangles share an edge
  add_boundaries();
  add_contacts(scene, progress);
  cuts_.resize(segments_.size());
  cut_at_crossings();
  cut_at_points();
  if (!critical.empty()) add_creases(critical, most_elements);
  make_atoms();
  size_atoms();
  count_pieces();
  divide();
}

int ContactGraph::segment(int a, int b) {
  if (a > b) std::swap(a, b);
  const auto [entry, is_new] =
      segment_of_ends_.try_emplace(ends_key(a, b), static_cast<int>(segments_.size()));
  if (is_new) segments_.push_back({.a = a, .b = b});
  return entry->second;
}

void ContactGraph::add_boundaries() {
  for (const FacetPlane& plane : planes_) {
    first_edge_.push_back(static_cast<int>(edge_segment_.size()));
    plane.for_each_edge([&](int i, int j) {
      const int s = segment(plane.point[i], plane.point[j]);
      edge_segment_.push_back(s);
      if (!plane.is_triangle()) return;
      const int apex = plane.point[3 - i - j];
      int* slot = segments_[s].triangle_apex;
      (slot[0] < 0 ? slot[0] : slot[1]) = apex;
    });
  }
}

std::vector<int> ContactGraph::chain(int segment) const {
  const Segment& s = segments_[segment];
  std::vector<int> chain{s.a};
  const auto append = [&chain](int point) {
    if (std::find(chain.begin(), chain.end(), point) == chain.end()) chain.push_back(point);
  };
  for (const auto& [t, point] : cuts_[segment]) {
    if (point != s.b) append(point);
  }
  append(s.b);
  return chain;
}

std::vector<FixedPiece> ContactGraph::fixed_pieces(int index) const {
  std::vector<int> segments(contact_segments_[index]);
  for (int e = 0; e < planes_[index].corner_count(); ++e) {
    segments.push_back(edge_segment_[first_edge_[index] + e]);
  }
  std::sort(segments.begin(), segments.end());
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
  std::vector<FixedPiece> pieces;
  for (const int s : segments) {
    const std::vector<int> points = chain(s);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const int a = points[k], b = points[k + 1];
      pieces.push_back({.a = a, .b = b, .from = welded_[a], .to = welded_[b], .segment = s});
    }
  }
  return pieces;
}

void ContactGraph::add_creases(const std::vector<CriticalLine>& critical, double most_elements) {
  std::vector<std::vector<FixedPiece>> fixed(planes_.size());
  for (const CriticalLine& line : critical) {
    if (fixed[line.plane].empty()) fixed[line.plane] = fixed_pieces(line.plane);
  }
  CreaseSelection selection(planes_, fixed,
                            {.element_size = sizes_.near().element_size(),
                             .tolerance = welded_.tolerance(),
                             .most_elements = most_elements});
  selection.select(critical);
  crease_counts_ = selection.counts();
  for (std::size_t p = 0; p < planes_.size(); ++p) {
    for (const auto& [from, to] : selection.creases(static_cast<int>(p))) {
      const int a = welded_.add(from, welded_.tolerance()),
                b = welded_.add(to, welded_.tolerance());
      if (a != b) crease_segments_[p].push_back(segment(a, b));
    }
    auto& list = crease_segments_[p];
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  cuts_.assign(segments_.size(), {});
  cut_at_crossings();
  cut_at_points();
}

void ContactGraph::make_atoms() {
  std::unordered_map<std::uint64_t, int> atom_of_ends;
  atom_of_ends.reserve(segments_.size());
  atoms_.reserve(segments_.size());
  atoms_of_segment_.resize(segments_.size());
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const std::vector<int> points = chain(static_cast<int>(i));
    atoms_of_segment_[i].reserve(points.size() - 1);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const int a = std::min(points[k], points[k + 1]), b = std::max(points[k], points[k + 1]);
      const auto [entry, is_new] =
          atom_of_ends.try_emplace(ends_key(a, b), static_cast<int>(atoms_.size()));
      if (is_new) atoms_.push_back({.a = a, .b = b});
      atoms_of_segment_[i].push_back(entry->second);
    }
  }
}

std::vector<int> ContactGraph::atoms_of_boundary(int index) const {
  std::vector<int> atoms;
  for (int e = 0; e < planes_[index].corner_count(); ++e) {
    const auto& of_edge = atoms_of_segment_[edge_segment_[first_edge_[index] + e]];
    atoms.insert(atoms.end(), of_edge.begin(), of_edge.end());
  }
  std::sort(atoms.begin(), atoms.end());
  return atoms;
}

std::vector<int> ContactGraph::atoms_of(const std::vector<int>& segments) const {
  std::vector<int> atoms;
  for (const int s : segments) {
    atoms.insert(atoms.end(), atoms_of_segment_[s].begin(), atoms_of_segment_[s].end());
  }
  std::sort(atoms.begin(), atoms.end());
  atoms.erase(std::unique(atoms.begin(), atoms.end()), atoms.end());
  return atoms;
}

std::vector<int> ContactGraph::contact_atoms(int index) const {
  if (contact_segments_[index].empty()) return {};
  return without_atoms(atoms_of(contact_segments_[index]), atoms_of_boundary(index));
}

std::vector<int> ContactGraph::crease_atoms(int index) const {
  if (crease_segments_[index].empty()) return {};
  return without_atoms(without_atoms(atoms_of(crease_segments_[index]), atoms_of_boundary(index)),
                       contact_atoms(index));
}

// Lines that lie in no facet of what is near are divided by the sizes along them. Pieces of the
// near size along such a line may be more than integers count.
void ContactGraph::size_atoms() {
  std::vector<char> is_near(atoms_.size(), sizes_.are_even() ? 1 : 0);
  const auto mark = [&](const std::vector<int>& atoms) {
    for (const int i : atoms) is_near[i] = 1;
  };
  for (std::size_t p = 0; p < planes_.size(); ++p) {
    if (sizes_.are_even() || !sizes_.is_near(planes_[p].facet)) continue;
    mark(atoms_of_boundary(static_cast<int>(p)));
    mark(atoms_of(contact_segments_[p]));
    mark(atoms_of(crease_segments_[p]));
  }
  for (std::size_t i = 0; i < atoms_.size(); ++i) {
    Atom& atom = atoms_[i];
    if (is_near[i]) {
      atom.pieces = sizes_.near().pieces((welded_[atom.a] - welded_[atom.b]).norm());
      continue;
    }
    atom.cuts = sizes_.cuts(welded_[atom.a], welded_[atom.b]);
    atom.pieces = static_cast<int>(atom.cuts.size()) + 1;
  }
}

// Opposite edges of four-sided facets get equal counts where their lengths nearly agree, so that a
// slightly trapezoidal wall is a grid of quadrilaterals. A contact line with two free ends gets a
// point of its own, at which the values on the line's two sides can differ.
void ContactGraph::count_pieces() {
  DisjointSets opposite(atoms_.size());
  const auto length = [&](int atom) {
    return (welded_[atoms_[atom].a] - welded_[atoms_[atom].b]).norm();
  };
  for (std::size_t f = 0; f < planes_.size(); ++f) {
    const std::vector<int> contacts = contact_atoms(static_cast<int>(f));
    std::unordered_map<int, int> degree;
    const auto count_ends = [&](const std::vector<int>& list) {
      for (int atom : list) ++degree[atoms_[atom].a], ++degree[atoms_[atom].b];
    };
    if (!contacts.empty()) {
      count_ends(contacts);
      count_ends(atoms_of_boundary(static_cast<int>(f)));
    }
    for (int c : contacts) {
      Atom& atom = atoms_[c];
      if (degree[atom.a] == 1 && degree[atom.b] == 1) atom.pieces = std::max(atom.pieces, 2);
    }
    if (planes_[f].corner_count() != 4 || planes_[f].loop_count() != 1) continue;
    for (int e = 0; e < 2; ++e) {
      const auto& one = atoms_of_segment_[edge_segment_[first_edge_[f] + e]];
      const auto& other = atoms_of_segment_[edge_segment_[first_edge_[f] + e + 2]];
      if (one.size() != 1 || other.size() != 1) continue;
      if (!atoms_[one[0]].cuts.empty() || !atoms_[other[0]].cuts.empty()) continue;
      const double ratio = length(one[0]) / length(other[0]);
      constexpr double nearly = 1.1;
      if (ratio < nearly && ratio * nearly > 1.0) opposite.join(one[0], other[0]);
    }
  }
  std::vector<int> most(atoms_.size(), 0);
  for (std::size_t i = 0; i < atoms_.size(); ++i) {
    int& m = most[opposite.root(static_cast<int>(i))];
    m = std::max(m, atoms_[i].pieces);
  }
  for (std::size_t i = 0; i < atoms_.size(); ++i) {
    if (!atoms_[i].cuts.empty()) continue;
    const int wanted = most[opposite.root(static_cast<int>(i))];
    // Limits the effect of a long chain of ever longer edges on its short end.
    if (wanted <= 1.25 * atoms_[i].pieces + sizes_.near().elements_per_edge) {
      atoms_[i].pieces = wanted;
    }
  }
}

void ContactGraph::divide() {
  points_ = welded_.all();
  for (Atom& atom : atoms_) {
    atom.first_division = static_cast<int>(points_.size());
    const Vector3d a = points_[atom.a], b = points_[atom.b];
    for (int k = 1; k < atom.pieces; ++k) {
      const double at = atom.cuts.empty() ? static_cast<double>(k) / atom.pieces
                                          : atom.cuts[static_cast<std::size_t>(k) - 1];
      points_.push_back(a + (b - a) * at);
    }
  }
}

FacetOutline ContactGraph::outline(int index) const {
  const FacetPlane& plane = planes_[index];
  FacetOutline outline;
  int edge = first_edge_[index];
  for (int l = 0; l < plane.loop_count(); ++l) {
    std::vector<int>& loop = outline.loops.emplace_back();
    for (int i = plane.loop_begin[l]; i < plane.loop_begin[l + 1]; ++i, ++edge) {
      const int s = edge_segment_[edge];
      std::vector<int> chain = atoms_of_segment_[s];
      int from = plane.point[i];
      if (from != segments_[s].a) std::reverse(chain.begin(), chain.end());
      for (int c : chain) {
        const Atom& atom = atoms_[c];
        const bool forward = from == atom.a;
        loop.push_back(from);
        for (int k = 0; k < atom.pieces - 1; ++k) {
          loop.push_back(atom.first_division + (forward ? k : atom.pieces - 2 - k));
        }
        from = forward ? atom.b : atom.a;
      }
    }
  }
  const auto add_pieces = [&](const std::vector<int>& atoms, std::vector<std::array<int, 2>>& to) {
    for (int c : atoms) {
      const Atom& atom = atoms_[c];
      int from = atom.a;
      for (int k = 0; k < atom.pieces - 1; ++k) {
        to.push_back({from, atom.first_division + k});
        from = atom.first_division + k;
      }
      to.push_back({from, atom.b});
    }
  };
  add_pieces(contact_atoms(index), outline.contacts);
  add_pieces(crease_atoms(index), outline.creases);
  return outline;
}

}  // namespace lightwell
