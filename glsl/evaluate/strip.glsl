// The order in which the corners of a quadrilateral make a strip of the triangles 0 1 2 and 0 2 3, those that vertices alone are joined
// to.

const uint STRIP[4] = uint[4](1u, 0u, 2u, 3u);
