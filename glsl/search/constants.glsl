// Numbers that the shaders and the library share.

// Invocations of a workgroup where every invocation has a block of random numbers.
const uint SEARCH_GROUP = 64u;
// Invocations of the one workgroup that looks over all candidates.
const uint LOOK_GROUP = 256u;
// Running sums of a mean; also the invocations of a workgroup of `spread`.
const uint SUM_LANES = 64u;
