// Every struct that C++ and GLSL share, as the element of a buffer, so that each has a layout: some are otherwise only
// read as texels or pushed.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shaders/arithmetic/interop.h"
#include "shaders/contact/interop.h"
#include "shaders/embed/interop.h"
#include "shaders/sampled/interop.h"
#include "radar/query.glsl"
#include "radar/result.glsl"

#define STRUCT(type, number) layout(scalar, binding = number) readonly buffer Buffer##number { type elements##number[]; };
#define MEMBER(type, name)
#include "shared_structs.h"

layout(local_size_x = 1) in;

void main() {}
