// Numbers that the shaders and the library share.

#ifndef FEATURES_CONSTANTS
#define FEATURES_CONSTANTS

// Pixels of a row that a workgroup works on; two words of a bit picture.
const uint ROW_GROUP = 64u;

// What finds the edges.
const uint EDGES_SOBEL = 0u;
const uint EDGES_PREWITT = 1u;
const uint EDGES_ROBERTS = 2u;
const uint EDGES_LAPLACE_FOUR = 3u;
const uint EDGES_LAPLACE_EIGHT = 4u;
const uint EDGES_LAPLACE_PRODUCT = 5u;

// How two derivatives become one magnitude.
const uint MAGNITUDE_EXACT = 0u;
const uint MAGNITUDE_SUM = 1u;
const uint MAGNITUDE_MAX = 2u;

// Which distance.
const uint METRIC_CHESSBOARD = 0u;
const uint METRIC_CITY_BLOCK = 1u;
const uint METRIC_EUCLIDEAN = 2u;
const uint METRIC_QUASI_EUCLIDEAN = 3u;
// Steps of the quasi-Euclidean distance.
const uint STEP_STRAIGHT = 408u;
const uint STEP_DIAGONAL = 577u;

#endif
