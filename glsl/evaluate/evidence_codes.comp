#version 450
#extension GL_GOOGLE_include_directive : require

// The evidence of a view whose likelihoods the device made itself (METHOD A12), as the bits of its codes: src/observe/appearance/mod.rs,
// in whole numbers. An invocation makes 32 pixels of a row of one class.

#include "evaluate/constants.glsl"
#include "features/constants.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

// Whether pixels are ignored.
layout(constant_id = 0) const bool IGNORES = false;

// The log density of each pixel's colour as background in the lower half, steps; the colour in the upper.
layout(std430, set = 0, binding = 0) readonly buffer Seen { uint seen[]; };
// Round what does not look like background, as features/bounds.comp leaves them.
layout(std430, set = 0, binding = 1) readonly buffer Sides { uint sides[]; };
// The log densities of colours, two a word: of cameras that see colours, then of those that see in grey, of the whole person and then of
// each class.
layout(std430, set = 0, binding = 2) readonly buffer ColourTables { uint colour_tables[]; };
// Of each view whether a ready mask tells what is foreground, and whether its camera sees in grey.
layout(std430, set = 0, binding = 3) readonly buffer Looks { uvec2 looks[]; };
// A bit a pixel, as the observations' planes.
layout(std430, set = 0, binding = 4) readonly buffer CountedPlanes { uint counted_planes[]; };
// The bits of the codes of 32 pixels of a row, [group][class].
layout(std430, set = 0, binding = 5) writeonly buffer EvidencePlanes { uvec4 evidence_planes[]; };
// What surely is background, whatever the person's colours: a bit picture.
layout(std430, set = 0, binding = 6) writeonly buffer Empty { uint empty[]; };

layout(push_constant) uniform EvidenceView {
    uint width;
    uint height;
    uint stride;      // words of a row of a bit picture
    uint first_group; // of the view's planes
    uint view;
    uint classes;
    uint motion; // room round what was found, pixels
} push;

const int MOST = int(LIKELIHOOD_MOST);

uvec2 own_look;
uint own_class;
uvec4 near;

int density_of(uint table, uint colour) {
    uint place = ((own_look.y * (push.classes + 1u)) + table) * COLOUR_BINS + colour;
    return int(colour_tables[place >> 1u] << (16u - 16u * (place & 1u))) >> 16;
}

bool is_ignored(uint x, uint y) {
    uint groups = (push.width + 31u) / 32u;
    return IGNORES && ((counted_planes[push.first_group + y * groups + (x >> 5u)] >> (x & 31u)) & 1u) == 0u;
}

// The log-likelihood ratio of a pixel.
int ratio(uint x, uint y) {
    uint word = seen[y * push.width + x];
    int background = int(word << 16u) >> 16;
    uint colour = word >> 16u;
    // Inside of a ready mask it is the person's, and only which part is asked.
    int known = own_look.x != 0u && background < 0 ? density_of(0u, colour) : 0;
    int found = clamp(density_of(own_class + 1u, colour) - known - background, -MOST, MOST);
    return is_ignored(x, y) ? 0 : found;
}

// Pixels at the region's border count for those beyond.
int column(int x, uint y) {
    uint inside = uint(clamp(x, int(near.x), int(near.z) - 1));
    return ratio(inside, max(y, near.y + 1u) - 1u) + 2 * ratio(inside, y) + ratio(inside, min(y + 1u, near.w - 1u));
}

// The code of sixteen times a ratio: 7 codes for 5 units, rounded.
uint code(int sum) {
    int value = ((sum * int(EVIDENCE_NEUTRAL) + 8 * MOST) >> 4) + int(EVIDENCE_NEUTRAL) * MOST;
    return min(uint(value) / LIKELIHOOD_MOST, 2u * EVIDENCE_NEUTRAL);
}

void main() {
    uint place = flat_place();
    uint groups = (push.width + 31u) / 32u;
    if (place >= groups * push.height * push.classes) return;
    own_class = place % push.classes;
    uint group = place / push.classes;
    uint y = group / groups;
    uint first = group % groups * 32u;
    own_look = looks[push.view];
    uvec2 size = uvec2(push.width, push.height);
    uvec2 begin = size - min(uvec2(sides[0], sides[1]), size);
    uvec2 end = min(uvec2(sides[2], sides[3]) + push.motion, size);
    near = sides[2] == 0u ? uvec4(0u) : uvec4(begin - min(begin, uvec2(push.motion)), end);
    bool near_row = y >= near.y && y < near.w;

    uvec4 bits = uvec4(0u);
    uint sure = 0u;
    int before = 0;
    int here = 0;
    bool is_begun = false;
    uint count = min(32u, push.width - first);
    for (uint i = 0u; i < count; i++) {
        uint x = first + i;
        uint found;
        if (near_row && x >= near.x && x < near.z) {
            if (!is_begun) {
                before = column(int(x) - 1, y);
                here = column(int(x), y);
                is_begun = true;
            }
            int after = column(int(x) + 1, y);
            found = code(before + 2 * here + after);
            before = here;
            here = after;
        } else {
            // Away from what may be the person nothing speaks for her, and colours are not looked up.
            int background = int(seen[y * push.width + x] << 16u) >> 16;
            found = code(-16 * clamp(background, int(LIKELIHOOD_STEPS), MOST));
        }
        if (is_ignored(x, y)) found = 0u;
        bits |= ((uvec4(found) >> uvec4(0u, 1u, 2u, 3u)) & 1u) << i;
        if (own_class == 0u) {
            uint word = seen[y * push.width + x];
            int background = int(word << 16u) >> 16;
            if (background - density_of(0u, word >> 16u) > MOST) sure |= 1u << i;
        }
    }
    evidence_planes[(push.first_group + group) * push.classes + own_class] = bits;
    if (own_class == 0u) empty[y * push.stride + (first >> 5u)] = sure;
}
