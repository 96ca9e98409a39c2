// Numbers that the shaders and the library share.

// The descriptor set of what a search binds: stages that score too leave the first one to the fitness.
#ifndef SEARCH_SET
#define SEARCH_SET 0
#endif

// Invocations of a workgroup where every invocation has a block of random numbers.
const uint SEARCH_GROUP = 64u;
// Invocations of the one workgroup that looks over all candidates.
const uint LOOK_GROUP = 256u;
// Most samples, and most degrees of freedom, of a generation that is scored and learnt from in one stage: it keeps something of each in
// shared memory.
const uint LEARN_SAMPLES = 256u;
const uint LEARN_DOFS = 256u;
// Running sums of a mean; also the invocations of a workgroup of `spread`.
const uint SUM_LANES = 64u;

// How the sharpness of an annealed filter is found: bit patterns of the least and the greatest one, 2^-10 and 2^24, how often
// what lies between them is halved, running sums of the shares that a sharpness leaves, and how many halvings one workgroup
// looks into at once: their tree, less than 2^5 times as many sums, is a workgroup.
const uint LEAST_SHARPNESS = 0x3A800000u;
const uint MOST_SHARPNESS = 0x4B800000u;
const uint HALVINGS = 20u;
const uint ANNEAL_LANES = 8u;
const uint HALVINGS_AT_ONCE = 5u;

// Bit patterns of the least and the greatest step size of an evolution, 1e-6 and 1e6 of the frame's spread.
const uint LEAST_SIGMA = 0x358637BDu;
const uint MOST_SIGMA = 0x49742400u;
