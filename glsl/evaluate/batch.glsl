// The push constants of every stage that works on a batch of candidates.

layout(push_constant) uniform Batch {
    uint candidates; // in the batch
    uint views;
    uint bones;
    uint parts;
    uint dofs;
    uint first; // the batch's first candidate in the buffers of poses, components and fitness
} batch;
