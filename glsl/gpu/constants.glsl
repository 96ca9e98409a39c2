// Values that the self-tests of gpu/ share with their shaders.

// Invocations of one workgroup of double.comp.
const uint DOUBLE_WORKGROUP = 64u;
