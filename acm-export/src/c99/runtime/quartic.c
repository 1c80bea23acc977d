/* Value halfway between the last two of n samples of the polynomial through them; samples from before a step that is more than UNEVEN
 * times longer or shorter than the next do not count. */
static double halfway(const double *time, const double *value, int n)
{
    const double at = 0.5 * (time[n - 2] + time[n - 1]);
    double middle = 0.0;
    int first = n - 2;
    while (first > 0) {
        const double step = time[first] - time[first - 1], next = time[first + 1] - time[first];
        if (step > UNEVEN * next || next > UNEVEN * step) {
            break;
        }
        --first;
    }
    for (int j = first; j < n; ++j) {
        double weight = 1.0;
        for (int i = first; i < n; ++i) {
            if (i != j) {
                weight *= (at - time[i]) / (time[j] - time[i]);
            }
        }
        middle += weight * value[j];
    }
    return middle;
}

/* Actuators that follow a quartic between samples: the model takes a sample halfway. */
static int nominal(double time, const double *in, $name_memory *memory, double *y)
{
    double *times = memory->times;
    const int earlier = memory->count, last = earlier < SAMPLES ? earlier : SAMPLES - 1;
    if (earlier == SAMPLES) {
        memmove(times, times + 1, (SAMPLES - 1) * sizeof *times);
        for (int i = 0; i < @SIGNALS; ++i) {
            memmove(memory->values[i], memory->values[i] + 1, (SAMPLES - 1) * sizeof *times);
        }
    }
    times[last] = time;
    for (int i = 0; i < @SIGNALS; ++i) {
        memory->values[i][last] = in[i];
    }
    memory->count = last + 1;
    if (earlier > 0) {
        double all[@INPUTS];
        int result;
        memcpy(all, in, sizeof all);
        for (int i = 0; i < @SIGNALS; ++i) {
            all[i] = 0.5 * (memory->values[i][last - 1] + in[i]);
        }
        for (int k = 0; k < @COUNT; ++k) {
            all[CURVED[k]] = halfway(times, memory->values[CURVED[k]], last + 1);
        }
        result = straight(0.5 * (times[last - 1] + time), all, memory, y);
        if (result != $WHOLE_OK) {
            return result;
        }
    }
    return straight(time, in, memory, y);
}
