// The part of ContactGraph that finds the facets that touch or cross, their contact lines, and the
// lines where narrow gaps between facets begin.
#include <algorithm>
#include <numeric>
#include <utility>

#include "mesh/contacts/contact_effort.h"
#include "mesh/contacts/contact_graph.h"
#include "mesh/contacts/contact_lines.h"
#include "mesh/contacts/gap_lines.h"
#include "mesh/contacts/line_selection.h"
#include "mesh/geometry/box_tree.h"
#include "scene/parallel.h"
#include "scene/rays/float_rounding.h"
#include "scene/round_shape.h"

namespace lightwell {
using Eigen::Vector3d;

namespace {

constexpr int facet_batch = 4096;  // facets between two checks of the stop request

// Crossings of contact lines in all facets and per element, above which these are thinned out.
// Furnished rooms of 20 000 to 120 000 facets have one in 100 to 400 elements, an office with
// blinds has one in 5, and a staircase of 260 000 triangles has 1.4 per element.
constexpr double many_crossings = 4000.0, many_per_element = 3.0;
// Crossings that are then left: in all facets, per element, and in each facet at least.
constexpr double left_crossings = 1000.0, left_per_element = 0.1, left_in_facet = 4.0;

// A round shape, and the length of its elements.
struct CutShape {
  RoundShape shape{};
  double element = 0.0;
};

std::vector<CutShape> round_shapes_of(const Scene& scene, const PatchSizes& sizes) {
  std::vector<CutShape> shapes;
  const std::vector<FacetRef> facets = scene_facets(scene);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto shape = round_shape(scene.surfaces[static_cast<std::size_t>(facets[f].surface)]);
    if (!shape) continue;
    shapes.push_back({*shape, sizes.of_round_shape(static_cast<int>(f)).element_size()});
  }
  return shapes;
}

}  // namespace

/// The search for contacts of facets, numbered as the planes, with each other and with round
/// shapes, numbered behind the facets.
class ContactGraph::Search {
 public:
  struct Contact {
    int other = 0;
    ContactSegment segment{};

    double length() const { return (segment[1] - segment[0]).norm(); }
  };

  Search(const Scene& scene, const ContactGraph& graph)
      : planes_(graph.planes_),
        round_shapes_(round_shapes_of(scene, graph.sizes_)),
        tolerance_(graph.welded_.tolerance()),
        boxes_(boxes()),
        tree_(boxes_) {}

  /// Numbers of the facets and round shapes whose boxes meet that of facet i, ascending.
  void find_near(int i, std::vector<int>& near) const {
    tree_.find_overlaps(boxes_[static_cast<std::size_t>(i)], near);
  }

  /// Numbers of the others in find_near() that follow facet i. Returns how many find_near() would
  /// have on an average over all facets: two facets are near each other, and each is near itself.
  std::size_t find_following(int i, std::vector<int>& near) const {
    tree_.find_overlaps_from(i + 1, boxes_[static_cast<std::size_t>(i)], near);
    const auto count = static_cast<int>(planes_.size());
    const auto facets = std::ranges::lower_bound(near, count) - near.begin();
    return 1 + near.size() + static_cast<std::size_t>(facets);
  }

  /// Keeps the `most` largest of `near` and returns true if there are more.
  bool keep_largest(std::size_t most, std::vector<int>& near) const {
    if (near.size() <= most) return false;
    const auto diagonal = [&](int i) {
      return boxes_[static_cast<std::size_t>(i)].sizes().squaredNorm();
    };
    const auto end = near.begin() + static_cast<std::ptrdiff_t>(most);
    std::nth_element(near.begin(), end, near.end(), [&](int a, int b) {
      return std::pair(-diagonal(a), a) < std::pair(-diagonal(b), b);
    });
    near.erase(end, near.end());
    std::sort(near.begin(), near.end());
    return true;
  }

  /// Appends the contacts of facet i with j, a facet or a round shape.
  void add(int i, int j, std::vector<Contact>& contacts) const {
    // A circle much smaller than an element would only make slivers (radius as a share of an
    // element).
    constexpr double least_circle = 0.05;
    const auto count = static_cast<int>(planes_.size());
    const auto plane = [&](int f) -> const FacetPlane& {
      return planes_[static_cast<std::size_t>(f)];
    };
    std::vector<ContactSegment> segments;
    if (j < count) {
      segments = facet_contact(plane(std::min(i, j)), plane(std::max(i, j)), tolerance_);
    } else {
      const auto& [shape, element] = round_shapes_[static_cast<std::size_t>(j - count)];
      segments = round_contact(plane(i), shape, element, least_circle * element, tolerance_);
    }
    for (const ContactSegment& segment : segments) contacts.push_back({j, segment});
  }

