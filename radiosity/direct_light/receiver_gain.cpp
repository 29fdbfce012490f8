// Members of DirectLight that weigh light by its direction at the receiver.
#include <algorithm>
#include <cmath>

#include "radiosity/direct_light/direct_light.h"
#include "radiosity/direct_light/light_shadows.h"
#include "radiosity/emitters/emission_tree.h"
#include "radiosity/emitters/emitter_shadows.h"
#include "radiosity/emitters/solid_angle_sampler.h"

namespace lightwell {

double DirectLight::Receiver::factor(const Eigen::Vector3d& direction,
                                     const Eigen::Vector3d& normal) const {
  double result = base ? base->factor(direction.normalized().dot(normal)) : 1.0;
  if (relief) result *= relief->gain(direction);
  return result;
}

// Mean of the receiver's factor over four points of a light, by the light that they send.
double DirectLight::factor(int light, const SurfacePoint& at, const Receiver& receiver) const {
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

// Light per channel that arrives at a point, with the receiver's factor and without, unoccluded.
Eigen::ArrayX2d DirectLight::light_with_factor(const SurfacePoint& at,
                                               const Receiver& receiver) const {
  Eigen::ArrayX2d sum = Eigen::ArrayX2d::Zero(channel_count(), 2);
  if (dome() && dome()->is_on()) return sum;
  constexpr int most = 64;
  const int step = std::max(1, (light_count() + most - 1) / most);
  for (int i = 0; i < light_count(); i += step) {
    const Emitter* emitter = lights_->is_emitter(i) ? &emitters()[i] : nullptr;
    const FreeSource* source = emitter ? nullptr : &lights_->source(i);
    const double F = emitter ? unoccluded_form_factor(*emitter, at)
                             : unoccluded_kernel(*source, at.position, at.normal);
    if (!(F > 0.0)) continue;
    Spectrum light = emitter ? emitter->exitance : light_towards(*source, at.position);
    if (emitter && emitter->picture) {
      light = pictured_light(*emitter, emitter->picture->view(at, F), F);
    }
    const double E = F * static_cast<double>(light.mean());
    if (!(E > 0.0)) continue;
    sum.row(lights_->channel(i)) += Eigen::Array2d(E * factor(i, at, receiver), E).transpose();
  }
  return sum;
}

double DirectLight::gain(const SurfacePoint& at, const Receiver& receiver) const {
  const Eigen::Array2d all = light_with_factor(at, receiver).colwise().sum();
  return all[1] > 0.0 ? all[0] / all[1] : 1.0;
}

double DirectLight::base_gain(const SurfacePoint& at, const CoatedBase& base) const {
  return gain(at, {.base = &base});
}

double DirectLight::relief_gain(const SurfacePoint& at, const ReliefSlope& relief) const {
  return gain(at, {.relief = &relief});
}

Eigen::ArrayXd DirectLight::base_gains(const SurfacePoint& at, const CoatedBase& base) const {
  const Eigen::ArrayX2d sum = light_with_factor(at, {.base = &base});
  return (sum.col(1) > 0.0).select(sum.col(0) / sum.col(1), 1.0);
}

}  // namespace lightwell
