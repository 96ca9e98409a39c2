// Numbers that the shaders and the library share.

#ifndef FEATURES_CONSTANTS
#define FEATURES_CONSTANTS

// Pixels of a row that a workgroup works on; two words of a bit picture.
const uint ROW_GROUP = 64u;

// Ratios of a picture's brightness to its background's are counted in steps of one in so many, over every so many rows and columns.
const uint RATIO_STEPS = 128u;
const uint RATIO_GRID = 4u;
// Ratios of at least two and a half count as none.
const uint RATIO_COUNTS = 320u;
// Gains outside of these are no mild change of the lighting but another scene, and are not believed.
const uint RATIO_LEAST = 64u;
const uint RATIO_MOST = 256u;

// The sum of the channels below which a pixel is so dark that it says nothing when the plate is as dark.
const uint DARK = 192u;

// How a component of the mixture follows a pixel.
const uint ADAPTATION_WEIGHT = 0u;
const uint ADAPTATION_DENSITY = 1u;
// Values of a component: weight, mean red, green, blue, variance.
const uint MIXTURE_FIELDS = 5u;

// Which components of a bit picture are kept.
const uint KEEP_LARGEST = 0u;
const uint KEEP_TOUCHED = 1u;
// The holes, which are the components of the clear pixels.
const uint KEEP_HOLES = 2u;

// Log densities of colours are whole numbers of so many steps a unit.
const uint LIKELIHOOD_STEPS = 64u;
// The largest log-likelihood ratio that is believed, in steps, and that from which on a pixel is the person's against colours of which
// nothing is known.
const uint LIKELIHOOD_MOST = 320u;
const uint LIKELIHOOD_FOREGROUND = 64u;
// In a ready mask: minus the log density of what is inside, as background, and that of what is outside.
const uint LIKELIHOOD_MASKED = 192u;
const uint LIKELIHOOD_SURE = 16383u;
// Steps in which the background's slopes are told apart, and those in which shares of shadows are.
const uint LIKELY_SLOPES = 64u;
const uint SHADOW_STEPS = 20u;
// Colours of 16 steps a channel.
const uint COLOUR_BINS = 4096u;

// How two derivatives become one magnitude.
const uint MAGNITUDE_EXACT = 0u;
const uint MAGNITUDE_SUM = 1u;
const uint MAGNITUDE_MAX = 2u;

// The forms of an edge operator's masks.
const uint EDGES_ACROSS = 0u;
const uint EDGES_DIAGONALS = 1u;
const uint EDGES_CROSSINGS = 2u;

// Which distance.
const uint METRIC_CHESSBOARD = 0u;
const uint METRIC_CITY_BLOCK = 1u;
const uint METRIC_EUCLIDEAN = 2u;
const uint METRIC_QUASI_EUCLIDEAN = 3u;
// Steps of the quasi-Euclidean distance.
const uint STEP_STRAIGHT = 408u;
const uint STEP_DIAGONAL = 577u;

#endif
