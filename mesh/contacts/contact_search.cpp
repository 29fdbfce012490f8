// The part of ContactGraph that finds the facets that touch or cross, their contact lines, and the
// lines where narrow gaps between facets begin.
#include <algorithm>

#include "mesh/contacts/contact_effort.h"
#include "mesh/contacts/contact_graph.h"
#include "mesh/contacts/contact_lines.h"
#include "mesh/contacts/gap_lines.h"
#include "mesh/geometry/box_tree.h"
#include "scene/parallel.h"

namespace lightwell {
using Eigen::Vector3d;

void ContactGraph::add_contacts(const Scene& scene, const Progress& progress) {
  const double tolerance = welded_.tolerance();
  std::vector<BoxTree::Box> boxes;
  for (const FacetPlane& plane : planes_) {
    const Vector3d d = Vector3d::Constant(tolerance);
    boxes.emplace_back(plane.box.min() - d, plane.box.max() + d);
  }
  std::vector<Sphere> spheres;
  for (const Surface& surface : scene.surfaces) {
    if (const auto* sphere = std::get_if<Sphere>(&surface.shape)) spheres.push_back(*sphere);
  }
  for (const Sphere& s : spheres) {
    const Vector3d r = Vector3d::Constant(s.radius);
    boxes.push_back({s.center - r, s.center + r});
  }
  const BoxTree tree(boxes);

  const int count = static_cast<int>(planes_.size());
  ContactEffort effort(scene, count);
  struct Contact {
    int other;
    ContactSegment segment;
  };
  constexpr int batch = 4096;  // facets between two checks of the stop request
  for (int begin = 0; begin < count; begin += batch) {
    report(progress, "mesh", 0.3 * begin / count);
    const int end = std::min(count, begin + batch);
    std::vector<std::vector<Contact>> contacts(end - begin);
    parallel_for(end - begin, 32, [&](int from, int to) {
      std::vector<int> near;
      for (int k = from; k < to; ++k) {
        const int i = begin + k;
        tree.find_overlaps(boxes[i], near);
        effort.count(near.size());
        for (int j : near) {
          if (j <= i) continue;
          // A circle much smaller than an element would only make slivers (radius as a share of an
          // element).
          constexpr double least_circle = 0.05;
          const auto segments =
              j < count ? facet_contact(planes_[i], planes_[j], tolerance)
                        : sphere_contact(planes_[i], spheres[j - count], size_.element_size(),
                                         least_circle * size_.element_size(), tolerance);
          if (!segments.empty()) effort.found(segments.size());
          for (const auto& segment : segments) contacts[k].push_back({j, segment});
        }
      }
    });
    for (int k = 0; k < end - begin; ++k) {
      for (const Contact& contact : contacts[k]) {
        const int a = welded_.add(contact.segment[0], tolerance);
        const int b = welded_.add(contact.segment[1], tolerance);
        if (a == b) continue;
        const int s = segment(a, b);
        contact_segments_[begin + k].push_back(s);
        if (contact.other < count) contact_segments_[contact.other].push_back(s);
      }
    }
  }
  sort_contacts();
}

// Adds the lines where gaps begin that are narrow against an element. Only facets that are wide
// enough to cover a gap are compared, of which there are few however finely a scene is divided.
void ContactGraph::add_gap_lines() {
  constexpr double narrow = 0.1, least_width = 0.2;  // shares of an element
  const double element = size_.element_size();
  const GapLimits limits{.narrowest = 2.0 * welded_.tolerance(),
                         .widest = narrow * element,
                         .least_width = least_width * element};
  if (!(limits.widest > limits.narrowest)) return;
  std::vector<int> wide;
  std::vector<BoxTree::Box> boxes;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    if (!covers_gaps(planes_[i], limits)) continue;
    wide.push_back(static_cast<int>(i));
    const Vector3d d = Vector3d::Constant(0.5 * limits.widest);
    boxes.emplace_back(planes_[i].box.min() - d, planes_[i].box.max() + d);
  }
  const BoxTree tree(boxes);
  std::vector<std::vector<ContactSegment>> lines(wide.size());
  parallel_for(static_cast<int>(wide.size()), 32, [&](int begin, int end) {
    std::vector<int> near;
    for (int k = begin; k < end; ++k) {
      const auto i = static_cast<std::size_t>(k);
      tree.find_overlaps(boxes[i], near);
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
      const int a = welded_.add(from, welded_.tolerance());
      const int b = welded_.add(to, welded_.tolerance());
      if (a != b) contact_segments_[static_cast<std::size_t>(wide[k])].push_back(segment(a, b));
    }
  }
  sort_contacts();
}

void ContactGraph::sort_contacts() {
  for (auto& list : contact_segments_) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

}  // namespace lightwell
