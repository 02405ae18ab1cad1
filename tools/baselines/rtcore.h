// Embree 3 or 4, which differ in how rays are asked.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#if RTC_VERSION_MAJOR < 4
using RTCRayQueryContext = RTCIntersectContext;
using RTCRayQueryFlags = RTCIntersectContextFlags;
constexpr RTCRayQueryFlags RTC_RAY_QUERY_FLAG_COHERENT = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
constexpr RTCRayQueryFlags RTC_RAY_QUERY_FLAG_INCOHERENT = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
constexpr RTCSceneFlags RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif
