// Which of a pass's values an invocation makes: passes are one long row, cut where a dispatch may be no longer.
layout(local_size_x = 64) in;
layout(location = 30) uniform uint u_count;

uint own_number() { return gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x; }