  /// Calls find(i, near, contacts) for all facets, many at once, with scratch for find_near(). Then
  /// calls take(i, contact) in order, until take returns false; returns whether it never did.
  template <class Find, class Take>
  bool in_batches(const Progress& progress, Find find, Take take) const {
    const int count = static_cast<int>(planes_.size());
    for (int begin = 0; begin < count; begin += facet_batch) {
      report(progress, "mesh", 0.3 * begin / count);
      const int size = std::min(count - begin, facet_batch);
      std::vector<std::vector<Contact>> contacts(static_cast<std::size_t>(size));
      parallel_for(size, 8, [&](int from, int to) {
        std::vector<int> near;
        for (int k = from; k < to; ++k) {
          find(begin + k, near, contacts[static_cast<std::size_t>(k)]);
        }
      });
      for (int k = 0; k < size; ++k) {
        for (const Contact& contact : contacts[static_cast<std::size_t>(k)]) {
          if (!take(begin + k, contact)) return false;
        }
      }
    }
    return true;
  }

 private:
  std::vector<BoxTree::Box> boxes() const {
    std::vector<BoxTree::Box> boxes;
    for (const FacetPlane& plane : planes_) {
      const Vector3d d = Vector3d::Constant(tolerance_);
      boxes.emplace_back(plane.box.min() - d, plane.box.max() + d);
    }
    for (const CutShape& round : round_shapes_) boxes.push_back(bounds(round.shape));
    return boxes;
  }

  const std::vector<FacetPlane>& planes_;
  std::vector<CutShape> round_shapes_;
  double tolerance_;
  std::vector<BoxTree::Box> boxes_;
  BoxTree tree_;
};

void ContactGraph::add_contacts(const Scene& scene, const Progress& progress) {
  const int corners = welded_.size();
  const Search search(scene, *this);
  ContactEffort effort(static_cast<int>(planes_.size()));
  if (!add_all_contacts(search, effort, progress)) {
    remove_contacts(corners);
    add_longest_contacts(search, effort, progress);
  }
  add_gap_lines();
  sort_contacts();
  thin_out_contacts(corners);
}

// Leaves the boundaries alone, whose points are the first `corners`.
void ContactGraph::remove_contacts(int corners) {
  welded_.keep_first(corners);
  const int boundaries = *std::max_element(edge_segment_.begin(), edge_segment_.end()) + 1;
  segments_.resize(static_cast<std::size_t>(boundaries));
  std::erase_if(segment_of_ends_, [&](const auto& entry) { return entry.second >= boundaries; });
  contact_segments_.assign(planes_.size(), {});
}

void ContactGraph::add_contact(int index, const std::array<Vector3d, 2>& ends) {
  const int a = welded_.add(ends[0], welded_.tolerance());
  const int b = welded_.add(ends[1], welded_.tolerance());
  if (a != b) contact_segments_[static_cast<std::size_t>(index)].push_back(segment(a, b));
}

bool ContactGraph::add_all_contacts(const Search& search, ContactEffort& effort,
                                    const Progress& progress) {
  const int count = static_cast<int>(planes_.size());
  const auto find = [&](int i, std::vector<int>& near, std::vector<Search::Contact>& found) {
    if (effort.is_exceeded()) return;
    effort.count(search.find_following(i, near));
    for (const int j : near) {
      search.add(i, j, found);
      if (effort.is_exceeded()) break;
    }
    effort.found(found.size());
  };
  return search.in_batches(progress, find, [&](int i, const Search::Contact& contact) {
    if (effort.is_exceeded()) return false;
    add_contact(i, contact.segment);
    if (contact.other < count) add_contact(contact.other, contact.segment);
    return true;
  }) && !effort.is_exceeded();
}

void ContactGraph::add_longest_contacts(const Search& search, const ContactEffort& effort,
                                        const Progress& progress) {
  const auto find = [&](int i, std::vector<int>& near, std::vector<Search::Contact>& found) {
    char& lacks = lacks_contacts_[static_cast<std::size_t>(i)];
    search.find_near(i, near);
    std::erase(near, i);
    if (search.keep_largest(effort.pairs_of_facet(), near)) lacks = 1;
    for (const int j : near) search.add(i, j, found);
    if (found.size() <= effort.contacts_of_facet()) return;
    lacks = 1;
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.length() > b.length(); });
    found.resize(effort.contacts_of_facet());
    found.shrink_to_fit();
  };
  search.in_batches(progress, find, [&](int i, const Search::Contact& contact) {
    add_contact(i, contact.segment);
    return true;
  });
}

