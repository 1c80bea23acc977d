void $whole_restart($whole_state *state)
{
    memset(state, 0, sizeof *state);
}

int $whole_step($whole_state *state, const double inputs[$WHOLE_INPUTS], double elapsed, $whole_answer *answer)
{
    return take(state, inputs, elapsed, 1, answer);
}

int $whole_step_unseen($whole_state *state, const double inputs[$WHOLE_INPUTS], double elapsed, $whole_answer *answer)
{
    return take(state, inputs, elapsed, 0, answer);
}
