#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/elements/refine_elements.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/refine/emitter_visibility_list.h"
#include "radiosity/refine/interpolated_vertices.h"
#include "radiosity/refine/refine_options.h"
#include "radiosity/refine/shared_gathers.h"
#include "radiosity/refine/vertex_effort.h"

namespace lightwell {

struct ChannelLight;

/// Pilot gathers at the vertices of refined elements, each made at most once.
///
/// - Direct light is gathered as for the final solution. The light of the sky has more noise at
///   first where VertexEffort says so: see sharpen_sky().
/// - Indirect light is gathered twice, independently, with the rays of VertexEffort.
///
///   The rays take the same directions all over a side of a surface, so that most of the noise is
///   alike at neighbours and not in the difference between them.
/// - The rays read the light at the base's vertices, which a gather of the same kind has sharpened
///   before.
/// - On unread_patches() no indirect light is gathered, and direct light of crumbs at
///   records alone.
///
/// Vertices are numbered as in RefinedElements. Values are in W/m^2, vertices x bands.
class VertexGathers {
 public:
  /// Gathers at the base's vertices. `radiosity` as gatherable_radiosity makes it, and `caustic`
  /// irradiance (or an empty array), are at the base's vertices; the caster of `lit` is of the
  /// base. Vertices lie inside the elements by 2 % of the size of a cell of the deepest level. If
  /// the efforts of `refine` limit the noise, the first gather also chooses the rays of the final
  /// gather, so that its RMS noise in each part is that share of the part's mean irradiance. Keeps
  /// references to the parts of `lit` and to `elements`. Throws Interrupted when progress says
  /// stop.
  VertexGathers(const LitScene& lit, const BandArray& radiosity, const BandArray& caustic,
                RefinedElements& elements, const GatherOptions& options,
                const RefineOptions& refine);

  LitScene lit() const { return {scene_, caster_, direct_light_}; }
  /// Options of the final gather, with the most rays of any part; progress is that of "refine".
  const GatherOptions& options() const { return options_; }
  /// Rays of the final gather in each part.
  const std::vector<int>& rays() const { return effort_.rays_of_part(); }

  /// Makes room for all vertices that exist; needed before a gather at new ones.
  void make_room();
  /// Gathers direct light at the vertices that have none yet.
  void gather_direct_at(const std::vector<int>& vertices);
  /// Gathers direct light anew where that of the sky has more noise than is asked for, in the parts
  /// of the scene in which that noise is notable beside the error that is left, relative to the
  /// part's mean. Returns whether there were such vertices.
  bool sharpen_sky(const std::vector<double>& left);
  /// Variance of direct light where that of the sky has more noise than is asked for, mean of the
  /// bands, (W/m^2)^2, in the order of `vertices`; 0 elsewhere.
  Eigen::ArrayXf noisy_sky_variance(const std::vector<int>& vertices) const;
  /// Gathers indirect light, both times, at the vertices at which none was gathered yet.
  void gather_indirect_at(const std::vector<int>& vertices);
  /// Sets the indirect light of a vertex to the mean of its ends, if the light is unknown. Unknown
  /// light of the ends is set first, in the same way.
  void interpolate_indirect(int vertex);
  bool has_gathered_indirect(int vertex) const { return indirect_[vertex] == Indirect::gathered; }

  const BandArray& direct() const { return direct_; }
  /// The two gathers of indirect light.
  const BandArray& first() const { return first_; }
  const BandArray& second() const { return second_; }
  EmitterVisibility visibility(int vertex) const { return visibility_[vertex]; }
  /// Direct light plus the mean of the two gathers of indirect light; without caustics.
  Spectrum total(int vertex) const;

  /// Direct and indirect light of a list of vertices, in the list's order.
  GatheredIrradiance values(const std::vector<int>& vertices) const;
  /// The gathers of values() made again with the light of channels, whose columns sum to values()
  /// over channels. Indirect light of interpolated vertices (numbers are indices in the list) is
  /// the mean of their ends.
  GatheredIrradiance values_by_channel(const std::vector<int>& vertices,
                                       std::span<const InterpolatedVertex> interpolated,
                                       const ChannelLight& light) const;
  /// Vertices of the base that share gathers.
  const SharedGathers& shared() const { return shared_; }
  /// Predictions of the vertices of SharedGathers::read, by base vertex. The spread and the noise
  /// are those of the differences between the two gathers at the vertices of a group and the mean
  /// of the group's records.
  std::vector<VertexPrediction> shared_predictions() const;
  /// Number of points at which direct light was gathered.
  std::int64_t gathers() const { return gathers_; }
  /// Gives back memory that was reserved for further vertices.
  void shrink_to_fit();

 private:
  bool is_unread(int vertex) const;
  void gather_direct_at_base();
  BandArray direct_at(const DirectLight& light, const std::vector<int>& vertices,
                      std::vector<EmitterVisibility>* visibilities) const;
  void set_direct(const std::vector<int>& vertices);
  void sharpen_radiosity(const BandArray& caustic);
  GatherPoint gather_point(int vertex) const;
  GatherPoint keyed_point(int vertex) const;
  GatheredIrradiance indirect_at(const std::vector<int>& vertices, std::uint64_t replica,
                                 const BandArray& radiosity) const;
  GatheredIrradiance sharpened_indirect(const BandArray& radiosity) const;
  BandArray sharpened_by_channel(const BandArray& direct, const ChannelLight& light) const;

  const Scene& scene_;
  const ElementCaster& caster_;
  const DirectLight& direct_light_;
  BandArray radiosity_;  // at the base's vertices
  RefinedElements& elements_;
  GatherOptions options_;
  double inset_;
  // Per vertex.
  std::vector<char> has_direct_;
  enum class Indirect : char { unknown, interpolated, gathered };
  std::vector<Indirect> indirect_;
  BandArray direct_, first_, second_;
  EmitterVisibilityList visibility_;
  std::vector<char> unread_patch_;  // per patch
  SharedGathers shared_;
  VertexEffort effort_;
  SceneParts parts_;
  std::int64_t gathers_ = 0;
};

}  // namespace lightwell
