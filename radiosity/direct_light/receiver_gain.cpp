// Members of DirectLight that weigh light by its direction at the receiver.
#include <algorithm>
#include <cmath>

#include "radiosity/direct_light/direct_light.h"
#include "radiosity/direct_light/light_shadows.h"
#include "radiosity/emitters/emission_tree.h"
#include "radiosity/emitters/emitter_shadows.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/emitters/light_list.h"
#include "radiosity/emitters/solid_angle_sampler.h"
#include "radiosity/sky/sky_light.h"

namespace lightwell {

// Mean of the receiver's factor over four points of a light, by the light that they send.
double DirectLight::factor(int light, const SurfacePoint& at, const ReceiverGain& receiver) const {
  const Emitter* emitter = lights_->is_emitter(light) ? &emitters()[light] : nullptr;
  const SolidAngleSampler sampler =
      emitter ? SolidAngleSampler(*emitter, at.position) : SolidAngleSampler();
  double sum = 0.0, all = 0.0;
  for (const double u : {0.25, 0.75}) {
    for (const double v : {0.25, 0.75}) {
      const ShadowSample sample = emitter ? emitter_shadow_sample(*emitter, sampler, at, u, v)
                                          : shadow_sample(lights_->source(light), at, u, v);
      if (!(sample.weight > 0.0)) continue;
      sum += sample.weight * receiver.factor(sample.ray.direction, at.normal);
      all += sample.weight;
    }
  }
  return all > 0.0 ? sum / all : 1.0;
}

// Light of an emitter, a lamp or the sun that arrives at a point without occluders, W/m^2, mean of
// the bands. Walls hide the sun from most of a room, so it counts by the share of points near by
// that see it.
double DirectLight::arriving_unoccluded(int light, const SurfacePoint& at) const {
  if (const FreeSource* source = lights_->is_emitter(light) ? nullptr : &lights_->source(light)) {
    if (source->is_dome()) return 0.0;
    const double kernel = unoccluded_kernel(*source, at.position, at.normal);
    if (!(kernel > 0.0)) return 0.0;
    double E = kernel * double{light_towards(*source, at.position).mean()};
    if (sky_ && source->is_distant()) {
      E *= sky_->open_share(at, shadow_sample(*source, at, 0.5, 0.5).ray.direction.normalized());
    }
    return E;
  }
  const Emitter& emitter = emitters()[light];
  const double F = unoccluded_form_factor(emitter, at);
  if (!(F > 0.0)) return 0.0;
  if (!emitter.picture) return F * double{emitter.exitance.mean()};
  return F * double{pictured_light(emitter, emitter.picture->view(at, F), F).mean()};
}

// Light per channel that arrives at a point, with the receiver's factor and without, unoccluded but
// for sky and sun. The dome counts for a base alone.
Eigen::ArrayX2d DirectLight::light_with_factor(const SurfacePoint& at,
                                               const ReceiverGain& receiver) const {
  Eigen::ArrayX2d sum = Eigen::ArrayX2d::Zero(channel_count(), 2);
  constexpr int most = 64;
  const int step = std::max(1, (light_count() + most - 1) / most);
  for (int i = 0; i < light_count(); i += step) {
    const double E = step * arriving_unoccluded(i, at);
    if (!(E > 0.0)) continue;
    sum.row(lights_->channel(i)) += Eigen::Array2d(E * factor(i, at, receiver), E).transpose();
  }
  const FreeSource* const dome = this->dome();
  if (!dome || !dome->is_on() || !receiver.base) return sum;
  sum.row(dome->channel) +=
      double{dome->light.mean()} * sky_->by_cosine(at)->at_base(*receiver.base).transpose();
  return sum;
}

double DirectLight::gain(const SurfacePoint& at, const ReceiverGain& receiver) const {
  const Eigen::Array2d all = light_with_factor(at, receiver).colwise().sum();
  return all[1] > 0.0 ? all[0] / all[1] : 1.0;
}

double DirectLight::base_gain(const SurfacePoint& at, const CoatedBase& base) const {
  return gain(at, {.base = &base});
}

double DirectLight::relief_gain(const SurfacePoint& at, const ReliefSlope& relief) const {
  if (dome() && dome()->is_on()) return 1.0;
  return gain(at, {.relief = &relief});
}

Eigen::ArrayXd DirectLight::base_gains(const SurfacePoint& at, const CoatedBase& base) const {
  const Eigen::ArrayX2d sum = light_with_factor(at, {.base = &base});
  return (sum.col(1) > 0.0).select(sum.col(0) / sum.col(1), 1.0);
}

}  // namespace lightwell
