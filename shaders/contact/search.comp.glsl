// The search where no query has a clearance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "search.glsl"
