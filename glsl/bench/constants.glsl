// Numbers that the peak test shares with the host.

#ifndef BENCH_CONSTANTS
#define BENCH_CONSTANTS

// Invocations of a workgroup.
const uint PEAK_WORKGROUP = 128u;
// Sums, shifts and bit operations of whole numbers.
const uint PEAK_INTEGER = 0u;
// Products and sums in floating point.
const uint PEAK_FLOAT = 1u;
// Reads from a large buffer.
const uint PEAK_MEMORY = 2u;
// Reads from the shared memory of a workgroup.
const uint PEAK_SHARED = 3u;

#endif
