/* Actuators that are held between samples: ahead of a jump, by a share of the time since the last sample, the model takes a sample
 * with the values before. */
static int nominal(double time, const double *in, $name_memory *memory, double *y)
{
    int jumps = 0;
    for (int k = 0; k < @COUNT; ++k) {
        jumps = jumps || in[HELD[k]] != memory->last[HELD[k]];
    }
    if (memory->begun && jumps) {
        double all[@INPUTS];
        int result;
        memcpy(all, in, sizeof all);
        for (int i = 0; i < @SIGNALS; ++i) {
            all[i] = in[i] - AHEAD * (in[i] - memory->last[i]);
        }
        for (int k = 0; k < @COUNT; ++k) {
            all[HELD[k]] = memory->last[HELD[k]];
        }
        result = straight(time - AHEAD * (time - memory->last_time), all, memory, y);
        if (result != $WHOLE_OK) {
            return result;
        }
    }
    memcpy(memory->last, in, sizeof memory->last);
    memory->last_time = time;
    memory->begun = 1;
    return straight(time, in, memory, y);
}
