/* Largest deviation of `found` from `right`, in units of `size`. */
static double worse(double worst, double found, double right, double size)
{
    const double off = (found - right) / size;
    const double distance = off < 0.0 ? -off : off;
    return distance <= worst ? worst : distance;
}

int main(void)
{
    static $whole_state state;
    double all = 0.0, nominal_model = 0.0;
    int outside = 0;
    $whole_restart(&state);
    for (int k = 0; k < RECORDED; ++k) {
        $whole_answer answer;
        const double *in = SAMPLE[k] + 2;
        const int result = SAMPLE[k][1] > 0.0 ? $whole_step(&state, in, SAMPLE[k][0], &answer)
                                              : $whole_step_unseen(&state, in, SAMPLE[k][0], &answer);
        if (result != $WHOLE_OK) {
            printf("sample %d was refused: %d\n", k, result);
            return 1;
        }
        outside += answer.in_range == 0;
        for (int o = 0; o < @COUNT; ++o) {
            all = worse(all, answer.output[o], ANSWER[k][o], SIZE[o][0]);
            nominal_model = worse(nominal_model, answer.nominal[o], ANSWER[k][@COUNT + o], SIZE[o][0]);
        }
    }
    printf("%d samples: outputs within %.1e of their RMS, nominal model within %.1e\n", RECORDED, all, nominal_model);
    return all <= 1e-5 && nominal_model <= 1e-9 && outside == OUTSIDE ? 0 : 1;
}
