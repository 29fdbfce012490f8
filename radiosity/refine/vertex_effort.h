#pragma once

#include <cstdint>
#include <vector>

#include "mesh/elements/refine_elements.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/refine/interpolated_vertices.h"
#include "radiosity/refine/refine_options.h"

namespace lightwell {

/// Rays of the pilot gathers at the vertices of refined elements, and the noise that the light of
/// the sky may have there.
///
/// Each of the two pilot gathers casts a share of the final gather's rays, rounded up to a power of
/// two:
/// - an eighth;
/// - a sixteenth, but 64 at least, if the noise of the final gather has a goal;
/// - a sixteenth if there are more than 32 768 vertices at the start;
/// - down to a quarter of that at the smallest elements of the start;
/// - down to an eighth at vertices of SharedGathers::read, or two, four or eight times that, while
///   these vertices take no more than half of the rays of the start's final gather.
///
/// The light of the sky has a multiple of the noise asked for at the vertices of small elements, if
/// the elements of the start leave little room for others: refinement of few elements does not get
/// near its tolerance in most scenes, and exact light at all of the start's vertices would be in
/// vain. Where refinement does get near, the multiple becomes 1 (see sharpen_sky()).
///
/// Vertices are numbered as in RefinedElements; keeps a reference to `elements`.
class VertexEffort {
 public:
  /// `read` lists the vertices that share gathers (SharedGathers::read).
  VertexEffort(const RefinedElements& elements, const GatherOptions& gather,
               const RefineOptions& refine, bool has_dome,
               const std::vector<InterpolatedVertex>& read);

  /// True if the noise of the final gather has a goal.
  bool has_noise_goal() const { return has_noise_goal_; }
  /// Rays of the final gather in each part.
  const std::vector<int>& rays_of_part() const { return rays_of_part_; }
  /// Most rays of the final gather in any part.
  int most_rays() const;
  /// Chooses the rays of the final gather by the noise of a pilot gather in each part, relative.
  void choose_rays(const std::vector<double>& noise, const std::vector<InterpolatedVertex>& read);
  /// Rays of each of the two pilot gathers, for a final one of `rays`.
  int pilot_rays(int rays) const;
  /// Rays of each of the two pilot gathers at a vertex.
  int rays(int vertex) const { return rays_[static_cast<std::size_t>(vertex)]; }

  /// Makes room for all vertices that exist.
  void make_room();
  /// Gives back memory that was reserved for further vertices.
  void shrink_to_fit();

  /// The noise that the sky's light may have at a vertex: more where fewer rays are cast than at a
  /// part's typical vertices, and where errors matter less for what somebody looks at.
  NoiseGoal sky_noise(int vertex) const;
  /// Noise of the sky's light at a vertex over the noise asked for: one of `multiples`.
  int sky_noise_multiple(int vertex) const {
    return sky_noise_multiple_[static_cast<std::size_t>(vertex)];
  }
  static constexpr int multiples[] = {1, 2, 4, 8};
  /// A vertex whose sky noise has a multiple of 1 now, and its multiple of before.
  struct Sharpened {
    int vertex = 0;
    std::uint8_t multiple = 1;
  };
  /// Takes a multiple of 1 at all vertices of the parts in which more noise is notable beside the
  /// error that is `left` in each part, relative to the part's mean. Returns these vertices.
  std::vector<Sharpened> sharpen_sky(const std::vector<double>& left);
  /// Gives a vertex its multiple of before back.
  void keep_sky_noise(const Sharpened& at) {
    sky_noise_multiple_[static_cast<std::size_t>(at.vertex)] = at.multiple;
  }

 private:
  int part_of(int vertex) const;
  double fewness(int vertex) const;
  void share_pilot_rays(const std::vector<InterpolatedVertex>& read);
  int times_at_vertices_that_share(const std::vector<InterpolatedVertex>& read) const;

  const RefinedElements& elements_;
  SceneParts parts_;
  std::vector<PartEffort> efforts_;  // of each part, or empty
  bool has_noise_goal_, few_rays_suffice_;
  std::vector<int> rays_of_part_;
  std::vector<char> has_noisy_sky_;  // per part: new vertices have
  // Per vertex.
  std::vector<int> rays_{};
  std::vector<float> fineness_;  // see vertex_fineness()
  std::vector<std::uint8_t> sky_noise_multiple_{};
};

}  // namespace lightwell
