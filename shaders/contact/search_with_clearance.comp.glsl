// The search where some queries have clearances.
#version 460
#extension GL_GOOGLE_include_directive : require
#define RADAR_CLEARANCES
#include "search.glsl"
