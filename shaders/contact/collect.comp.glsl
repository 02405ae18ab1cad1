// Carries tasks from one round of the search to the next: first the spilled tasks, which are deepest in the trees, so that few
// tasks are pending at a time; then the tasks that were not taken.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/workgroup.glsl"

layout(local_size_x = kContactGroup) in;

layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotTasks) readonly restrict buffer Tasks { SearchTask tasks[]; };
layout(scalar, binding = kSlotSpilled) restrict buffer Spilled { SearchTask spilled[]; };
layout(scalar, binding = kSlotStates) restrict buffer States { SearchState states[]; };

layout(push_constant) uniform PushConstants { CollectPush push; };

void main() {
  const SearchRound round = counts.rounds[push.round];
  const uint taken = min(round.taken, round.tasks), left = round.tasks - taken, kept = min(round.spilled, push.taskCapacity);
  const uint me = gl_GlobalInvocationID.x;
  const uint step = kContactGroup * kCollectGroups;
  if (push.isLast != 0) {
    for (uint i = me; i < left; i += step) atomicOr(states[tasks[taken + i].search].flags, kSearchUnfinished);
    for (uint i = me; i < kept; i += step) atomicOr(states[spilled[i].search].flags, kSearchUnfinished);
  } else {
    for (uint i = me; i < left; i += step) {
      if (kept + i < push.taskCapacity) {
        spilled[kept + i] = tasks[taken + i];
      } else {
        atomicOr(states[tasks[taken + i].search].flags, kSearchLost);
      }
    }
  }
  if (me != 0) return;
  const uint pending = min(kept + left, push.taskCapacity);
  counts.rounds[push.round + 1].tasks = pending;
  // While searches are unfinished, their candidates wait.
  const uint ready = pending == 0 || push.isLast != 0 ? counts.candidates : 0;
  const uvec3 rows = workgroupRows((ready + kContactGroup - 1) / kContactGroup);
  counts.filterGroups = uint[3](rows.x, rows.y, rows.z);
}
