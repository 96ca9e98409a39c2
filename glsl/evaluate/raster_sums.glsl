// The whole of a stage some of whose workgroups draw and compare an image: what their invocations count (`rasterise`) meets in shared
// memory, then in the sums of the image, which are 0 before.

shared uint totals[4];
#ifdef EVIDENCE
shared uint all_codes;
#endif

void main() {
    uint image = gl_WorkGroupID.x;
    uint own = gl_LocalInvocationID.x;
    uint place = batch.first * batch.views + image;
    if (own < 4u) totals[own] = 0u;
#ifdef SEGMENTED
    clear_segment(own);
#endif
#ifdef EVIDENCE
    if (own == 0u) all_codes = 0u;
#endif
    barrier();
    uvec4 sum = rasterise(image);
    for (uint part = 0u; part < 4u; part++) atomicAdd(totals[part], sum[part]);
#ifdef EVIDENCE
    atomicAdd(all_codes, codes);
#endif
    barrier();
    // The same for all invocations.
    if (totals[0] == 0u) return;
#ifdef SEGMENTED
    if (own < MOST_SEGMENTS && segment_areas[own] != 0u) {
        Sums found = segment_sum(own);
        uint at = place * MOST_SEGMENTS + own;
        atomicAdd(segment_sums[at].area_model, found.area_model);
        atomicAdd(segment_sums[at].overlap, found.overlap);
        if (found.edges != 0u) {
            atomicAdd(segment_sums[at].edges, found.edges);
            atomicAdd(segment_sums[at].proximity, found.proximity);
        }
    }
#endif
    if (own != 0u) return;
    atomicAdd(sums[place].area_model, totals[0]);
    atomicAdd(sums[place].overlap, totals[1]);
    atomicAdd(sums[place].edges, totals[2]);
    atomicAdd(sums[place].proximity, totals[3]);
#ifdef EVIDENCE
    atomicAdd(evidence[place], int(all_codes) - int(EVIDENCE_NEUTRAL) * int(totals[0]));
#endif
}