// Facets keep their longest contact lines where these cross in too many places. A pile of n sheets
// that all cross has n^3 crossings, each of which makes elements, whatever their size should be.
void ContactGraph::thin_out_contacts(int corners) {
  const int count = static_cast<int>(planes_.size());
  std::vector<double> elements;
  for (const FacetPlane& plane : planes_) {
    elements.push_back(sizes_.elements(sizes_.of_facet(plane.facet, plane.box), plane.area(),
                                       plane.boundary_length()));
  }
  const double all_elements = std::accumulate(elements.begin(), elements.end(), 0.0);
  const double many = std::max(many_crossings, many_per_element * all_elements);
  const double left = std::max(left_crossings, left_per_element * all_elements);
  std::vector<std::size_t> crossings(planes_.size(), 0);
  parallel_for(count, 32, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      crossings[static_cast<std::size_t>(i)] =
          count_crossings(contact_lines(i), static_cast<std::size_t>(many));
    }
  });
  if (std::accumulate(crossings.begin(), crossings.end(), 0.0) <= many) return;
  std::vector<std::vector<std::array<Vector3d, 2>>> kept(planes_.size());
  parallel_for(count, 32, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double share = std::max(left_in_facet, left * elements[i] / all_elements);
      const std::vector<char> is_kept =
          longest_lines(contact_lines(k), static_cast<std::size_t>(share));
      for (std::size_t l = 0; l < is_kept.size(); ++l) {
        const Segment& line = segments_[static_cast<std::size_t>(contact_segments_[i][l])];
        if (is_kept[l]) kept[i].push_back({welded_[line.a], welded_[line.b]});
      }
      if (kept[i].size() < is_kept.size()) lacks_contacts_[i] = 1;
    }
  });
  remove_contacts(corners);
  for (int i = 0; i < count; ++i) {
    for (const auto& ends : kept[static_cast<std::size_t>(i)]) add_contact(i, ends);
  }
  sort_contacts();
}

std::vector<FlatLine> ContactGraph::contact_lines(int index) const {
  const auto i = static_cast<std::size_t>(index);
  std::vector<FlatLine> lines;
  for (const int s : contact_segments_[i]) {
    const Segment& segment = segments_[static_cast<std::size_t>(s)];
    lines.push_back(
        {{segment.a, segment.b},
         {planes_[i].project(welded_[segment.a]), planes_[i].project(welded_[segment.b])}});
  }
  return lines;
}

// Adds the lines where gaps begin that are narrow against an element. Facets are wide enough to
// cover such a gap, of which there are few however finely a scene is divided, or lie so near to
// another that rays take both for one plane, but not so near that they touch.
void ContactGraph::add_gap_lines() {
  constexpr double narrow = 0.1, least_width = 0.2, least_length = 1.0;  // in elements
  const double element = sizes_.near().element_size();
  std::vector<Eigen::AlignedBox3d> facets;
  for (const FacetPlane& plane : planes_) facets.push_back(plane.box);
  if (facets.empty()) return;
  // Rays are as exact in what is near as without a backdrop.
  const double touching = coplanar_roundings * ray_rounding(scenery_box(facets).diagonal().norm());
  const GapLimits limits{.narrowest = welded_.tolerance(),
                         .widest = std::max(narrow * element, touching),
                         .least_width = least_width * element,
                         .least_length = least_length * element,
                         .touching = touching};
  std::vector<int> wide;
  std::vector<BoxTree::Box> boxes;  // of what the facets cover
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    if (!(widest_covered(planes_[i], limits) > limits.narrowest)) continue;
    wide.push_back(static_cast<int>(i));
    const Vector3d d = Vector3d::Constant(widest_covered(planes_[i], limits));
    boxes.emplace_back(planes_[i].box.min() - d, planes_[i].box.max() + d);
  }
  const BoxTree tree(boxes);
  std::vector<std::vector<ContactSegment>> lines(wide.size());
  parallel_for(static_cast<int>(wide.size()), 32, [&](int begin, int end) {
    std::vector<int> near;
    for (int k = begin; k < end; ++k) {
      const auto i = static_cast<std::size_t>(k);
      tree.find_overlaps(planes_[static_cast<std::size_t>(wide[i])].box, near);
      for (const int other : near) {
        if (other == k) continue;
        const FacetPlane& over = planes_[static_cast<std::size_t>(wide[other])];
        for (const ContactSegment& line :
             gap_lines(planes_[static_cast<std::size_t>(wide[i])], over, limits)) {
          lines[i].push_back(line);
        }
      }
    }
  });
  for (std::size_t k = 0; k < wide.size(); ++k) {
    for (const auto& [from, to] : lines[k]) {
      add_contact(wide[k], {from, to});
    }
  }
}

void ContactGraph::sort_contacts() {
  for (auto& list : contact_segments_) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

}  // namespace lightwell
