#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "radiosity/emitters/light_list.h"
#include "radiosity/many_lights/light_choice.h"
#include "radiosity/many_lights/light_tree.h"

namespace lightwell {

struct PotentialLight;

/// Lights that a point asks for. A sample's cluster is the number of one of the parts.
struct LightCut {
  std::vector<LightSample> samples{};
  std::vector<CutPart> parts{};    ///< of the channels one after another
  std::vector<std::size_t> end{};  ///< of each channel's parts
};

/// A coarse cut for a point, and the light that its lights give the point.
struct LightPilot {
  LightCut cut{};
  /// The light of each channel that arrives, W/m^2, mean of the bands.
  std::vector<double> light{};
};

/// Chooses the lights that a point asks for. Lights of a channel that are on and fewer than
/// `fewest_clustered` are asked each; of others a LightTree is made.
class LightSampler {
 public:
  explicit LightSampler(std::shared_ptr<const LightList> lights);

  /// True if any emitters are clustered.
  bool has_emitter_clusters() const;
  /// True if any of these lights are clustered.
  bool has_clusters(Lights lights) const;

  /// The trees of all channels.
  std::vector<const LightTree*> trees(Lights lights) const;
  /// The lights that are on and in no tree, each by itself, of all channels.
  std::vector<LightSample> singles(Lights lights) const;

  /// The lights of a cut that is coarser than asked for, for LightPilot.
  LightCut pilot_cut(const LightChoice& choice) const;
  /// The lights that a point asks for. Those of a cut take a pilot's cut further. `pilot` null: no
  /// light of the choice is clustered, or all are asked.
  ///
  /// The mean over keys of the light over chances is the sum over all lights, whatever the pilot,
  /// as long as its key is another one.
  std::vector<LightSample> samples(const LightChoice& choice, const LightPilot* pilot) const;
  /// One light of each channel for all of the channel, drawn in proportion to about what each
  /// gives, besides the sky's dome.
  std::vector<LightSample> one_of_each_channel(const LightChoice& choice) const;
  /// The emitters that a point asks for, as if all were visible; those that are off as well, since
  /// they exchange light as all others.
  std::vector<LightSample> emitters(const LightChoice& choice) const;

 private:
  int first_light(Lights lights) const;
  void add_few(int channel, Lights lights, std::vector<LightSample>& samples) const;
  std::vector<const LightTree*> trees_of(int channel, Lights lights) const;
  std::vector<PotentialLight> clustered_lights(int channel, const LightChoice& choice) const;
  std::optional<LightSample> one_for_all(int channel, const LightChoice& choice) const;
  double approximate_light(int light, const SurfacePoint& at) const;

  std::shared_ptr<const LightList> lights_;
  /// Trees of the emitters and of the lamps of a channel; null where there are few.
  struct Trees {
    std::shared_ptr<const LightTree> of_emitters{}, of_lamps{};
    std::vector<int> emitters{}, lamps{};  ///< the lights of each
  };
  std::vector<Trees> trees_{};           // by channel
  std::vector<std::vector<int>> few_{};  // by channel: lights that are on and in no tree
  std::vector<int> off_{};               // emitters that are switched off
};

}  // namespace lightwell
