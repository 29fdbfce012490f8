#pragma once

#include <vector>

#include "radiosity/emitters/emitter.h"
#include "radiosity/emitters/free_source.h"

namespace lightwell {

/// All lights of a scene under common numbers: emitters come first, then lamps, then sky and sun.
struct LightList {
  std::vector<Emitter> emitters{};
  std::vector<FreeSource> sources{};
  std::vector<int> channel_of_emitter{};  ///< see EmitterChannels; empty: all in channel 0
  int channel_count = 1;

  int emitter_count() const { return static_cast<int>(emitters.size()); }
  int count() const { return static_cast<int>(emitters.size() + sources.size()); }
  bool is_emitter(int light) const { return light < emitter_count(); }
  /// A light that is_emitter() is not.
  const FreeSource& source(int light) const { return sources[light - emitter_count()]; }
  bool is_dome(int light) const { return !is_emitter(light) && source(light).is_dome(); }
  bool is_on(int light) const {
    return is_emitter(light) ? (emitters[light].exitance > 0.0f).any() : source(light).is_on();
  }
  int channel(int light) const {
    if (!is_emitter(light)) return source(light).channel;
    return channel_of_emitter.empty() ? 0 : channel_of_emitter[light];
  }
};

}  // namespace lightwell
