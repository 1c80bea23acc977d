/* Samples as doubles from standard input (elapsed, seen, inputs), answers to standard output (result, range, history, outputs). */
#include "estimator.h"
#include <stdio.h>

int main(void)
{
    static estimator_state state;
    double in[2 + ESTIMATOR_INPUTS], out[3 + 2 * ESTIMATOR_OUTPUTS];
    estimator_restart(&state);
    while (fread(in, sizeof in, 1, stdin) == 1) {
        estimator_answer answer = { { 0.0 }, { 0.0 }, 0 };
        if (in[1] < 0.0) {
            estimator_restart(&state);
            continue;
        }
        out[0] = in[1] > 0.0 ? estimator_step(&state, in + 2, in[0], &answer)
                             : estimator_step_unseen(&state, in + 2, in[0], &answer);
        out[1] = answer.in_range;
        out[2] = (double)state.history;
        for (int o = 0; o < ESTIMATOR_OUTPUTS; ++o) {
            out[3 + o] = answer.output[o];
            out[3 + ESTIMATOR_OUTPUTS + o] = answer.nominal[o];
        }
        fwrite(out, sizeof out, 1, stdout);
    }
    return 0;
}
