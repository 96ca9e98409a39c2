#version 450
#extension GL_GOOGLE_include_directive : require

// Marks the largest components, of equals the first in reading order, unless all together cover too much: one workgroup.

#include "features/components.glsl"

layout(local_size_x = 128) in;

layout(std430, set = 0, binding = 0) readonly buffer Roots { uint roots[]; };
layout(std430, set = 0, binding = 1) buffer Areas { uint areas[]; };

const uint LANES = 128u;

shared uint best_area[LANES];
shared uint best_root[LANES];
shared uint total;

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint count = roots[0];
    uint least = push.least;
    if (lane == 0u) total = 0u;
    barrier();
    uint covered = 0u;
    for (uint i = lane; i < count; i += LANES) covered += areas[roots[1u + i]];
    atomicAdd(total, covered);
    barrier();
    if (total > push.cover) return;
    // The one marked last.
    uint area_before = 0xffffffffu;
    uint root_before = 0u;
    for (uint round_ = 0u; round_ < push.most; round_++) {
        uint area = 0u;
        uint root = 0xffffffffu;
        for (uint i = lane; i < count; i += LANES) {
            uint candidate = roots[1u + i];
            uint size = areas[candidate] & ~MARK;
            bool is_left = size < area_before || (size == area_before && candidate > root_before);
            if (is_left && (size > area || (size == area && candidate < root))) {
                area = size;
                root = candidate;
            }
        }
        best_area[lane] = area;
        best_root[lane] = root;
        barrier();
        for (uint reach = LANES / 2u; reach > 0u; reach /= 2u) {
            if (lane < reach) {
                uint other_area = best_area[lane + reach];
                uint other_root = best_root[lane + reach];
                uint own = best_area[lane];
                if (other_area > own || (other_area == own && other_root < best_root[lane])) {
                    best_area[lane] = other_area;
                    best_root[lane] = other_root;
                }
            }
            barrier();
        }
        area_before = best_area[0];
        root_before = best_root[0];
        if (round_ == 0u) {
            precise float part = float(area_before) * push.share;
            least = max(least, uint(ceil(part)));
        }
        if (area_before > 0u && area_before >= least && lane == 0u) areas[root_before] = area_before | MARK;
        // All have read the best before the next round writes over it; marks are not looked at.
        barrier();
    }
}
