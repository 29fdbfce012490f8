#pragma once

// Embree's calls, the same for versions 3 and 4. Included by the ray caster's sources alone.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "scene/rays/ray_caster.h"

namespace lightwell {

// Context of a query, which Embree passes on to callbacks: the callback of round shapes needs the
// ray's origin in double precision and the ray's group.
#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
#else
using EmbreeContext = RTCIntersectContext;
#endif
struct QueryContext : EmbreeContext {
  const Ray* rays = nullptr;     // a lane's ray is rays[its id]
  const void* caster = nullptr;  // RayCaster::Impl, for the filter
  int target = -1;               // group that the filter ignores
};

inline void init(QueryContext& context, const Ray* rays) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&context);
#else
  rtcInitIntersectContext(&context);
#endif
  context.rays = rays;
}

inline void intersect(RTCScene scene, QueryContext& context, RTCRayHit& query,
                      RTCFilterFunctionN filter = nullptr) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
  if (filter) {
    arguments.flags =
        static_cast<RTCRayQueryFlags>(arguments.flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
  }
  arguments.filter = filter;
  arguments.context = &context;
  rtcIntersect1(scene, &query, &arguments);
#else
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  context.filter = filter;
  rtcIntersect1(scene, &context, &query);
#endif
}

constexpr int packet_size = 16;

inline void intersect(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit16& query) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &context;
  rtcIntersect16(valid, scene, &query, &arguments);
#else
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, &query);
#endif
}

inline void occlude(RTCScene scene, QueryContext& context, const int* valid, RTCRay16& query,
                    RTCFilterFunctionN filter = nullptr) {
#if RTC_VERSION_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  if (filter) {
    arguments.flags =
        static_cast<RTCRayQueryFlags>(arguments.flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
  }
  arguments.filter = filter;
  arguments.context = &context;
  rtcOccluded16(valid, scene, &query, &arguments);
#else
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.filter = filter;
  rtcOccluded16(valid, scene, &context, &query);
#endif
}

}  // namespace lightwell
