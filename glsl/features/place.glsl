// Where an invocation works when the words of a picture are dealt out one after the other, however many rows of workgroups that takes.

#ifndef FEATURES_PLACE
#define FEATURES_PLACE

uint flat_place() {
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * ROW_GROUP + gl_LocalInvocationID.x;
}

// The pixels of a row's word that lie inside a picture so many pixels wide.
uint inside_word(uint column, uint width) {
    uint first = column * 32u;
    if (first >= width) return 0u;
    uint left = width - first;
    return left >= 32u ? 0xffffffffu : (1u << left) - 1u;
}

#endif
