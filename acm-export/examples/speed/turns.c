#include "estimator.h"
#include <stdio.h>
#include <time.h>

/* Time since the sample before, inputs. */
static const double in[][1 + ESTIMATOR_INPUTS] = {
@ROWS};

int main(void)
{
    static estimator_state state;
    struct timespec from, to;
    double sum = 0.0;
    estimator_restart(&state);
    clock_gettime(CLOCK_MONOTONIC, &from);
    for (int k = 0; k < @STEPS; ++k) {
        estimator_answer answer;
        const double *sample = in[k % (int)(sizeof in / sizeof *in)];
        if (estimator_step(&state, sample + 1, sample[0], &answer) != ESTIMATOR_OK) {
            return 1;
        }
        sum += answer.output[0];
    }
    clock_gettime(CLOCK_MONOTONIC, &to);
    printf("%.3f\n", ((double)(to.tv_sec - from.tv_sec) * 1e9 + (double)(to.tv_nsec - from.tv_nsec)) / @STEPS);
    return sum == sum ? 0 : 1;
}
