    for (int h = 0; h < HARMONICS; ++h) {
        double angle = 0.0, sine, cosine;
        for (int a = 0; a < ACTUATORS; ++a) {
            angle += HARMONIC_MULTIPLE[h][a] * q[a];
        }
        sin_cos_d(angle, &sine, &cosine);
        for (int o = 0; o < MODEL_OUTPUTS; ++o) {
            y[o] += HARMONIC_COSINE[h][o] * cosine + HARMONIC_SINE[h][o] * sine;
        }
    }
