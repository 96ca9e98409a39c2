//! Search for the best pose of a frame: particle swarm and particle filter over counter-based random numbers (SPEC A8).
